#include "fmu/fmi_call.h"

#include <map>
#include <mutex>

#ifdef BUOYANCY_STATIC_CXX_LIBRARY
namespace __gnu_cxx {
void __freeres();  // NOLINT(readability-identifier-naming): the name is the library's
}
// The C++ library that is part of an FMU keeps 73 kB for exceptions, which a host would lose each time that
// it unloads the FMU.
[[gnu::destructor]] static void free_memory_of_exceptions() {
  __gnu_cxx::__freeres();
}
#endif

namespace buoyancy::fmu {
namespace {

bool has_ended = false;  // a host may free instances while it ends, after the registry

struct Registry {
  ~Registry() { has_ended = true; }

  std::mutex mutex;
  std::map<const void*, std::unique_ptr<Instance>> instances;
};

Registry& registry() {
  static Registry created;
  return created;
}

}  // namespace

void* add_instance(std::unique_ptr<Instance> instance) {
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  void* const handle = instance.get();
  all.instances.emplace(handle, std::move(instance));
  return handle;
}

Instance* find_instance(const void* handle) {
  Registry& all = registry();
  if (has_ended) return nullptr;
  const std::lock_guard lock(all.mutex);
  const auto found = all.instances.find(handle);
  return found == all.instances.end() ? nullptr : found->second.get();
}

void free_instance(const void* handle) {
  std::unique_ptr<Instance> freed;  // after the lock
  Registry& all = registry();
  if (has_ended) return;
  const std::lock_guard lock(all.mutex);
  if (const auto found = all.instances.find(handle); found != all.instances.end()) {
    freed = std::move(found->second);
    all.instances.erase(found);
  }
}

void* open_instance(FmiVersion version, const std::filesystem::path& resources, const char* token,
                    bool logging, const Instance::Logger& logger) {
  const DefaultFloatingPoint floating_point;
  const auto fail = [&logger](const std::string& message) {
    if (logger) logger(Status::kError, kLogCategories.back(), message);
    return nullptr;
  };
  try {
    Expected<std::unique_ptr<Instance>> instance =
        Instance::open(version, resources, token == nullptr ? "" : token, logger);
    if (!instance) return fail(instance.error().message());
    (*instance)->set_logging(logging, {});
    return add_instance(*std::move(instance));
  } catch (const std::exception& exception) {
    return fail(exception.what());
  }
}

Status set_debug_logging(const void* handle, const char* function, bool on, std::size_t count,
                         const char* const* categories) {
  return call_instance(handle, function, kAnyPhase, [&](Instance& instance) {
    if (count > 0 && categories == nullptr) return instance.report(Status::kError, "categories is null");
    return instance.set_logging(on, array_of(categories, count));
  });
}

Status save_state(const void* handle, const char* function, void** state) {
  return call_instance(handle, function, kAnyPhase, [&](Instance& instance) {
    if (state == nullptr) return instance.report(Status::kError, "there is no place for the state");
    *state = instance.save_state(*state);
    return Status::kOk;
  });
}

Status restore_state(const void* handle, const char* function, const void* state) {
  return call_instance(handle, function, kAnyPhase,
                       [&](Instance& instance) { return instance.restore_state(state); });
}

Status free_state(const void* handle, const char* function, void** state) {
  return call_instance(handle, function, kAnyPhase, [&](Instance& instance) {
    if (state == nullptr || *state == nullptr) return Status::kOk;
    if (!instance.free_state(*state)) return instance.report(Status::kError, "no state of this instance");
    *state = nullptr;
    return Status::kOk;
  });
}

Status serialized_size(const void* handle, const char* function, const void* state, std::size_t* size) {
  return call_instance(handle, function, kAnyPhase, [&](Instance& instance) {
    if (state == nullptr || size == nullptr) return instance.report(Status::kError, "there is no state");
    *size = instance.serialized_size();
    return Status::kOk;
  });
}

Status serialize(const void* handle, const char* function, const void* state, std::uint8_t* bytes,
                 std::size_t size) {
  return call_instance(handle, function, kAnyPhase,
                       [&](Instance& instance) { return instance.serialize(state, array_of(bytes, size)); });
}

Status deserialize(const void* handle, const char* function, const std::uint8_t* bytes, std::size_t size,
                   void** state) {
  return call_instance(handle, function, kAnyPhase, [&](Instance& instance) {
    void* const read = state == nullptr ? nullptr : instance.deserialize(array_of(bytes, size));
    if (read == nullptr) return instance.report(Status::kError, "these bytes are no state of this FMU");
    *state = read;
    return Status::kOk;
  });
}

Status not_supported(const void* handle, const char* function, std::size_t variables) {
  return call_instance(handle, function, kAnyPhase, [&](Instance& instance) {
    if (variables == 0) return Status::kOk;
    return instance.report(Status::kError, std::string(function) + ": this FMU does not have it");
  });
}

}  // namespace buoyancy::fmu

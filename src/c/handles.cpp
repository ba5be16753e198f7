#include "c/handles.h"

#include <mutex>
#include <shared_mutex>
#include <unordered_map>

namespace buoyancy {
namespace {

struct Registry {
  std::shared_mutex mutex;
  std::unordered_map<const void*, HandleKind> kinds;
};

// It is never destroyed: the finalisers of a managed language may free handles while the program ends.
Registry& registry() {
  static Registry* const created = new Registry;
  return *created;
}

}  // namespace

const char* to_string(HandleKind kind) {
  switch (kind) {
    case HandleKind::kMesh:
      return "a mesh";
    case HandleKind::kSea:
      return "a sea";
    case HandleKind::kScene:
      return "a scene";
    case HandleKind::kNone:
      break;
  }
  return "no handle";
}

HandleKind kind_of(const void* handle) {
  Registry& handles = registry();
  const std::shared_lock lock(handles.mutex);
  const auto found = handles.kinds.find(handle);
  return found == handles.kinds.end() ? HandleKind::kNone : found->second;
}

void add_handle(const void* handle, HandleKind kind) {
  Registry& handles = registry();
  const std::unique_lock lock(handles.mutex);
  handles.kinds[handle] = kind;
}

bool remove_handle(const void* handle, HandleKind kind) {
  Registry& handles = registry();
  const std::unique_lock lock(handles.mutex);
  const auto found = handles.kinds.find(handle);
  if (found == handles.kinds.end() || found->second != kind) return false;
  handles.kinds.erase(found);
  return true;
}

}  // namespace buoyancy

// Checks the arguments of a call of the C interface and converts them. The first failure is kept: a call
// makes all of its checks, and then returns if one of them failed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "c/failure.h"
#include "c/handles.h"

namespace buoyancy {

class ArgumentChecks {
 public:
  explicit ArgumentChecks(const char* function) : function_(function) {}

  bool failed() const { return failure_.has_value(); }
  const CallResult& failure() const { return failure_; }

  // name: of the argument, for errors; also in the functions below.
  void fail(const char* name, std::string actual, std::string expected, std::string cause = "",
            std::string hint = "");
  void not_null(const char* name, const void* pointer) {
    if (pointer == nullptr) fail(name, "NULL", "a valid pointer");
  }
  void number(const char* name, double value, bool valid, const char* expected);
  void count(const char* name, std::int64_t value, std::int64_t max);
  unsigned threads(std::int32_t value);
  Method method(buoyancy_method value);
  // text: UTF-8 with a final zero byte.
  std::string_view text(const char* name, const char* text);

  // Returns nullptr if there is no handle of this kind.
  template <typename Handle>
  const Handle* handle(const char* name, const Handle* handle) {
    return has_handle(name, handle, kKindOf<Handle>) ? handle : nullptr;
  }
  // Frees a handle; NULL is allowed.
  template <typename Handle>
  void free(const char* name, Handle* handle) {
    if (handle == nullptr) return;
    if (remove_handle(handle, kKindOf<Handle>)) {
      delete handle;
    } else {
      has_handle(name, handle, kKindOf<Handle>);
    }
  }
  // Checks the place of a new handle, and sets it to NULL until the call succeeds.
  template <typename Handle>
  void out_handle(const char* name, Handle** out) {
    not_null(name, static_cast<const void*>(out));
    if (out != nullptr) *out = nullptr;
  }

  // Returns a struct that the caller passes; nullptr if it is NULL or does not state this version's size.
  template <typename Struct>
  const Struct* given(const char* name, const Struct* value) {
    not_null(name, value);
    if (value == nullptr) return nullptr;
    return has_size(name, value->size, sizeof(Struct)) ? value : nullptr;
  }
  template <typename Struct>
  Struct* output(const char* name, Struct* value) {
    return given(name, static_cast<const Struct*>(value)) == nullptr ? nullptr : value;
  }
  bool has_size(const char* name, std::size_t size, std::size_t expected);

  // Returns n items of `per_item` elements each, or none if a check has failed. NULL is allowed if n is 0.
  template <typename Number>
  std::span<Number> array(const char* name, Number* elements, std::int64_t n, std::size_t per_item = 1) {
    if (n <= 0 || failed()) return {};
    not_null(name, elements);
    if (reinterpret_cast<std::uintptr_t>(elements) % alignof(Number) != 0)
      fail_alignment(name, alignof(Number));
    if (failed()) return {};
    return {elements, per_item * static_cast<std::size_t>(n)};
  }
  // Returns the same, or none if the array is NULL.
  template <typename Number>
  std::span<Number> optional_array(const char* name, Number* elements, std::int64_t n,
                                   std::size_t per_item = 1) {
    return elements == nullptr ? std::span<Number>() : array(name, elements, n, per_item);
  }
  // Returns the times of n poses or points. at_least: above 0 if there must be a time even for one pose.
  std::span<const std::int64_t> utimes(const std::int64_t* utimes, std::int64_t utime_count, std::int64_t n,
                                       std::int64_t at_least);

 private:
  bool has_handle(const char* name, const void* handle, HandleKind kind);
  void fail_alignment(const char* name, std::size_t alignment);

  const char* function_;
  CallResult failure_;
};

// Returns whether a regular file can be opened: if not, the error is FILE, otherwise MESH or SCENE.
bool is_readable_file(std::string_view path);

// The largest number of poses and points in a call: no machine has memory for more.
inline constexpr std::int64_t kMaxCount = std::int64_t{1} << 40;

}  // namespace buoyancy

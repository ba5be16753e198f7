#include "c/argument_checks.h"

#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "base/format.h"

namespace buoyancy {

void ArgumentChecks::fail(const char* name, std::string actual, std::string expected, std::string cause,
                          std::string hint) {
  if (failure_) return;
  std::string subject = function_;
  subject += "(), ";
  subject += name;
  failure_ = Failure{
      BUOYANCY_ERROR_INVALID_ARGUMENT,
      {std::move(subject), std::move(actual), std::move(expected), std::move(cause), std::move(hint)}};
}

void ArgumentChecks::fail_alignment(const char* name, std::size_t alignment) {
  fail(name, "an address that is no multiple of " + std::to_string(alignment), "an array of numbers",
       "the address of bytes, or no address at all");
}

void ArgumentChecks::number(const char* name, double value, bool valid, const char* expected) {
  if (!valid) fail(name, format_shortest(value), expected);
}

void ArgumentChecks::count(const char* name, std::int64_t value, std::int64_t max) {
  if (value >= 0 && value <= max) return;
  fail(name, std::to_string(value), "0 to " + std::to_string(max),
       value < 0 ? "a difference or a product that was too large" : "bytes instead of elements");
}

unsigned ArgumentChecks::threads(std::int32_t value) {
  if (value >= 0 && value <= BUOYANCY_MAX_THREADS) return static_cast<unsigned>(value);
  fail("threads", std::to_string(value), "0 to " + std::to_string(BUOYANCY_MAX_THREADS), "",
       "Pass 0 for all threads of the machine, or 1 for the caller's own");
  return 1;
}

Method ArgumentChecks::method(buoyancy_method value) {
  switch (value) {
    case BUOYANCY_METHOD_HIERARCHICAL:
      return Method::kHierarchical;
    case BUOYANCY_METHOD_FAST:
      return Method::kFast;
    case BUOYANCY_METHOD_IMPROVED:
      return Method::kImproved;
    case BUOYANCY_METHOD_EXACT:
      return Method::kExact;
    case BUOYANCY_METHOD_FAST_SURFACE:
      return Method::kFastSurface;
    case BUOYANCY_METHOD_EXACT_SURFACE:
      return Method::kExactSurface;
    default:
      break;
  }
  fail("method", std::to_string(value), "a constant BUOYANCY_METHOD_..., 0 to 5", "",
       "Pass BUOYANCY_METHOD_HIERARCHICAL unless you compare methods");
  return Method::kHierarchical;
}

std::string_view ArgumentChecks::text(const char* name, const char* text) {
  not_null(name, text);
  return text == nullptr ? std::string_view() : std::string_view(text);
}

bool ArgumentChecks::has_size(const char* name, std::size_t size, std::size_t expected) {
  if (size == expected) return true;
  fail(name, "size = " + std::to_string(size), std::to_string(expected),
       "the struct's first member is not set", "Set it to sizeof the struct");
  return false;
}

bool ArgumentChecks::has_handle(const char* name, const void* handle, HandleKind kind) {
  const HandleKind found = kind_of(handle);
  if (found == kind) return true;
  if (failure_) return false;
  std::string actual = handle == nullptr ? "NULL" : to_string(found);
  std::string cause;
  if (handle == nullptr) {
    cause = "the call that was to create it failed";
  } else if (found == HandleKind::kNone) {
    cause = "it was freed, or the call that was to create it failed";
  } else {
    cause = "the handle of another function";
  }
  fail(name, std::move(actual), to_string(kind), std::move(cause));
  failure_->code = BUOYANCY_ERROR_HANDLE;
  return false;
}

std::span<const std::int64_t> ArgumentChecks::utimes(const std::int64_t* utimes, std::int64_t utime_count,
                                                     std::int64_t n, std::int64_t at_least) {
  if (utime_count != n && utime_count != 1 && (utime_count != 0 || at_least > 0)) {
    fail("utime_count", std::to_string(utime_count),
         (at_least > 0 ? "1 or " : "0, 1 or ") + std::to_string(n) + ", the number of poses or points");
    return {};
  }
  return array("utimes", utimes, utime_count);
}

bool is_readable_file(std::string_view path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) && std::ifstream(std::string(path)).is_open();
}

}  // namespace buoyancy

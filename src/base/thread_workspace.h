// Memory that a thread keeps from call to call.
#pragma once

#include <memory>

namespace buoyancy {

// Returns the calling thread's T, made by its first call. It is on the heap: a thread_local T of a shared
// library would be part of the stack of every thread in a program, also of those that never call the library.
template <typename T>
T& thread_workspace() {
  thread_local std::unique_ptr<T> workspace;
  if (workspace == nullptr) workspace = std::make_unique<T>();
  return *workspace;
}

}  // namespace buoyancy

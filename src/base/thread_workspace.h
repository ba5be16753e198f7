// Memory that a thread keeps from call to call.
#pragma once

#include <memory>

namespace buoyancy {

// The calling thread's T, made by its first call. On the heap: a thread_local T of a shared library would be
// part of every thread's stack in a program that links the library, also of threads that never call it.
template <typename T>
T& thread_workspace() {
  thread_local std::unique_ptr<T> workspace;
  if (workspace == nullptr) workspace = std::make_unique<T>();
  return *workspace;
}

}  // namespace buoyancy

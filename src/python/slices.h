// Runs long calculations without the global interpreter lock, such that Ctrl-C ends them.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>

#include <pybind11/pybind11.h>

#include "python/exceptions.h"

namespace buoyancy::python {

// Calls work(begin, end) for ranges that partition [0, count), in order and without the lock, each for about
// 50 ms. Python's signal handlers run between them: throws what they raise, such as KeyboardInterrupt.
template <typename Work>
void run_in_slices(std::size_t count, const Work& work) {
  using Seconds = std::chrono::duration<double>;
  constexpr double kSlice = 0.05;   // [s]
  constexpr double kGrowth = 16.0;  // of a slice over the one before
  std::size_t size = 16;
  std::size_t begin = 0;
  do {
    if (begin > 0 && PyErr_CheckSignals() != 0) throw py::error_already_set();
    const std::size_t end = begin + std::min(size, count - begin);
    const auto start = std::chrono::steady_clock::now();
    {
      const WithoutGil released;
      work(begin, end);
    }
    const double taken = Seconds(std::chrono::steady_clock::now() - start).count();
    const double growth = std::min(kGrowth, kSlice / std::max(taken, 1e-9));
    size = std::max<std::size_t>(1, static_cast<std::size_t>(static_cast<double>(size) * growth));
    begin = end;
  } while (begin < count);
}

}  // namespace buoyancy::python

// The poses, velocities and times that a Python caller passes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "python/arrays.h"
#include "query/pose_arrays.h"

namespace buoyancy::python {

// Times in seconds as the utimes of messages [us], rounded to the nearest. Throws a ValueError for times that
// no utime can hold, such as NaN.
std::vector<std::int64_t> to_utimes(std::span<const double> seconds);
// Returns no times for None, one for a number, K for (K,). many: set to whether it is (K,).
std::vector<std::int64_t> to_utimes(PyObject* time, bool& many);

struct PoseObjects {
  PyObject* position = nullptr;          // (3,) or (K, 3)
  PyObject* quaternion = nullptr;        // (4,) or (K, 4)
  PyObject* linear_velocity = nullptr;   // (3,) or (K, 3); nullptr or None: at rest
  PyObject* angular_velocity = nullptr;  // (3,) or (K, 3); nullptr or None: at rest
  PyObject* time = nullptr;              // a number or (K,) [s]; nullptr: 0
};

// One pose, or K poses, of arrays whose shapes fit together: those of one pose are repeated for all.
class PoseInput {
 public:
  // Throws a TypeError or ValueError that names the argument at fault.
  explicit PoseInput(const PoseObjects& objects);
  PoseInput(const PoseInput&) = delete;
  PoseInput& operator=(const PoseInput&) = delete;

  std::size_t size() const { return size_; }
  bool single() const { return single_; }  // neither argument has a dimension of poses
  PoseArrays arrays() const;

 private:
  // One row per pose of an argument with this many columns.
  struct Rows {
    const char* name;
    std::span<const double> values;  // of the array, or repeated
    bool has_poses = false;          // (K, columns), rather than (columns,)
    std::size_t poses = 1;
    std::vector<double> repeated;
    py::object array;
    // Keeps numpy from resizing the array: it ignores exported buffers, but not weak references.
    py::object weak_reference;

    // No values where object is nullptr.
    Rows(PyObject* object, const char* name, py::ssize_t columns);
    void fit(std::size_t poses);  // repeats one row for all poses
  };

  Rows position_, quaternion_, linear_velocity_, angular_velocity_;
  std::vector<std::int64_t> utimes_;
  std::size_t size_ = 1;
  bool single_ = true;
};

}  // namespace buoyancy::python

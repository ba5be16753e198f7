// The poses, velocities and times that a Python caller passes.
#pragma once

#include <cstdint>
#include <vector>

#include "python/number_array.h"
#include "query/pose_arrays.h"

namespace buoyancy::python {

// Times in seconds as the utimes of messages [us], rounded to the nearest: none for None, one for a number, K
// for (K,); many: is it (K,)? Throws a ValueError for times that no utime can hold, such as NaN.
std::vector<std::int64_t> to_utimes(PyObject* time, bool& many);

struct PoseObjects {
  PyObject* position = nullptr;          // (3,) or (K, 3)
  PyObject* quaternion = nullptr;        // (4,) or (K, 4)
  PyObject* linear_velocity = nullptr;   // (3,) or (K, 3); nullptr or None: at rest
  PyObject* angular_velocity = nullptr;  // likewise
  PyObject* time = nullptr;              // a number or (K,) [s]; nullptr: 0
};

// One pose, or K poses, of arrays whose shapes fit together: those of one pose are repeated for all.
class PoseInput {
 public:
  // Throws a TypeError or ValueError that names the argument at fault.
  explicit PoseInput(const PoseObjects& objects);

  std::size_t size() const { return size_; }
  bool single() const { return single_; }  // neither argument has a dimension of poses
  PoseArrays arrays() const;

 private:
  // One row per pose of an argument with this many columns.
  struct Rows {
    NumberArray<double> array;
    std::vector<double> repeated;
    bool is_repeated = false;  // also for no pose at all, when `repeated` is empty
    const char* name;
    Py_ssize_t columns;

    Rows(PyObject* object, const char* name, Py_ssize_t columns);
    bool has_poses() const { return array.dimensions() == 2; }
    void fit(std::size_t poses, bool single);  // repeats one row for all poses
    std::span<const double> values() const { return is_repeated ? std::span(repeated) : array.values(); }
  };

  Rows position_, quaternion_, linear_velocity_, angular_velocity_;
  std::vector<std::int64_t> utimes_;
  std::size_t size_ = 1;
  bool single_ = true;
};

}  // namespace buoyancy::python

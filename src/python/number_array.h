// Numbers that a Python caller passes, as contiguous doubles or 64-bit integers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <pybind11/pybind11.h>

namespace buoyancy::python {

namespace py = pybind11;

inline constexpr int kMaxDimensions = 8;

// The memory that another object exports. Its end needs the global interpreter lock.
struct HeldBuffer {
  HeldBuffer() = default;
  ~HeldBuffer() { release(); }
  HeldBuffer(const HeldBuffer&) = delete;
  HeldBuffer& operator=(const HeldBuffer&) = delete;
  void release() {
    if (held) PyBuffer_Release(&view);
    held = false;
  }

  bool held = false;
  Py_buffer view{};
};

// Refers to the object's own memory where it has native numbers of this type in C order: no copy. Other
// numbers, other strides, and lists and tuples of numbers are converted into a copy.
//
// Number: double, which takes integers and floats of every size, or std::int64_t, which takes integers only.
// bool, complex, text, bytes, objects and numbers of the other byte order are refused.
template <typename Number>
class NumberArray {
 public:
  // An absent argument, without values.
  NumberArray() = default;
  // name: of the argument, for errors. object: nullptr for an absent argument. Throws a TypeError or
  // ValueError that names it.
  NumberArray(PyObject* object, const char* name);
  NumberArray(const NumberArray&) = delete;
  NumberArray& operator=(const NumberArray&) = delete;

  std::span<const Number> values() const { return {data_, size_}; }
  int dimensions() const { return dimensions_; }
  Py_ssize_t extent(int dimension) const { return shape_[static_cast<std::size_t>(dimension)]; }
  std::span<const Py_ssize_t> shape() const {
    return std::span(shape_).first(static_cast<std::size_t>(dimensions_));
  }
  bool has_shape(std::initializer_list<Py_ssize_t> expected) const;

 private:
  void refer_to_numpy(PyObject* array);
  void refer_to_buffer(PyObject* object, const char* name);
  void keep_from_resizing(PyObject* object);
  void copy_sequence(PyObject* sequence, const char* name);
  void append(PyObject* item, int depth, const char* name);
  void add_dimension(Py_ssize_t extent, int depth, const char* name);

  const Number* data_ = nullptr;
  std::size_t size_ = 0;
  int dimensions_ = 0;
  std::array<Py_ssize_t, kMaxDimensions> shape_{};
  HeldBuffer buffer_;
  // To the array whose memory this is: numpy does not resize an array that one refers to, whereas it ignores
  // the buffers that an array has exported.
  py::object weak_reference_;
  std::vector<Number> copy_;
  int leaf_depth_ = -1;  // of the numbers in nested sequences; -1: not known yet
};

extern template class NumberArray<double>;
extern template class NumberArray<std::int64_t>;

// "(3, 4)", as Python prints it.
std::string shape_text(std::span<const Py_ssize_t> shape);

// One number, such as a level. Throws a TypeError for anything else, such as a bool or text.
double to_double(PyObject* object, const char* name);

// Whether numpy can be imported; known once the module is imported. Results are memoryviews without it.
bool has_numpy();
void look_for_numpy();

}  // namespace buoyancy::python

// Numpy arrays: the numbers that a Python caller passes, and views of results.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>

#include "base/vec3.h"

namespace buoyancy::python {

namespace py = pybind11;

// The flags of arrays that are read in place: aligned numbers in C order.
inline constexpr int kInPlace = int{py::array::c_style} | int{py::detail::npy_api::NPY_ARRAY_ALIGNED_};

template <typename Number>
using Numbers = py::array_t<Number, kInPlace | int{py::array::forcecast}>;

// The caller's own array if it is of this kind: no copy. Arrays of other numbers and strides, objects with
// the buffer protocol or __array__(), and lists and tuples of numbers are converted into a copy.
//
// Number: double, which takes integers and floats of every size, or std::int64_t, which takes integers only.
// bool, complex, text, bytes, objects and numbers of the other byte order are refused. name: of the argument.
// Throws a TypeError, ValueError or OverflowError, the first two of which name it.
template <typename Number>
Numbers<Number> to_numbers(PyObject* object, const char* name);

extern template Numbers<double> to_numbers(PyObject* object, const char* name);
extern template Numbers<std::int64_t> to_numbers(PyObject* object, const char* name);

template <typename Number>
std::span<const Number> values_of(const Numbers<Number>& array) {
  return {array.data(), static_cast<std::size_t>(array.size())};
}

// Three numbers. Throws a ValueError for another shape; expected: for its text.
Vec3 to_vector(PyObject* object, const char* name, const char* expected);

// "(3, 4)", as Python prints it.
std::string shape_text(const py::array& array);

// One number, such as a level. Throws a TypeError for anything else, such as a bool or text.
template <typename Number>
Number to_number(PyObject* object, const char* name);

extern template double to_number(PyObject* object, const char* name);
extern template std::int64_t to_number(PyObject* object, const char* name);

// A view of one member of all records, which owner keeps: (K, ...), or (...) of the only record. A scalar of
// the only record is a Python number. member: points to it, or is a function that returns a reference to it.
template <typename Record, typename MemberOf>
py::object record_field(std::span<Record> records, bool single, py::handle owner, MemberOf member) {
  static Record none{};
  auto& first = std::invoke(member, records.empty() ? none : records.front());
  using Member = std::remove_reference_t<decltype(first)>;
  if constexpr (std::is_arithmetic_v<Member>) {
    if (single) return py::cast(first);
  }
  // Of a std::array, numpy appends the shape to that of the records. Never destroyed.
  static const py::handle type = py::dtype::of<Member>().release();
  std::vector<py::ssize_t> shape, strides;
  if (!single) {
    shape.push_back(static_cast<py::ssize_t>(records.size()));
    strides.push_back(sizeof(Record));
  }
  return py::array(py::reinterpret_borrow<py::dtype>(type), std::move(shape), std::move(strides), &first,
                   owner);
}

}  // namespace buoyancy::python

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

// Returns the caller's own array, without a copy, if its numbers are of this type and can be read in place.
// Other arrays, objects with the buffer protocol or __array__(), lists and tuples are converted into a copy.
//
// Number: double, which takes integers and floats of up to 64 bits, or std::int64_t, which takes integers.
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

// Returns three numbers. Throws a ValueError for another shape, whose text contains `expected`.
Vec3 to_vector(PyObject* object, const char* name, const char* expected);

// "(3, 4)", as Python prints it.
std::string shape_text(const py::array& array);

// Returns one number, such as a level. Throws a TypeError for anything else, such as a bool or text.
template <typename Number>
Number to_number(PyObject* object, const char* name);

extern template double to_number(PyObject* object, const char* name);
extern template std::int64_t to_number(PyObject* object, const char* name);

// Returns a view of one member of all records, which owner keeps alive: (K, ...), or (...) if single, where a
// scalar is a Python number. member: a pointer to the member, or a function that returns a reference to it.
template <typename Record, typename MemberOf>
py::object record_field(std::span<Record> records, bool single, py::handle owner, MemberOf member) {
  static Record none{};
  auto& first = std::invoke(member, records.empty() ? none : records.front());
  using Member = std::remove_reference_t<decltype(first)>;
  if constexpr (std::is_arithmetic_v<Member>) {
    if (single) return py::cast(first);
  }
  // Numpy appends the shape of a std::array to that of the records. The type is never destroyed.
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

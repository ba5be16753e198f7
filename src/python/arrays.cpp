#include "python/arrays.h"

#include <algorithm>

namespace buoyancy::python {
namespace {

constexpr int kMaxDimensions = 8;

template <typename Number>
constexpr const char* expected_numbers() {
  return std::is_same_v<Number, double> ? "numbers, for example a numpy array of float64"
                                        : "integers, for example a numpy array of int64";
}

// Names the type of the object's elements as the user would: by numpy's dtype, else by the object's type.
std::string type_text(py::handle object) {
  if (py::hasattr(object, "dtype")) return "an array of " + std::string(py::str(object.attr("dtype")));
  return object.is_none() ? "None" : std::string("a ") + Py_TYPE(object.ptr())->tp_name;
}

[[noreturn]] void refuse(PyObject* object, const char* name, const std::string& expected) {
  throw py::type_error(std::string(name) + " is " + type_text(object) + "; expected " + expected);
}

// Sets value if the object is a Python number of its own right; false if it is something else.
bool read_number(PyObject* object, double& value) {
  if (PyFloat_Check(object)) {
    value = PyFloat_AS_DOUBLE(object);
    return true;
  }
  if (!PyLong_Check(object) || PyBool_Check(object)) return false;
  value = PyLong_AsDouble(object);
  if (value == -1.0 && PyErr_Occurred() != nullptr) throw py::error_already_set();
  return true;
}

bool read_number(PyObject* object, std::int64_t& value) {
  if (!PyLong_Check(object) || PyBool_Check(object)) return false;
  value = PyLong_AsLongLong(object);
  if (value == -1 && PyErr_Occurred() != nullptr) throw py::error_already_set();
  return true;
}

bool is_sequence(PyObject* object) {
  return PyList_Check(object) || PyTuple_Check(object);
}

// Throws for elements that numpy would convert although they are no numbers of this type: True to 1, "1" to
// 1, None to NaN, and 1.5 to the integer 1.
template <typename Number>
void check_elements(PyObject* sequence, const char* name, int depth) {
  if (depth > kMaxDimensions) {
    throw py::value_error(std::string(name) + " has sequences within sequences, more than " +
                          std::to_string(kMaxDimensions) + " deep");
  }
  // The size is read each time, since a list may change while an element converts itself.
  for (Py_ssize_t i = 0; i < PySequence_Fast_GET_SIZE(sequence); ++i) {
    const auto element = py::reinterpret_borrow<py::object>(PySequence_Fast_GET_ITEM(sequence, i));
    if (is_sequence(element.ptr())) {
      check_elements<Number>(element.ptr(), name, depth + 1);
    } else if (Number number{}; !read_number(element.ptr(), number)) {
      to_numbers<Number>(element.ptr(), name);
    }
  }
}

template <typename Number>
Numbers<Number> from_sequence(PyObject* sequence, const char* name) {
  // A row of Python numbers is read here: numpy takes longer for one position than a query of its pose.
  const Py_ssize_t size = PySequence_Fast_GET_SIZE(sequence);
  Numbers<Number> row(size);
  Py_ssize_t i = 0;
  while (i < size && read_number(PySequence_Fast_GET_ITEM(sequence, i), row.mutable_data()[i])) ++i;
  if (i == size) return row;
  check_elements<Number>(sequence, name, 1);
  try {
    return Numbers<Number>(py::reinterpret_borrow<py::object>(sequence));
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_ValueError)) throw;
    throw py::value_error(std::string(name) + " has rows of different lengths");
  }
}

// Returns whether numbers of this type are a kind that Number takes, such as integers for double.
template <typename Number>
bool converts(const py::dtype& type) {
  constexpr bool kTakesFloats = std::is_same_v<Number, double>;
  const bool is_number = type.kind() == 'i' || type.kind() == 'u' || (kTakesFloats && type.kind() == 'f');
  const bool is_own_order = type.byteorder() == '=' || type.byteorder() == '|';
  return is_number && is_own_order && type.itemsize() <= static_cast<py::ssize_t>(sizeof(Number));
}

}  // namespace

template <typename Number>
Numbers<Number> to_numbers(PyObject* object, const char* name) {
  if (is_sequence(object)) return from_sequence<Number>(object, name);
  Number number{};
  if (read_number(object, number)) return Numbers<Number>(py::array::ShapeContainer{}, &number);
  // Numpy would take the bytes of a bytearray for integers.
  if (PyByteArray_Check(object)) refuse(object, name, expected_numbers<Number>());
  const py::array array = py::reinterpret_borrow<py::object>(object);
  if (!converts<Number>(array.dtype())) refuse(object, name, expected_numbers<Number>());
  if (array.ndim() > kMaxDimensions) {
    throw py::value_error(std::string(name) + " has " + std::to_string(array.ndim()) +
                          " dimensions; expected at most " + std::to_string(kMaxDimensions));
  }
  if (array.dtype().is(py::dtype::of<Number>()) && (array.flags() & kInPlace) == kInPlace) {
    return py::reinterpret_borrow<Numbers<Number>>(array);
  }
  Numbers<Number> numbers(array);
  if constexpr (std::is_same_v<Number, std::int64_t>) {
    const std::span<const Number> values = values_of(numbers);
    const auto wrapped = std::ranges::find_if(values, [](Number n) { return n < 0; });
    if (array.dtype().kind() == 'u' && wrapped != values.end()) {
      throw py::value_error(std::string(name) + " has " +
                            std::to_string(static_cast<std::uint64_t>(*wrapped)) +
                            "; expected integers below 2^63");
    }
  }
  return numbers;
}

template Numbers<double> to_numbers(PyObject* object, const char* name);
template Numbers<std::int64_t> to_numbers(PyObject* object, const char* name);

Vec3 to_vector(PyObject* object, const char* name, const char* expected) {
  const Numbers<double> array = to_numbers<double>(object, name);
  if (array.ndim() != 1 || array.size() != 3) {
    throw py::value_error(std::string(name) + " has shape " + shape_text(array) + "; expected " + expected);
  }
  return Vec3(array.data());
}

std::string shape_text(const py::array& array) {
  return py::str(array.attr("shape"));
}

template <typename Number>
Number to_number(PyObject* object, const char* name) {
  Number value{};
  if (read_number(object, value)) return value;
  if (is_sequence(object)) refuse(object, name, "one number");
  const Numbers<Number> array = to_numbers<Number>(object, name);
  if (array.ndim() != 0) {
    throw py::type_error(std::string(name) + " has shape " + shape_text(array) + "; expected one number");
  }
  return *array.data();
}

template double to_number(PyObject* object, const char* name);
template std::int64_t to_number(PyObject* object, const char* name);

}  // namespace buoyancy::python

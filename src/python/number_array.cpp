#include "python/number_array.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <type_traits>

#include <pybind11/numpy.h>

namespace buoyancy::python {
namespace {

// Of numpy, once it is found: its class of arrays, and its numbers of the types that are not copied. The
// class stays: numpy is never unloaded.
PyTypeObject* numpy_array = nullptr;
int numpy_float64 = 0;
int numpy_int64 = 0;

template <typename Number>
constexpr const char* expected_numbers() {
  return std::is_same_v<Number, double> ? "numbers, for example a numpy array of float64"
                                        : "integers, for example a numpy array of int64";
}

// What the user would call the type of the object's elements: numpy's dtype, else that of the object itself.
std::string type_text(PyObject* object) {
  if (PyObject* const dtype = PyObject_GetAttrString(object, "dtype")) {
    const auto owned = py::reinterpret_steal<py::object>(dtype);
    if (PyObject* const text = PyObject_Str(dtype)) {
      return "an array of " + std::string(py::reinterpret_steal<py::str>(text));
    }
  }
  PyErr_Clear();
  return object == Py_None ? "None" : std::string("a ") + Py_TYPE(object)->tp_name;
}

[[noreturn]] void refuse(PyObject* object, const char* name, const std::string& expected) {
  throw py::type_error(std::string(name) + " is " + type_text(object) + "; expected " + expected);
}

enum class Kind { kFloat, kSigned, kUnsigned, kOther };

Kind kind_of(const Py_buffer& buffer) {
  const char* format = buffer.format == nullptr ? "B" : buffer.format;
  constexpr char kOwnOrder = std::endian::native == std::endian::little ? '<' : '>';
  if (*format == '@' || *format == '=' || *format == kOwnOrder) ++format;
  if (std::strlen(format) != 1) return Kind::kOther;
  if (std::strchr("efd", *format) != nullptr) return Kind::kFloat;
  if (std::strchr("bhilqn", *format) != nullptr) return Kind::kSigned;
  if (std::strchr("BHILQN", *format) != nullptr) return Kind::kUnsigned;
  return Kind::kOther;
}

template <typename Source, typename Number>
void copy_elements(const char* source, const Py_buffer& buffer, int dimension, Number*& out) {
  if (dimension == buffer.ndim) {
    Source value;
    std::memcpy(&value, source, sizeof(value));
    *out++ = static_cast<Number>(value);  // NOLINT(bugprone-signed-char-misuse): a number of one byte
    return;
  }
  for (Py_ssize_t i = 0; i < buffer.shape[dimension]; ++i) {
    copy_elements<Source>(source + i * buffer.strides[dimension], buffer, dimension + 1, out);
  }
}

// 16 bits, of a numpy.float16.
struct Half {
  char bytes[2];
  explicit operator double() const {
    return PyFloat_Unpack2(bytes, std::endian::native == std::endian::little);
  }
  explicit operator std::int64_t() const { return 0; }  // never called: integers only
};

// Returns false for a size that no number of this kind has.
template <typename Number>
bool copy_buffer(const Py_buffer& buffer, Kind kind, Number* out) {
  const char* const source = static_cast<const char*>(buffer.buf);
  const auto copy = [&]<typename Source>(Source) {
    if (buffer.itemsize != sizeof(Source)) return false;
    copy_elements<Source>(source, buffer, 0, out);
    return true;
  };
  switch (kind) {
    case Kind::kFloat:
      return copy(double{}) || copy(float{}) || copy(Half{});
    case Kind::kSigned:
      return copy(std::int64_t{}) || copy(std::int32_t{}) || copy(std::int16_t{}) || copy(std::int8_t{});
    case Kind::kUnsigned:
      return copy(std::uint64_t{}) || copy(std::uint32_t{}) || copy(std::uint16_t{}) || copy(std::uint8_t{});
    case Kind::kOther:
      break;
  }
  return false;
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

}  // namespace

bool has_numpy() {
  return numpy_array != nullptr;
}

void look_for_numpy() {
  try {
    numpy_float64 = py::dtype::of<double>().num();
    numpy_int64 = py::dtype::of<std::int64_t>().num();
    const py::object array = py::module_::import("numpy").attr("ndarray");
    numpy_array = reinterpret_cast<PyTypeObject*>(array.inc_ref().ptr());
  } catch (py::error_already_set& error) {
    // A numpy that is broken counts as missing too: the module works without it.
    error.restore();
    PyErr_Clear();
  }
}

std::string shape_text(std::span<const Py_ssize_t> shape) {
  std::string text = "(";
  for (const Py_ssize_t extent : shape) {
    if (text.size() > 1) text += ", ";
    text += std::to_string(extent);
  }
  return text + (shape.size() == 1 ? ",)" : ")");
}

double to_double(PyObject* object, const char* name) {
  double value = 0.0;
  if (read_number(object, value)) return value;
  if (object == Py_None || PyBool_Check(object) || PyUnicode_Check(object) || PyBytes_Check(object) ||
      is_sequence(object)) {
    throw py::type_error(std::string(name) + " is " + type_text(object) + "; expected a number");
  }
  const NumberArray<double> array(object, name);
  if (array.dimensions() != 0) {
    throw py::type_error(std::string(name) + " has shape " + shape_text(array.shape()) +
                         "; expected one number");
  }
  return array.values()[0];
}

template <typename Number>
NumberArray<Number>::NumberArray(PyObject* object, const char* name) {
  if (object == nullptr) return;
  if (Py_TYPE(object) == numpy_array) {
    refer_to_numpy(object);
    if (data_ != nullptr) return;
  }
  if (is_sequence(object)) {
    copy_sequence(object, name);
    return;
  }
  if (PyBytes_Check(object) || PyByteArray_Check(object) || PyUnicode_Check(object) || PyBool_Check(object)) {
    refuse(object, name, expected_numbers<Number>());
  }
  Number number{};
  if (read_number(object, number)) {
    copy_.push_back(number);
    data_ = copy_.data();
    size_ = 1;
    return;
  }
  if (PyObject_CheckBuffer(object) != 0) {
    refer_to_buffer(object, name);
    return;
  }
  // Tensors and tables of other libraries convert themselves.
  if (has_numpy() && PyObject_HasAttrString(object, "__array__") != 0) {
    const py::object array = py::module_::import("numpy").attr("asarray")(py::handle(object));
    if (PyObject_CheckBuffer(array.ptr()) != 0) {
      refer_to_buffer(array.ptr(), name);
      return;
    }
  }
  refuse(object, name, expected_numbers<Number>());
}

// The buffer protocol takes half a microsecond of numpy, which is half of what a call costs.
template <typename Number>
void NumberArray<Number>::refer_to_numpy(PyObject* object) {
  const auto array = py::reinterpret_borrow<py::array>(object);
  const py::dtype type = array.dtype();
  const bool own_type = type.num() == (std::is_same_v<Number, double> ? numpy_float64 : numpy_int64);
  const bool own_order = type.byteorder() == '=' || type.byteorder() == '|';
  const bool aligned = reinterpret_cast<std::uintptr_t>(array.data()) % alignof(Number) == 0;
  if ((array.flags() & py::array::c_style) == 0 || !own_type || !own_order || !aligned ||
      array.ndim() > kMaxDimensions) {
    return;
  }
  dimensions_ = static_cast<int>(array.ndim());
  size_ = static_cast<std::size_t>(array.size());
  std::copy_n(array.shape(), dimensions_, shape_.begin());
  data_ = static_cast<const Number*>(array.data());
  keep_from_resizing(object);
}

template <typename Number>
void NumberArray<Number>::keep_from_resizing(PyObject* object) {
  if (PyType_SUPPORTS_WEAKREFS(Py_TYPE(object)) == 0) return;
  weak_reference_ = py::reinterpret_steal<py::object>(PyWeakref_NewRef(object, nullptr));
  if (!weak_reference_) throw py::error_already_set();
}

template <typename Number>
void NumberArray<Number>::refer_to_buffer(PyObject* object, const char* name) {
  Py_buffer& view = buffer_.view;
  if (PyObject_GetBuffer(object, &view, PyBUF_STRIDES | PyBUF_FORMAT) != 0) {
    PyErr_Clear();
    refuse(object, name, expected_numbers<Number>());
  }
  buffer_.held = true;
  if (view.ndim > kMaxDimensions) {
    throw py::value_error(std::string(name) + " has " + std::to_string(view.ndim) +
                          " dimensions; expected at most " + std::to_string(kMaxDimensions));
  }
  const Kind kind = kind_of(view);
  if (kind == Kind::kOther || (kind == Kind::kFloat && !std::is_same_v<Number, double>)) {
    refuse(object, name, expected_numbers<Number>());
  }
  dimensions_ = view.ndim;
  size_ = 1;
  for (std::size_t i = 0; i < static_cast<std::size_t>(dimensions_); ++i) {
    shape_[i] = view.shape[i];
    size_ *= static_cast<std::size_t>(shape_[i]);
  }
  const bool own_type = kind == (std::is_same_v<Number, double> ? Kind::kFloat : Kind::kSigned) &&
                        view.itemsize == sizeof(Number);
  const bool aligned = reinterpret_cast<std::uintptr_t>(view.buf) % alignof(Number) == 0;
  if (own_type && aligned && PyBuffer_IsContiguous(&view, 'C') != 0) {
    data_ = static_cast<const Number*>(view.buf);
    keep_from_resizing(object);
    return;
  }
  copy_.resize(size_);
  if (size_ > 0 && !copy_buffer(view, kind, copy_.data())) refuse(object, name, expected_numbers<Number>());
  if constexpr (std::is_same_v<Number, std::int64_t>) {
    const auto too_large =
        kind == Kind::kUnsigned ? std::ranges::find_if(copy_, [](Number n) { return n < 0; }) : copy_.end();
    if (too_large != copy_.end()) {
      throw py::value_error(std::string(name) + " has " +
                            std::to_string(static_cast<std::uint64_t>(*too_large)) +
                            "; expected integers below 2^63");
    }
  }
  data_ = copy_.data();
  buffer_.release();
}

template <typename Number>
void NumberArray<Number>::copy_sequence(PyObject* sequence, const char* name) {
  append(sequence, 0, name);
  if (leaf_depth_ < 0) leaf_depth_ = dimensions_;  // no numbers at all
  data_ = copy_.data();
  size_ = copy_.size();
}

// Throws unless all rows at this depth have this many elements.
template <typename Number>
void NumberArray<Number>::add_dimension(Py_ssize_t extent, int depth, const char* name) {
  if (depth >= kMaxDimensions) {
    throw py::value_error(std::string(name) + " has sequences within sequences, more than " +
                          std::to_string(kMaxDimensions) + " deep");
  }
  Py_ssize_t& known = shape_[static_cast<std::size_t>(depth)];
  if (depth == dimensions_ && leaf_depth_ < 0) {
    known = extent;
    ++dimensions_;
  } else if (depth >= dimensions_ || known != extent) {
    throw py::value_error(std::string(name) + " has rows of different lengths");
  }
}

template <typename Number>
void NumberArray<Number>::append(PyObject* item, int depth, const char* name) {
  const auto at_depth = [&](int leaf) {
    if (leaf_depth_ < 0) leaf_depth_ = leaf;
    if (leaf_depth_ != leaf || dimensions_ != leaf) {
      throw py::value_error(std::string(name) + " has rows of different lengths");
    }
  };
  if (is_sequence(item)) {
    const bool is_list = PyList_Check(item);
    const Py_ssize_t count = is_list ? PyList_GET_SIZE(item) : PyTuple_GET_SIZE(item);
    add_dimension(count, depth, name);
    for (Py_ssize_t i = 0; i < count; ++i) {
      // A list may change while an element is converted.
      if (is_list && i >= PyList_GET_SIZE(item))
        throw py::value_error(std::string(name) + " changed while it was read");
      const auto element =
          py::reinterpret_borrow<py::object>(is_list ? PyList_GET_ITEM(item, i) : PyTuple_GET_ITEM(item, i));
      append(element.ptr(), depth + 1, name);
    }
    return;
  }
  Number number{};
  if (read_number(item, number)) {
    at_depth(depth);
    copy_.push_back(number);
    return;
  }
  const NumberArray<Number> nested(item, name);
  for (int i = 0; i < nested.dimensions(); ++i) add_dimension(nested.extent(i), depth + i, name);
  at_depth(depth + nested.dimensions());
  copy_.insert(copy_.end(), nested.values().begin(), nested.values().end());
}

template <typename Number>
bool NumberArray<Number>::has_shape(std::initializer_list<Py_ssize_t> expected) const {
  return std::equal(expected.begin(), expected.end(), shape().begin(), shape().end());
}

template class NumberArray<double>;
template class NumberArray<std::int64_t>;

}  // namespace buoyancy::python

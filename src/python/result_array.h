// Arrays that Python callers get: views of results, not copies.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <type_traits>
#include <vector>

#include <pybind11/pybind11.h>

#include "messages/request.h"

namespace buoyancy::python {

namespace py = pybind11;

enum class ElementType { kDouble, kInt32, kInt64 };

// A numpy array, or a memoryview where there is no numpy, of memory that the owner keeps. strides: [bytes].
py::object make_array(ElementType type, std::vector<Py_ssize_t> shape, std::vector<Py_ssize_t> strides,
                      void* data, py::handle owner);

// The same for memory in C order.
template <typename Number>
constexpr ElementType element_type() {
  if constexpr (std::is_same_v<Number, double>) return ElementType::kDouble;
  if constexpr (std::is_same_v<Number, std::int64_t>) return ElementType::kInt64;
  return ElementType::kInt32;
}
template <typename Number>
py::object make_array(std::vector<Py_ssize_t> shape, Number* data, py::handle owner) {
  std::vector<Py_ssize_t> strides(shape.size());
  Py_ssize_t stride = sizeof(Number);
  for (std::size_t i = shape.size(); i-- > 0;) {
    strides[i] = stride;
    stride *= shape[i];
  }
  return make_array(element_type<Number>(), std::move(shape), std::move(strides), data, owner);
}

// An array that owns its numbers.
py::object make_owned_array(std::vector<Py_ssize_t> shape, std::vector<double> values);

// The shape and the numbers of a member of a record.
template <typename Member>
struct MemberShape {
  using Number = Member;
  static void append(std::vector<Py_ssize_t>& /*shape*/) {}
};
template <typename Element, std::size_t kCount>
struct MemberShape<std::array<Element, kCount>> {
  using Number = typename MemberShape<Element>::Number;
  static void append(std::vector<Py_ssize_t>& shape) {
    shape.push_back(kCount);
    MemberShape<Element>::append(shape);
  }
};

// The array of one member of all records: (K, ...), or (...) of the only record. member: returns a reference
// to the member of a record. A scalar of the only record is a Python number.
template <typename Record, typename MemberOf>
py::object record_field(std::span<Record> records, bool single, py::handle owner, MemberOf member) {
  using Member = std::remove_cvref_t<decltype(member(records.front()))>;
  using Number = typename MemberShape<Member>::Number;
  if constexpr (!std::is_class_v<Member>) {
    if (single) {
      if constexpr (std::is_enum_v<Member>)
        return py::int_(static_cast<std::int32_t>(member(records.front())));
      else
        return py::cast(member(records.front()));
    }
  }
  std::vector<Py_ssize_t> shape;
  if (!single) shape.push_back(static_cast<Py_ssize_t>(records.size()));
  MemberShape<Member>::append(shape);
  std::vector<Py_ssize_t> strides(shape.size());
  Py_ssize_t stride = sizeof(Number);
  for (std::size_t i = shape.size(); i-- > (single ? 0U : 1U);) {
    strides[i] = stride;
    stride *= shape[i];
  }
  if (!single) strides[0] = sizeof(Record);
  static Record none{};
  void* const data = records.empty() ? &member(none) : &member(records.front());
  return make_array(element_type<Number>(), std::move(shape), std::move(strides), data, owner);
}

// buoyancy.Status, an IntEnum.
void define_status(py::module_& module);
py::object status_object(BodyStatus status);

// What a status means and what to do, as a phrase.
const char* explain(BodyStatus status);

void define_array_view(py::module_& module);

}  // namespace buoyancy::python

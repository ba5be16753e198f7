#include "python/toml_text.h"

#include <array>
#include <cstdio>

#include "base/format.h"

namespace buoyancy::python {
namespace {

namespace py = pybind11;

constexpr int kMaxDepth = 16;  // of tables within tables; a list may contain itself

std::string quoted(const std::string& text) {
  std::string toml = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      toml += '\\';
      toml += c;
    } else if (code < 0x20 || code == 0x7f) {
      std::array<char, 8> escape{};
      std::snprintf(escape.data(), escape.size(), "\\u%04x", code);
      toml += escape.data();
    } else {
      toml += c;
    }
  }
  return toml + '"';
}

std::string float_text(double value) {
  std::string text = format_shortest(value);
  // Without a point or an exponent, TOML would read an integer, which might be out of range.
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

std::string value_text(py::handle value, const std::string& name, int depth);

std::string array_text(const py::object& values, const std::string& name, int depth) {
  std::string text = "[";
  for (const py::handle element : values) {
    if (text.size() > 1) text += ", ";
    text += value_text(element, name, depth);
  }
  return text + "]";
}

std::string table_text(const py::dict& values, int depth) {
  std::string text = "{";
  for (const auto& [key, value] : values) {
    text += text.size() > 1 ? ", " : " ";
    const std::string name = py::str(key);
    text += quoted(name) + " = " + value_text(value, name, depth);
  }
  return text + " }";
}

std::string value_text(py::handle value, const std::string& name, int depth) {
  if (depth > kMaxDepth) throw py::value_error(name + " has tables or lists within each other without end");
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  if (py::isinstance<py::float_>(value)) return float_text(value.cast<double>());
  if (py::isinstance<py::int_>(value)) return py::str(value);
  if (py::isinstance<py::str>(value)) return quoted(value.cast<std::string>());
  if (py::isinstance<py::dict>(value)) return table_text(py::reinterpret_borrow<py::dict>(value), depth + 1);
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    return array_text(py::reinterpret_borrow<py::object>(value), name, depth + 1);
  }
  if (py::hasattr(value, "__fspath__")) return quoted(value.attr("__fspath__")().cast<std::string>());
  // Numpy's arrays and scalars.
  if (py::hasattr(value, "tolist")) return value_text(value.attr("tolist")(), name, depth + 1);
  throw py::type_error(name + " is " +
                       (value.is_none() ? "None" : std::string("a ") + Py_TYPE(value.ptr())->tp_name) +
                       "; expected a value of the scene file: a number, text, a list or a dict");
}

}  // namespace

std::string to_toml(py::handle value, const std::string& name) {
  return value_text(value, name, 0);
}

std::string toml_line(py::handle key, py::handle value) {
  const std::string name = py::str(key);
  return quoted(name) + " = " + to_toml(value, name) + "\n";
}

}  // namespace buoyancy::python

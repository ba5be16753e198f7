#include "python/pose_input.h"

#include <cmath>
#include <string>

#include "base/format.h"

namespace buoyancy::python {
namespace {

std::int64_t to_utime(double seconds) {
  constexpr double kMaxSeconds = 9.2e12;  // as many microseconds as an int64 holds
  if (!(std::abs(seconds) <= kMaxSeconds)) {
    throw py::value_error("time is " + format_shortest(seconds) +
                          " s; expected finite seconds within 9.2e12 of 0, as the "
                          "utimes of messages have them");
  }
  return std::llround(seconds * 1e6);
}

bool is_absent(PyObject* object) {
  return object == nullptr || object == Py_None;
}

}  // namespace

std::vector<std::int64_t> to_utimes(PyObject* time, bool& many) {
  many = false;
  if (is_absent(time)) return {};
  if (PyFloat_Check(time)) return {to_utime(PyFloat_AS_DOUBLE(time))};
  const NumberArray<double> seconds(time, "time");
  if (seconds.dimensions() > 1) {
    throw py::value_error("time has shape " + shape_text(seconds.shape()) + "; expected a number or (K,)");
  }
  many = seconds.dimensions() == 1;
  std::vector<std::int64_t> utimes;
  utimes.reserve(seconds.values().size());
  for (const double second : seconds.values()) utimes.push_back(to_utime(second));
  return utimes;
}

PoseInput::Rows::Rows(PyObject* object, const char* of, Py_ssize_t expected)
    : array(object, of), name(of), columns(expected) {
  if (object == nullptr) return;
  const int dimensions = array.dimensions();
  if ((dimensions == 1 || dimensions == 2) && array.extent(dimensions - 1) == columns) return;
  const std::string row = std::to_string(columns);
  throw py::value_error(std::string(name) + " has shape " + shape_text(array.shape()) + "; expected (" + row +
                        ",) for one pose or (K, " + row + ") for K poses");
}

void PoseInput::Rows::fit(std::size_t poses, bool single) {
  const std::span<const double> row = array.values();
  if (row.empty() || single || has_poses()) return;
  is_repeated = true;
  repeated.reserve(poses * row.size());
  for (std::size_t i = 0; i < poses; ++i) repeated.insert(repeated.end(), row.begin(), row.end());
}

PoseInput::PoseInput(const PoseObjects& objects)
    : position_(objects.position, "position", 3),
      quaternion_(objects.quaternion, "quaternion", 4),
      linear_velocity_(is_absent(objects.linear_velocity) ? nullptr : objects.linear_velocity,
                       "linear_velocity", 3),
      angular_velocity_(is_absent(objects.angular_velocity) ? nullptr : objects.angular_velocity,
                        "angular_velocity", 3) {
  bool many_times = false;
  utimes_ = to_utimes(objects.time, many_times);
  // The argument that said how many poses there are.
  const char* counted = nullptr;
  const auto count = [&](const char* name, std::size_t poses) {
    if (counted != nullptr && poses != size_) {
      throw py::value_error(std::string(name) + " is for " + std::to_string(poses) + " poses, but " +
                            counted + " for " + std::to_string(size_) + "; expected as many of each");
    }
    counted = name;
    size_ = poses;
  };
  for (const Rows* const rows : {&position_, &quaternion_, &linear_velocity_, &angular_velocity_}) {
    if (rows->has_poses()) count(rows->name, static_cast<std::size_t>(rows->array.extent(0)));
  }
  if (many_times) count("time", utimes_.size());
  single_ = counted == nullptr;
  for (Rows* const rows : {&position_, &quaternion_, &linear_velocity_, &angular_velocity_}) {
    rows->fit(size_, single_);
  }
}

PoseArrays PoseInput::arrays() const {
  return {position_.values(), quaternion_.values(), linear_velocity_.values(), angular_velocity_.values(),
          utimes_};
}

}  // namespace buoyancy::python

#include "python/pose_input.h"

#include <cmath>
#include <string>

#include "base/format.h"
#include "python/call_arguments.h"

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

}  // namespace

std::vector<std::int64_t> to_utimes(std::span<const double> seconds) {
  std::vector<std::int64_t> utimes;
  utimes.reserve(seconds.size());
  for (const double second : seconds) utimes.push_back(to_utime(second));
  return utimes;
}

std::vector<std::int64_t> to_utimes(PyObject* time, bool& many) {
  many = false;
  if (!is_given(time)) return {};
  if (PyFloat_Check(time)) return {to_utime(PyFloat_AS_DOUBLE(time))};
  const Numbers<double> seconds = to_numbers<double>(time, "time");
  if (seconds.ndim() > 1) {
    throw py::value_error("time has shape " + shape_text(seconds) + "; expected a number or (K,)");
  }
  many = seconds.ndim() == 1;
  return to_utimes(values_of(seconds));
}

PoseInput::Rows::Rows(PyObject* object, const char* of, py::ssize_t columns) : name(of) {
  if (object == nullptr) return;
  const Numbers<double> numbers = to_numbers<double>(object, name);
  const py::ssize_t dimensions = numbers.ndim();
  if (dimensions < 1 || dimensions > 2 || numbers.shape(dimensions - 1) != columns) {
    const std::string row = std::to_string(columns);
    throw py::value_error(std::string(name) + " has shape " + shape_text(numbers) + "; expected (" + row +
                          ",) for one pose or (K, " + row + ") for K poses");
  }
  has_poses = dimensions == 2;
  if (has_poses) poses = static_cast<std::size_t>(numbers.shape(0));
  values = values_of(numbers);
  weak_reference = py::weakref(py::handle(numbers));
  array = numbers;
}

void PoseInput::Rows::fit(std::size_t count) {
  if (values.empty() || has_poses || count == 1) return;
  repeated.reserve(count * values.size());
  for (std::size_t i = 0; i < count; ++i) repeated.insert(repeated.end(), values.begin(), values.end());
  values = repeated;
}

PoseInput::PoseInput(const PoseObjects& objects)
    : position_(objects.position, "position", 3),
      quaternion_(objects.quaternion, "quaternion", 4),
      linear_velocity_(is_given(objects.linear_velocity) ? objects.linear_velocity : nullptr,
                       "linear_velocity", 3),
      angular_velocity_(is_given(objects.angular_velocity) ? objects.angular_velocity : nullptr,
                        "angular_velocity", 3) {
  bool many_times = false;
  utimes_ = to_utimes(objects.time, many_times);
  // The argument that has determined the number of poses.
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
    if (rows->has_poses) count(rows->name, rows->poses);
  }
  if (many_times) count("time", utimes_.size());
  single_ = counted == nullptr;
  for (Rows* const rows : {&position_, &quaternion_, &linear_velocity_, &angular_velocity_}) rows->fit(size_);
}

PoseArrays PoseInput::arrays() const {
  return {position_.values, quaternion_.values, linear_velocity_.values, angular_velocity_.values, utimes_};
}

}  // namespace buoyancy::python

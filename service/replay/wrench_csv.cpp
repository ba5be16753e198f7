#include "service/replay/wrench_csv.h"

#include <array>
#include <charconv>

namespace buoyancy::service {
namespace {

constexpr int kSignificantDigits = 17;

void append(double value, std::string& row) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general,
                                 kSignificantDigits);
  row += ',';
  row.append(text.data(), end.ptr);
}

template <std::size_t kSize>
void append(const std::array<double, kSize>& values, std::string& row) {
  for (const double value : values) append(value, row);
}

}  // namespace

void format_wrench_row(std::int64_t utime, const BodyWrench& wrench, std::string& row) {
  row = std::to_string(utime);
  row += ',';
  row += std::to_string(wrench.body_id);
  row += ',';
  row += std::to_string(static_cast<std::int32_t>(wrench.status));
  append(wrench.force, row);
  append(wrench.torque, row);
  append(wrench.submerged_volume, row);
  append(wrench.center_of_buoyancy, row);
  append(wrench.force_error_bound, row);
  append(wrench.torque_error_bound, row);
  row += '\n';
}

}  // namespace buoyancy::service

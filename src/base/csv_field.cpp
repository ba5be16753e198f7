#include "base/csv_field.h"

#include <cstddef>

namespace buoyancy {

std::string_view trim(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r";
  const std::size_t first = text.find_first_not_of(kSpace);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

std::optional<std::string_view> CsvFields::next() {
  if (!rest_) return std::nullopt;
  const std::size_t end = separator_ == ' ' ? rest_->find_first_of(" \t") : rest_->find(separator_);
  const std::string_view field = trim(rest_->substr(0, end));
  if (end == std::string_view::npos) {
    rest_.reset();
  } else {
    rest_->remove_prefix(end + 1);
    if (separator_ == ' ') rest_ = trim(*rest_);
  }
  return field;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = text.find(separator);
    parts.push_back(trim(text.substr(0, end)));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::string quote(std::string_view text) {
  constexpr std::size_t kMaxShownLength = 60;
  std::string copy(text.substr(0, kMaxShownLength));
  for (char& c : copy) {
    if (static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) >= 0x7F) c = '?';
  }
  return "'" + copy + (text.size() > kMaxShownLength ? "...'" : "'");
}

}  // namespace buoyancy

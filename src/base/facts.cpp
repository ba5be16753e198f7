#include "base/facts.h"

namespace buoyancy {

Facts& Facts::line(std::string_view label) {
  constexpr std::size_t kLabelWidth = 14;
  begin("  ");
  text_ += label;
  text_.append(label.size() < kLabelWidth ? kLabelWidth - label.size() : 1, ' ');
  return *this;
}

Facts& Facts::begin(std::string_view lines) {
  if (has_lines_) text_ += '\n';
  text_ += lines;
  has_lines_ = true;
  has_words_ = false;
  return *this;
}

Facts& Facts::add_flag(std::string_view key, bool value, std::string_view words) {
  return add(key, value).say_if(value, words);
}

Facts& Facts::include(std::string_view key, Facts other) {
  if (!other.text_.empty()) begin(other.text_);
  return add(key, std::move(other.json_));
}

Facts& Facts::include_in(std::string_view list, Facts other) {
  if (!other.text_.empty()) begin(other.text_);
  json_[std::string(list)].push_back(std::move(other.json_));
  return *this;
}

Json& Facts::list(std::string_view key) {
  return json_[std::string(key)] = Json::array();
}

Facts& Facts::update(const Facts& other) {
  json_.update(other.json_);
  return *this;
}

std::string_view Facts::separator(std::string_view pattern) const {
  constexpr std::string_view kContinues = " ;:";
  const bool continues = !pattern.empty() && kContinues.find(pattern.front()) != std::string_view::npos;
  return !has_words_ || continues ? "" : ", ";
}

Facts& Facts::append(std::string_view separator, std::string_view words) {
  text_ += separator;
  text_ += words;
  has_words_ = true;
  return *this;
}

}  // namespace buoyancy

#include "service/replay/replay_part.h"

#include <algorithm>
#include <charconv>
#include <string>

#include "recording/log_item.h"

namespace buoyancy::service {
namespace {

constexpr std::int64_t kMinBlockSize = 262'144;  // [bytes]
constexpr std::int64_t kMaxBlocks = 1'024;

std::int64_t divide_rounding_up(std::int64_t dividend, std::int64_t divisor) {
  return (dividend + divisor - 1) / divisor;
}

std::optional<int> parse_number(std::string_view text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace

std::optional<Part> parse_part(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash == text.npos) return std::nullopt;
  const std::optional<int> number = parse_number(text.substr(0, slash));
  const std::optional<int> count = parse_number(text.substr(slash + 1));
  if (!number || !count || *number < 1 || *number > *count || *count > kMaxParts) return std::nullopt;
  return Part{*number, *count};
}

std::int64_t block_size(std::int64_t input_size) {
  std::int64_t size = kMinBlockSize;
  while (divide_rounding_up(input_size, size) > kMaxBlocks) size *= 2;
  return size;
}

PartLimits part_limits(const Part& part, std::int64_t input_size) {
  const std::int64_t size = block_size(input_size);
  const std::int64_t blocks = divide_rounding_up(input_size, size);
  const auto end_after = [&](int parts) {
    return std::min(size * divide_rounding_up(blocks * parts, part.count), input_size);
  };
  const bool last = part.number == part.count;
  return {end_after(part.number - 1), last ? kNoLimit : end_after(part.number)};
}

std::filesystem::path part_path(const std::filesystem::path& output, const Part& part) {
  std::filesystem::path path = output;
  path.replace_filename(output.stem().string() + ".part-" + std::to_string(part.number) + "-of-" +
                        std::to_string(part.count) + output.extension().string());
  return path;
}

}  // namespace buoyancy::service

#include "tests/fuzz/corpus.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <stdexcept>

namespace buoyancy {
namespace {

constexpr std::size_t kMaxInputSize = 8192;
constexpr std::size_t kMaxRepeat = 64;

std::optional<std::uint8_t> hexadecimal_digit(char c) {
  if (c >= '0' && c <= '9') return static_cast<std::uint8_t>(c - '0');
  if (c >= 'a' && c <= 'f') return static_cast<std::uint8_t>(c - 'a' + 10);
  return std::nullopt;
}

FuzzInput read_bytes(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

FuzzInput bytes_of_digits(const std::string& digits, const std::string& name) {
  FuzzInput bytes;
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    const std::optional<std::uint8_t> high = hexadecimal_digit(digits[i]);
    const std::optional<std::uint8_t> low =
        i + 1 < digits.size() ? hexadecimal_digit(digits[i + 1]) : std::nullopt;
    if (!high || !low) {
      throw std::runtime_error(name + ": '" + digits + "': expected pairs of hexadecimal digits, 0-9 or a-f");
    }
    bytes.push_back(static_cast<std::uint8_t>(16U * *high + *low));
  }
  return bytes;
}

FuzzInput read_hexadecimal(const std::filesystem::path& path) {
  const FuzzInput text = read_bytes(path);
  if (text.empty()) throw std::runtime_error(path.string() + ": is missing or empty");
  FuzzInput bytes;
  std::istringstream lines(std::string(text.begin(), text.end()));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    for (std::string word; words >> word;) {
      const std::size_t star = word.find('*');
      const FuzzInput part =
          word[0] == '@'
              ? read_hexadecimal(path.parent_path().parent_path() / "parts" / (word.substr(1) + ".hex"))
              : bytes_of_digits(word.substr(star == std::string::npos ? 0 : star + 1), path.string());
      for (std::size_t n = star == std::string::npos ? 1 : std::stoul(word); n > 0; --n) {
        bytes.insert(bytes.end(), part.begin(), part.end());
      }
    }
  }
  return bytes;
}

// SplitMix64: Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31U);
  }
  // Returns a number from 0 to count - 1, or 0 if count is 0.
  std::size_t below(std::size_t count) { return count == 0 ? 0 : next() % count; }

 private:
  std::uint64_t state_;
};

FuzzInput::difference_type offset(std::size_t place) {
  return static_cast<FuzzInput::difference_type>(place);
}

void mutate_once(FuzzInput& input, const FuzzInput& other, Random& random) {
  constexpr std::array<std::uint8_t, 8> kBoundaryBytes{0x00, 0x01, 0x7f, 0x80, 0xff, ' ', '0', '\n'};
  const std::size_t place = random.below(input.size());
  const std::size_t length = 1 + random.below(std::min(kMaxRepeat, input.size() - place));
  switch (random.below(7)) {
    case 0:
      if (!input.empty()) input[place] ^= static_cast<std::uint8_t>(1U << random.below(8));
      break;
    case 1:
      if (!input.empty()) input[place] = static_cast<std::uint8_t>(random.next());
      break;
    case 2:
      if (!input.empty()) input[place] = kBoundaryBytes[random.below(kBoundaryBytes.size())];
      break;
    case 3:
      input.insert(input.begin() + offset(place), kBoundaryBytes[random.below(kBoundaryBytes.size())]);
      break;
    case 4:
      if (!input.empty()) input.erase(input.begin() + offset(place), input.begin() + offset(place + length));
      break;
    case 5:
      if (!input.empty()) {
        const FuzzInput repeated(input.begin() + offset(place), input.begin() + offset(place + length));
        input.insert(input.begin() + offset(random.below(input.size())), repeated.begin(), repeated.end());
      }
      break;
    default:
      input.resize(place);
      input.insert(input.end(), other.begin() + offset(random.below(other.size())), other.end());
  }
}

}  // namespace

std::vector<CorpusFile> read_corpus(const std::filesystem::path& directory) {
  std::vector<CorpusFile> files;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    const bool is_text = entry.path().extension() == ".hex";
    files.push_back({entry.path().filename().string(),
                     is_text ? read_hexadecimal(entry.path()) : read_bytes(entry.path())});
  }
  if (files.empty()) throw std::runtime_error(directory.string() + ": contains no files; expected a corpus");
  std::sort(files.begin(), files.end(),
            [](const CorpusFile& a, const CorpusFile& b) { return a.name < b.name; });
  return files;
}

FuzzInput mutated(const FuzzInput& input, const FuzzInput& other, std::uint64_t seed) {
  Random random(seed);
  FuzzInput mutant = input;
  for (std::size_t times = 1 + random.below(8); times > 0; --times) mutate_once(mutant, other, random);
  if (mutant.size() > kMaxInputSize) mutant.resize(kMaxInputSize);
  return mutant;
}

}  // namespace buoyancy

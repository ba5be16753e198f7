#include "service/daemon/fault_injection.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>

#include "base/csv_field.h"
#include "base/format.h"
#include "base/number_range.h"
#include "base/spelling_suggestion.h"

namespace buoyancy::service {
namespace {

constexpr double kMaxTime = 3600.0;  // [s]
constexpr std::size_t kFingerprintSize = 8;

constexpr std::array<std::string_view, 8> kKeys{"drop",  "duplicate", "reorder", "corrupt",
                                                "delay", "jitter",    "stall",   "seed"};
constexpr const char* kExample = "drop=0.1,delay=5ms,stall=2s/60s,seed=7";

struct Unit {
  std::string_view name;
  double seconds;
};
constexpr std::array kUnits{Unit{"us", 1e-6}, Unit{"ms", 1e-3}, Unit{"s", 1.0}};

std::string list_keys() {
  std::string list;
  for (const std::string_view key : kKeys) {
    if (!list.empty()) list += ", ";
    list += key;
  }
  return list;
}

tl::unexpected<Error> fault_error(std::string_view item, std::string actual, std::string expected,
                                  std::string hint = {}) {
  return make_error({"--inject " + quote(item), std::move(actual), std::move(expected), "", std::move(hint)});
}

Expected<double> parse_probability(std::string_view item, std::string_view text) {
  double value = 0.0;
  if (parse_number(text, value) && value >= 0.0 && value <= 1.0) return value;
  return fault_error(item, quote(text), "a probability from 0 to 1");
}

Expected<double> parse_time(std::string_view item, std::string_view text) {
  const std::size_t end_of_number = text.find_last_of("0123456789.") + 1;  // 0: no number
  const std::string_view name = text.substr(end_of_number);
  const auto unit = std::ranges::find(kUnits, name, &Unit::name);
  double value = 0.0;
  if (unit == kUnits.end() || !parse_number(text.substr(0, end_of_number), value)) {
    return fault_error(item, quote(text), "a time with its unit, us, ms or s",
                       "Write for example 250us, 5ms or 2s");
  }
  const double seconds = value * unit->seconds;
  if (NumberRange::from_zero_to(kMaxTime).contains(seconds)) return seconds;
  return fault_error(item, quote(text), "a time from 0s to " + format_number(kMaxTime) + "s");
}

Expected<void> parse_stall(std::string_view item, std::string_view text, FaultOptions& options) {
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) {
    return fault_error(item, quote(text), "the length of a stall and its period",
                       "Write stall=2s/60s for 2 s in every 60 s");
  }
  const Expected<double> stall = parse_time(item, text.substr(0, slash));
  if (!stall) return make_error(stall.error());
  const Expected<double> period = parse_time(item, text.substr(slash + 1));
  if (!period) return make_error(period.error());
  if (*stall >= *period) {
    return fault_error(item, quote(text), "a stall that is shorter than its period",
                       "Write the length first: stall=2s/60s is 2 s in every 60 s");
  }
  options.stall = *stall;
  options.stall_period = *period;
  return {};
}

Expected<void> parse_seed(std::string_view item, std::string_view text, FaultOptions& options) {
  if (parse_number(text, options.seed)) return {};
  return fault_error(item, quote(text), "a whole number from 0 to 18446744073709551615");
}

Expected<void> parse_item(std::string_view item, FaultOptions& options,
                          std::vector<std::string_view>& given) {
  const std::size_t equals = item.find('=');
  const std::string_view key = item.substr(0, equals);
  if (std::ranges::find(kKeys, key) == kKeys.end()) {
    const std::string nearest(nearest_word(key, kKeys));
    return fault_error(item, "unknown fault " + quote(key), "one of " + list_keys(),
                       key.empty() ? std::string() : "The nearest is '" + nearest + "'");
  }
  if (equals == std::string_view::npos) {
    return fault_error(item, "no value", "a value after '='", "Write for example " + std::string(kExample));
  }
  if (std::ranges::find(given, key) != given.end()) {
    return fault_error(item, quote(key) + " for the second time", "each fault at most once",
                       "Remove one of the two");
  }
  given.push_back(key);

  const std::string_view text = item.substr(equals + 1);
  if (key == "stall") return parse_stall(item, text, options);
  if (key == "seed") return parse_seed(item, text, options);
  const bool is_time = key == "delay" || key == "jitter";
  const Expected<double> value = is_time ? parse_time(item, text) : parse_probability(item, text);
  if (!value) return make_error(value.error());
  double FaultOptions::*const member = key == "drop"        ? &FaultOptions::drop
                                       : key == "duplicate" ? &FaultOptions::duplicate
                                       : key == "reorder"   ? &FaultOptions::reorder
                                       : key == "corrupt"   ? &FaultOptions::corrupt
                                       : key == "delay"     ? &FaultOptions::delay
                                                            : &FaultOptions::jitter;
  options.*member = *value;
  return {};
}

// The random decisions about a reply, each of which has a random number of its own.
enum class Draw : std::uint64_t { kDrop, kDuplicate, kReorder, kCorrupt, kCorruption, kJitter, kCut, kCount };

// The finalizer of SplitMix64 (Steele, Lea and Flood 2014), a bijection that mixes all bits.
std::uint64_t mix(std::uint64_t x) {
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9U;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBU;
  return x ^ (x >> 31U);
}

// The seed is mixed first: otherwise the numbers of one seed would be those of another, shifted.
std::uint64_t random_bits(std::uint64_t seed, std::uint64_t ordinal, Draw draw) {
  constexpr std::uint64_t kGoldenRatio = 0x9E3779B97F4A7C15U;
  const std::uint64_t index =
      ordinal * static_cast<std::uint64_t>(Draw::kCount) + static_cast<std::uint64_t>(draw);
  return mix(mix(seed + kGoldenRatio) + kGoldenRatio * (index + 1));
}

// Uniformly distributed in [0, 1).
double uniform(std::uint64_t seed, std::uint64_t ordinal, Draw draw) {
  return static_cast<double>(random_bits(seed, ordinal, draw) >> 11U) * 0x1p-53;
}

double period_number(const FaultOptions& options, double elapsed) {
  return std::floor(elapsed / options.stall_period);
}

}  // namespace

Expected<FaultOptions> parse_faults(std::string_view text) {
  if (text.empty()) {
    return fault_error(text, "no fault", "faults such as " + std::string(kExample),
                       "Leave --inject out if the service is to behave");
  }
  FaultOptions options;
  std::vector<std::string_view> given;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find(',', start), text.size());
    if (Expected<void> parsed = parse_item(text.substr(start, end - start), options, given); !parsed) {
      return make_error(parsed.error());
    }
    start = end + 1;
  }
  return options;
}

std::string to_string(const FaultOptions& options) {
  std::string text;
  const auto add = [&text](std::string_view key, double value, double unit, std::string_view unit_name) {
    if (value == 0.0) return;
    text += format_text("{}={}{},", key, value / unit, unit_name);
  };
  add("drop", options.drop, 1.0, "");
  add("duplicate", options.duplicate, 1.0, "");
  add("reorder", options.reorder, 1.0, "");
  add("corrupt", options.corrupt, 1.0, "");
  add("delay", options.delay, 1e-3, "ms");
  add("jitter", options.jitter, 1e-3, "ms");
  if (options.stall > 0.0) {
    text += format_text("stall={}s/{}s,", options.stall, options.stall_period);
  }
  return text + format_text("seed={}", options.seed);
}

Fate draw_fate(const FaultOptions& options, std::uint64_t ordinal) {
  const auto happens = [&](Draw draw, double probability) {
    return uniform(options.seed, ordinal, draw) < probability;
  };
  Fate fate;
  fate.dropped = happens(Draw::kDrop, options.drop);
  if (fate.dropped) return fate;
  fate.duplicated = happens(Draw::kDuplicate, options.duplicate);
  fate.reordered = happens(Draw::kReorder, options.reorder);
  if (happens(Draw::kCorrupt, options.corrupt)) {
    fate.corruption = happens(Draw::kCorruption, 0.5) ? Corruption::kCutShort : Corruption::kOtherFingerprint;
  }
  fate.delay = options.delay + options.jitter * uniform(options.seed, ordinal, Draw::kJitter);
  fate.cut = random_bits(options.seed, ordinal, Draw::kCut);
  return fate;
}

void corrupt(const Fate& fate, std::vector<std::uint8_t>& message) {
  assert(message.size() >= kFingerprintSize);
  if (fate.corruption == Corruption::kCutShort) {
    message.resize(1 + fate.cut % (message.size() - 1));
  } else if (fate.corruption == Corruption::kOtherFingerprint) {
    for (std::size_t i = 0; i < kFingerprintSize; ++i) {
      message[i] = static_cast<std::uint8_t>(~message[i]);
    }
  }
}

bool is_stalled(const FaultOptions& options, double elapsed) {
  if (options.stall == 0.0) return false;
  return elapsed >= end_of_period(options, elapsed) - options.stall;
}

std::int64_t stalls_begun(const FaultOptions& options, double elapsed) {
  if (options.stall == 0.0) return 0;
  const double before = period_number(options, elapsed);
  return static_cast<std::int64_t>(before) + (is_stalled(options, elapsed) ? 1 : 0);
}

double end_of_period(const FaultOptions& options, double elapsed) {
  return (period_number(options, elapsed) + 1.0) * options.stall_period;
}

}  // namespace buoyancy::service

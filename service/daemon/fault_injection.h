// The faults that buoyancyd injects into its responses on purpose, so that people can test how their client
// copes with them: what the option --inject describes, and which faults a response meets.
//
// A response and its hydrostatics and loads, the reply to one request, meet the same faults. Their fate is a
// function of the seed and of the reply's ordinal number, and of nothing else: the same sequence of requests
// meets the same faults, however long anything takes, and a retry, whose reply has a number of its own, draws
// anew. Every kind of fault has draws of its own, so that adding one kind does not move the others.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace buoyancy::service {

struct FaultOptions {
  // Probabilities, each on its own. A reply that is dropped meets no other fault.
  double drop = 0.0;       // it is not sent
  double duplicate = 0.0;  // it is sent twice
  double reorder = 0.0;    // it is held back until after the next one
  double corrupt = 0.0;    // it is cut short or carries another fingerprint

  double delay = 0.0;         // [s], of every reply
  double jitter = 0.0;        // [s], uniformly distributed from 0 to this, in addition
  double stall = 0.0;         // [s], the last part of every period, in which nothing is answered
  double stall_period = 0.0;  // [s], > stall; 0: no stalls
  std::uint64_t seed = 1;     // of all random choices
};

// Parses "drop=0.1,delay=5ms,jitter=2ms,duplicate=0.05,reorder=0.05,corrupt=0.01,stall=2s/60s,seed=7": faults
// in any order, each at most once. Times have a unit: us, ms or s. Errors: no fault, an unknown or repeated
// one, a probability outside [0, 1], a time without a unit or above one hour, a stall that is not shorter
// than its period, a seed that is no whole number from 0 to 2^64 - 1.
Expected<FaultOptions> parse_faults(std::string_view text);

// Formats what parse_faults() parses; leaves out what does not happen, but not the seed.
std::string to_string(const FaultOptions& options);

enum class Corruption {
  kNone,
  kCutShort,          // from its end; at least one byte remains
  kOtherFingerprint,  // every bit of the fingerprint is inverted
};

// The faults that one reply meets. If it is dropped, nothing else happens to it.
struct Fate {
  bool dropped = false;
  bool duplicated = false;
  bool reordered = false;
  Corruption corruption = Corruption::kNone;
  double delay = 0.0;     // [s]
  std::uint64_t cut = 0;  // random: determines what remains of each message that is cut short
};

// The fate of the reply with this number, counted from 0. O(1).
Fate draw_fate(const FaultOptions& options, std::uint64_t ordinal);

// Corrupts a message such that no receiver can take it for a valid one of its type. Precondition: it has at
// least the 8 bytes of a fingerprint.
void corrupt(const Fate& fate, std::vector<std::uint8_t>& message);

// The stalls as functions of the time since the start [s], >= 0. The first period begins at the start.
bool is_stalled(const FaultOptions& options, double elapsed);
std::int64_t stalls_begun(const FaultOptions& options, double elapsed);
double end_of_period(const FaultOptions& options, double elapsed);  // [s]; precondition: there are stalls

}  // namespace buoyancy::service

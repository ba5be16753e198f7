// Divides a replay into parts that several machines compute, so that the joined parts are, byte for byte, the
// output of a replay of the whole.
//
// The input file is divided into blocks of equal size; a block begins at the cut for its offset (log_item.h).
// A batch never extends over two blocks, in a replay of the whole too, and a part consists of whole blocks. A
// part therefore evaluates the same batches as a replay of the whole does in these blocks. Since each batch
// starts from scratch (replay_batch.h), responses and counters are the same. Only the following depends on
// what came before a batch:
// - The header line of a CSV file. Only the first part writes it.
// - The numbers of a log's events. A part counts them from 0.
// - The seq of requests that the replay itself makes, from poses and from CSV rows, and of the messages that
//   reply to them. A part counts these from 0 too, per session. No recorded request may use such a session: a
//   part that finds one fails, so that the session tells which messages count.
// - Warnings about channels without events, and which input errors are shown. A part puts both into its
//   manifest instead.
// - The condition of compartments and tanks. A part of a log reads the messages before it
//   (earlier_conditions.h).
// The join adds what the parts before have counted (replay_join.h). Parts as CSV files, whose rows hold no
// such count, are pieces of the whole as they are. A part has one output: the CSV file of loads is for a
// replay of the whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

namespace buoyancy::service {

struct Part {
  int number = 1;  // 1 to count
  int count = 1;   // 1 to kMaxParts

  bool operator==(const Part&) const = default;
};

inline constexpr int kMaxParts = 10'000;

// Parses "3/7"; nullopt if it is no part.
std::optional<Part> parse_part(std::string_view text);

// Returns the size of the blocks of an input [bytes]: a power of two from 256 KiB on, so that there are at
// most 1,024 blocks. Smaller ones would cost time: each batch starts with empty caches.
std::int64_t block_size(std::int64_t input_size);

// Offsets of the first block of a part and of the first block after it [bytes]. Parts differ by at most one
// block; if there are more parts than blocks, some are empty. The end of the last part is kNoLimit.
struct PartLimits {
  std::int64_t begin = 0;
  std::int64_t end = 0;
};
PartLimits part_limits(const Part& part, std::int64_t input_size);

// The file of a part, beside the output of the join: "wrenches.part-3-of-7.lcmlog" of "wrenches.lcmlog".
std::filesystem::path part_path(const std::filesystem::path& output, const Part& part);

}  // namespace buoyancy::service

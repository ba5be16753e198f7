#include "service/replay/replay.h"

#include <array>
#include <chrono>
#include <variant>
#include <vector>

#include "engine/thread_pool.h"
#include "service/replay/replay_batch.h"

namespace buoyancy {
namespace {

// For each thread, where there are several: so that one that has a slow batch keeps no other waiting long.
constexpr std::size_t kBatchesPerThread = 4;

// What is read, then answered, then written at once. While one is answered, the next is read and the one
// before is written.
struct Round {
  std::vector<ReplayBatch> batches;
  std::size_t filled = 0;  // of them
};

void add_event(const ReplayTask& task, const RecordedEvent& event, ReplayBatch& batch) {
  // Of CSV, which has no channels, everything is a request.
  const ReplayChannels::Use use = event.channel.empty() ? ReplayChannels::Use{.request = true, .pose = {}}
                                                        : task.channels.use_of(event.channel);
  if (use.copied) batch.add_copy(event.timestamp, event.channel, event.bytes);
  if (use.request) batch.add_request(event.timestamp, event.bytes, {});
  if (!use.pose) return;
  if (const auto request = task.poses.make_request(*use.pose, event.bytes)) {
    batch.add_request(event.timestamp, *request, task.poses.channels()[*use.pose].force_torque_channel);
  } else {
    batch.add_rejected_pose(event.timestamp, request.error());
  }
}

// False: the input has ended.
bool fill(const ReplayTask& task, ReplayBatch& batch, std::int64_t& corrupt_sections) {
  batch.clear();
  while (!batch.full()) {
    LogItem item = task.input.next();
    if (std::holds_alternative<EndOfLog>(item)) return false;
    if (auto* damage = std::get_if<CorruptSection>(&item)) {
      ++corrupt_sections;
      batch.add_warning(std::move(damage->description));
    } else {
      add_event(task, std::get<RecordedEvent>(item), batch);
    }
  }
  return true;
}

enum class Reading { kOn, kAtEnd, kStopped };

// Reads as many batches as there are, until the input ends or a signal comes. The signal stays pending, for
// the thread that writes to see it too.
void read(const ReplayTask& task, const TerminationSignals& signals, Round& round, ReplaySummary& summary,
          Reading& reading) {
  round.filled = 0;
  while (reading == Reading::kOn && round.filled < round.batches.size()) {
    if (signals.pending()) {
      reading = Reading::kStopped;
    } else {
      const bool more = fill(task, round.batches[round.filled++], summary.corrupt_sections);
      if (!more) reading = Reading::kAtEnd;
    }
  }
}

Expected<void> write(const ReplayTask& task, Round& round) {
  for (std::size_t i = 0; i < round.filled; ++i) {
    ReplayBatch& batch = round.batches[i];
    if (Expected<void> written = task.output.write(batch.records()); !written) return written;
    if (task.comparison != nullptr) {
      batch.each_response([&task](Bytes response) { task.comparison->add(response); });
      batch.each_hydrostatics([&task](Bytes message) { task.comparison->take_hydrostatics(message); });
    }
  }
  return {};
}

void tell(const Round& round, const ReplayListener& listener) {
  for (std::size_t i = 0; i < round.filled; ++i) {
    for (const std::string& warning : round.batches[i].warnings()) listener.on_input_error(warning);
  }
}

}  // namespace

Expected<ReplaySummary> replay(const ReplayTask& task, TerminationSignals& signals,
                               const ReplayListener& listener) {
  const auto start = std::chrono::steady_clock::now();
  ReplaySummary summary;
  ThreadPool workers(task.jobs);
  const std::size_t count = workers.thread_count() == 1 ? 1 : kBatchesPerThread * workers.thread_count();
  std::array<Round, 3> rounds;
  for (Round& round : rounds) {
    round.batches.reserve(count);
    while (round.batches.size() < count) {
      round.batches.emplace_back(task.scene, task.layout, task.comparison != nullptr);
    }
  }
  const auto total = [&rounds] {
    ReplaySummary sum;
    for (const Round& round : rounds) {
      for (const ReplayBatch& batch : round.batches) {
        sum.counters += batch.counters();
        sum.copied += batch.copied();
      }
    }
    return sum;
  };

  task.output.give_up_after(signals.fileno());
  Reading reading = Reading::kOn;
  read(task, signals, rounds[0], summary, reading);
  Expected<void> written;
  std::size_t number = 0;
  for (; rounds[number % 3].filled > 0; ++number) {
    Round& before = rounds[(number + 2) % 3];
    Round& now = rounds[number % 3];
    Round& next = rounds[(number + 1) % 3];
    tell(before, listener);
    workers.run(now.filled + 2, 1, [&](std::size_t i) {
      if (i == 0) {
        read(task, signals, next, summary, reading);
      } else if (i == 1) {
        written = write(task, before);
      } else {
        now.batches[i - 2].response();
      }
    });
    if (!written) return tl::unexpected(written.error());
    listener.on_progress(task.input.offset(), task.input.size(), total().counters.requests);
  }
  Round& last = rounds[(number + 2) % 3];
  tell(last, listener);
  if (written = write(task, last); !written) return tl::unexpected(written.error());
  if (Expected<void> flushed = task.output.flush(); !flushed) return tl::unexpected(flushed.error());
  if (reading == Reading::kStopped) summary.stopped_by = signals.consume();
  if (task.comparison != nullptr) task.comparison->finish();
  const ReplaySummary sum = total();
  summary.counters = sum.counters;
  summary.copied = sum.copied;
  summary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return summary;
}

}  // namespace buoyancy

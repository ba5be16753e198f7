#include "service/replay/replay.h"

#include <array>
#include <chrono>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "engine/motion_check.h"
#include "engine/thread_pool.h"
#include "service/replay/replay_batch.h"

namespace buoyancy::service {
namespace {

// With several threads, each gets several batches, so that a slow batch does not keep the others idle.
constexpr std::size_t kBatchesPerThread = 4;

// The batches of one pipeline step. While one round is evaluated, the next is read and the previous one is
// written.
struct Round {
  std::vector<ReplayBatch> batches;
  std::size_t filled = 0;  // the first `filled` batches are in use
};

// The seas and conditions of the messages that were read so far.
struct Received {
  SeaTimeline seas;
  ConditionTimeline conditions;
  MotionMonitor motion{};
  bool has_begun = false;
};

// Returns whether a request may tell something about the velocities that the input states: after the first
// one, not if it has none and the scene uses none.
bool tells_motion(const ReplayTask& task, Received& received) {
  return !std::exchange(received.has_begun, true) || task.input.states_velocities() ||
         task.scene.bodies_with_hydrodynamics() > 0;
}

bool is_in_pose_session(const PoseRequestAdapter& poses, Bytes request) {
  if (poses.channels().empty()) return false;
  const auto id = peek_request_id(request);
  return id && poses.channel_of_session(id->session_id) != nullptr;
}

void add_event(const ReplayTask& task, const RecordedEvent& event, Received& received, ReplayBatch& batch,
               ReplaySummary& summary) {
  // CSV has no channels: every event is a request.
  const ReplayChannels::Role role = event.channel.empty()
                                        ? ReplayChannels::Role{.request = RequestKind::kBodies, .pose = {}}
                                        : task.channels.role_of(event.channel);
  if (role.copied) batch.add_copy(event.timestamp, event.channel, event.bytes);
  if (role.sea) {
    if (const Expected<void> used = received.seas.receive(event.bytes, task.scene)) {
      batch.add_seas(event.timestamp, received.seas, task.scene.receives_grids() ? event.bytes.size() : 0);
    } else {
      batch.add_rejected_sea(event.timestamp, used.error());
    }
  }
  if (role.condition) {
    batch.add_condition(event.timestamp, event.bytes);
    received.conditions.receive(event.bytes, task.scene);  // for later batches; this one reports errors
  }
  if (const auto header = peek_request(event.bytes);
      role.request && header && header->kind != *role.request) {
    batch.add_rejected(event.timestamp, "request", DecodeError::kFingerprint);
  } else if (role.request) {
    batch.add_request(event.timestamp, event.bytes, {});
    if (tells_motion(task, received)) received.motion.add(event.bytes, task.scene);
    if (!event.channel.empty()) {
      if (const auto id = peek_request_id(event.bytes)) summary.requests->add(id->session_id, id->seq);
    }
    if (is_in_pose_session(task.poses, event.bytes)) ++summary.requests_in_pose_sessions;
  }
  if (!role.pose) return;
  if (const auto request = task.poses.make_request(*role.pose, event.bytes)) {
    received.motion.add(*request, task.scene);
    batch.add_request(event.timestamp, *request, task.poses.channels()[*role.pose].force_torque_channel);
  } else {
    batch.add_rejected(event.timestamp, "pose", request.error());
  }
}

// Fills the batch with items of one block. False: the input has ended.
bool fill(const ReplayTask& task, Received& received, ReplayBatch& batch, ReplaySummary& summary) {
  batch.start(received.seas, received.conditions);
  while (!batch.full()) {
    LogItem item = task.input.next();
    if (std::holds_alternative<EndOfLog>(item)) return false;
    if (std::holds_alternative<LimitReached>(item)) {
      if (!batch.empty()) return true;
    } else if (auto* corrupt = std::get_if<CorruptSection>(&item)) {
      ++summary.corrupt_sections;
      batch.add_input_error(std::move(corrupt->description));
    } else {
      add_event(task, std::get<RecordedEvent>(item), received, batch, summary);
    }
  }
  return true;
}

enum class ReadState { kReading, kAtEnd, kStopped };

// Fills the round's batches until the input ends or a signal arrives. The signal stays pending, so that the
// writing thread sees it too.
void read(const ReplayTask& task, const TerminationSignals& signals, Received& received, Round& round,
          ReplaySummary& summary, ReadState& state) {
  round.filled = 0;
  while (state == ReadState::kReading && round.filled < round.batches.size()) {
    if (signals.pending()) {
      state = ReadState::kStopped;
    } else {
      const bool more = fill(task, received, round.batches[round.filled++], summary);
      if (!more) state = task.input.stopped() ? ReadState::kStopped : ReadState::kAtEnd;
    }
  }
}

Expected<void> write(const ReplayTask& task, Round& round) {
  for (std::size_t i = 0; i < round.filled; ++i) {
    ReplayBatch& batch = round.batches[i];
    if (Expected<void> written = task.output.write(batch.records()); !written) return written;
    if (task.loads != nullptr) {
      if (Expected<void> written = task.loads->write(batch.loads_records()); !written) return written;
    }
    if (task.comparison != nullptr) {
      batch.each_response([&task](Bytes response) { task.comparison->add(response); });
      batch.each_hydrostatics([&task](Bytes message) { task.comparison->add_hydrostatics(message); });
      batch.each_loads([&task](Bytes message) { task.comparison->add_loads(message); });
    }
  }
  return {};
}

void report_input_errors(const Round& round, const ReplayCallbacks& callbacks) {
  for (std::size_t i = 0; i < round.filled; ++i) {
    for (const std::string& error : round.batches[i].input_errors()) callbacks.on_input_error(error);
  }
}

}  // namespace

Expected<ReplaySummary> replay(const ReplayTask& task, TerminationSignals& signals,
                               const ReplayCallbacks& callbacks) {
  const auto start = std::chrono::steady_clock::now();
  ReplaySummary summary;
  summary.requests.emplace();
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

  const auto stop = [&signals] { return signals.pending(); };
  task.input.stop_when(stop);
  if (task.comparison != nullptr) task.comparison->stop_when(stop);
  task.output.give_up_after(signals.fileno());
  if (task.loads != nullptr) task.loads->give_up_after(signals.fileno());
  ReadState state = ReadState::kReading;
  Received received{SeaTimeline(task.scene),
                    task.conditions != nullptr ? *task.conditions : ConditionTimeline(task.scene)};
  read(task, signals, received, rounds[0], summary, state);
  Expected<void> written;
  std::size_t number = 0;
  for (; rounds[number % 3].filled > 0; ++number) {
    Round& previous = rounds[(number + 2) % 3];
    Round& current = rounds[number % 3];
    Round& next = rounds[(number + 1) % 3];
    report_input_errors(previous, callbacks);
    workers.run(current.filled + 2, 1, [&](std::size_t i) {
      if (i == 0) {
        read(task, signals, received, next, summary, state);
      } else if (i == 1) {
        written = write(task, previous);
      } else {
        current.batches[i - 2].evaluate();
      }
    });
    if (!written) return tl::unexpected(written.error());
    callbacks.on_progress(task.input.bytes_read(), task.input.bytes_expected(), total().counters.requests);
  }
  Round& last = rounds[(number + 2) % 3];
  report_input_errors(last, callbacks);
  if (written = write(task, last); !written) return tl::unexpected(written.error());
  if (Expected<void> flushed = task.output.flush(); !flushed) return tl::unexpected(flushed.error());
  if (task.loads != nullptr) {
    if (Expected<void> flushed = task.loads->flush(); !flushed) return tl::unexpected(flushed.error());
  }
  if (task.input.read_error()) return make_error(*task.input.read_error());
  if (task.comparison != nullptr) {
    task.comparison->finish();
    if (const std::optional<Error> error = task.comparison->read_error()) return make_error(*error);
    if (task.comparison->stopped()) state = ReadState::kStopped;
  }
  if (state == ReadState::kStopped) summary.stopped_by = signals.consume();
  const ReplaySummary sum = total();
  summary.counters = sum.counters;
  summary.copied = sum.copied;
  for (const MotionFinding& finding : received.motion.findings()) {
    summary.doubts.push_back(finding.warning().message());
  }
  summary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return summary;
}

}  // namespace buoyancy::service

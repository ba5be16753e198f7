#include "service/replay.h"

#include <chrono>
#include <optional>
#include <variant>
#include <vector>

#include "exchange/workers.h"
#include "service/replay_batch.h"

namespace buoyancy {
namespace {

// For each thread, where there are several: so that one that has a slow batch keeps no other waiting long.
constexpr std::size_t kBatchesPerThread = 4;

void add_event(const ReplayTask& task, const RecordedEvent& event, ReplayBatch& batch) {
  // Of CSV, which has no channels, everything is a question.
  const ReplayChannels::Use use = event.channel.empty() ? ReplayChannels::Use{.question = true, .pose = {}}
                                                        : task.channels.use_of(event.channel);
  if (use.copied) batch.add_copy(event.timestamp, event.channel, event.bytes);
  if (use.question) batch.add_question(event.timestamp, event.bytes, {});
  if (!use.pose) return;
  if (const auto question = task.poses.question(*use.pose, event.bytes)) {
    batch.add_question(event.timestamp, *question, task.poses.channels()[*use.pose].force_torque_channel);
  } else {
    batch.add_rejected_pose(event.timestamp, question.error());
  }
}

// False: the input has ended.
bool fill(const ReplayTask& task, ReplayBatch& batch, std::int64_t& damages) {
  batch.clear();
  while (!batch.full()) {
    InputItem item = task.input.next();
    if (std::holds_alternative<EndOfInput>(item)) return false;
    if (auto* damage = std::get_if<Damage>(&item)) {
      ++damages;
      batch.add_trouble(std::move(damage->description));
    } else {
      add_event(task, std::get<RecordedEvent>(item), batch);
    }
  }
  return true;
}

}  // namespace

Expected<ReplaySummary> replay(const ReplayTask& task, TerminationSignals& signals,
                               const ReplayListener& listener) {
  const auto start = std::chrono::steady_clock::now();
  ReplaySummary summary;
  Workers workers(task.jobs);
  std::vector<ReplayBatch> batches;
  const std::size_t count = workers.threads() == 1 ? 1 : kBatchesPerThread * workers.threads();
  batches.reserve(count);
  while (batches.size() < count) {
    batches.emplace_back(task.scene, task.layout, task.comparison != nullptr);
  }
  for (bool more = true; more;) {
    std::size_t filled = 0;
    while (more && filled < batches.size()) {
      if (signals.pending()) {
        summary.ended_by = signals.take();
        more = false;
      } else {
        more = fill(task, batches[filled++], summary.damages);
      }
    }
    workers.run(filled, 1, [&batches](std::size_t i) { batches[i].answer(); });
    for (std::size_t i = 0; i < filled; ++i) {
      for (const std::string& trouble : batches[i].troubles()) listener.on_trouble(trouble);
      if (Expected<void> written = task.output.write(batches[i].records()); !written) {
        return tl::unexpected(written.error());
      }
      if (task.comparison != nullptr) {
        batches[i].each_answer([&task](Bytes answer) { task.comparison->take(answer); });
      }
    }
    std::int64_t questions = 0;
    for (const ReplayBatch& batch : batches) questions += batch.counters().questions;
    listener.on_progress(task.input.offset(), task.input.size(), questions);
  }
  if (Expected<void> flushed = task.output.flush(); !flushed) return tl::unexpected(flushed.error());
  if (task.comparison != nullptr) task.comparison->finish();
  for (const ReplayBatch& batch : batches) {
    summary.counters += batch.counters();
    summary.copied += batch.copied();
  }
  summary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return summary;
}

}  // namespace buoyancy

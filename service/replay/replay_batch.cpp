#include "service/replay/replay_batch.h"

#include <utility>

namespace buoyancy {

ReplayBatch::ReplayBatch(const Scene& scene, const OutputLayout& layout, bool keep_answers)
    : exchange_(scene, {.threads = 1}), keep_answers_(keep_answers), records_(layout) {}

void ReplayBatch::clear() {
  items_.clear();
  bytes_.clear();
  records_.clear();
  troubles_.clear();
  answers_.clear();
  hydrostatics_.clear();
}

ReplayBatch::Item& ReplayBatch::add(Kind kind, std::int64_t timestamp, Bytes message) {
  Item& item = items_.emplace_back();
  item.kind = kind;
  item.timestamp = timestamp;
  item.start = bytes_.size();
  item.size = message.size();
  bytes_.insert(bytes_.end(), message.begin(), message.end());
  return item;
}

void ReplayBatch::add_question(std::int64_t timestamp, Bytes question,
                               std::string_view force_torque_channel) {
  add(Kind::kQuestion, timestamp, question).channel = force_torque_channel;
}

void ReplayBatch::add_rejected_pose(std::int64_t timestamp, Rejection cause) {
  add(Kind::kRejectedPose, timestamp, {}).cause = cause;
}

void ReplayBatch::add_copy(std::int64_t timestamp, std::string_view channel, Bytes bytes) {
  add(Kind::kCopy, timestamp, bytes).text = channel;
}

void ReplayBatch::add_trouble(std::string trouble) {
  add(Kind::kTrouble, 0, {}).text = std::move(trouble);
}

void ReplayBatch::answer() {
  exchange_.begin_anew();
  for (Item& item : items_) {
    switch (item.kind) {
      case Kind::kQuestion:
        answer_question(item);
        break;
      case Kind::kRejectedPose:
        exchange_.count_rejected(item.cause);
        reject(item, "pose", item.cause);
        break;
      case Kind::kCopy:
        records_.add_event(item.timestamp, item.text, message_of(item));
        ++copied_;
        break;
      case Kind::kTrouble:
        troubles_.push_back(std::move(item.text));
        break;
    }
  }
}

void ReplayBatch::answer_question(const Item& item) {
  const Bytes question = message_of(item);
  const Bytes answer = exchange_.answer(question);
  if (answer.empty()) {
    reject(item, "question", peek_key(question).error());
    return;
  }
  records_.add_answer(item.timestamp, answer, exchange_.hydrostatics(), item.channel);
  if (keep_answers_) {
    answers_.add(answer);
    if (const Bytes hydrostatics = exchange_.hydrostatics(); !hydrostatics.empty()) {
      hydrostatics_.add(hydrostatics);
    }
  }
}

void ReplayBatch::reject(const Item& item, const char* what, Rejection cause) {
  troubles_.push_back("event at " + std::to_string(item.timestamp) + " us is no " + what + ": " +
                      describe(cause));
}

}  // namespace buoyancy

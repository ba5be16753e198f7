#include "client/lcm_request_channel.h"

#include <algorithm>
#include <utility>

#include <poll.h>

namespace buoyancy {
namespace {

// A stop raised just before poll() goes to sleep is seen after this long.
constexpr std::chrono::milliseconds kLongestSleep{100};
// Messages taken in after the deadline: others may fill the channel faster than it can be read.
constexpr int kMostAfterDeadline = 1000;

timespec to_timespec(Clock::duration duration) {
  const auto nanoseconds = std::chrono::duration_cast<std::chrono::nanoseconds>(duration).count();
  return {static_cast<time_t>(nanoseconds / 1'000'000'000), static_cast<long>(nanoseconds % 1'000'000'000)};
}

}  // namespace

void AnswerLink::Inbox::receive(Bytes bytes) {
  if (decode(bytes, incoming)) return;
  if (incoming.key.session_id != session_id || incoming.key.seq > last_sent) return;
  arrivals.push_back({incoming.key.seq, Clock::now()});
  if (has_answer && incoming.key.seq <= newest.key.seq) return;
  std::swap(newest, incoming);
  has_answer = true;
}

AnswerLink::AnswerLink(LinkOptions options, LcmConnection connection)
    : options_(std::move(options)),
      stop_(options_.stop),
      inbox_(std::make_unique<Inbox>()),
      connection_(std::move(connection)) {}

Expected<AnswerLink> AnswerLink::open(const LinkOptions& options) {
  Expected<LcmConnection> connection =
      LcmConnection::open(options.lcm_url, {.receive_own = false, .spin = options.spin});
  if (!connection) return failure(connection.error());
  AnswerLink link(options, std::move(*connection));
  const Expected<void> subscribed = link.connection_.subscribe(
      options.wrenches_channel,
      [inbox = link.inbox_.get()](Bytes bytes, std::string_view /*channel*/) { inbox->receive(bytes); });
  if (!subscribed) return failure(subscribed.error());
  return link;
}

Expected<void> AnswerLink::send(const Question& question) {
  inbox_->session_id = question.key.session_id;
  inbox_->last_sent = question.key.seq;
  encode(question, question_bytes_);
  return send_again();
}

Expected<void> AnswerLink::send_again() {
  return connection_.publish(options_.states_channel, question_bytes_);
}

bool AnswerLink::wait_for(std::int64_t seq, Clock::time_point deadline) {
  const auto there = [&] { return inbox_->has_answer && inbox_->newest.key.seq >= seq; };
  inbox_->arrivals.clear();
  int after_deadline = 0;
  while (!there()) {
    const Clock::duration left = std::max(deadline - Clock::now(), Clock::duration::zero());
    const bool over = left == Clock::duration::zero();
    if (over && ++after_deadline > kMostAfterDeadline) return false;
    if (connection_.handle_one_soon(left)) continue;
    if (over || stopped()) return false;
    const timespec sleep = to_timespec(std::min<Clock::duration>(left, kLongestSleep));
    pollfd readable{connection_.fileno(), POLLIN, 0};
    ppoll(&readable, 1, &sleep, nullptr);
  }
  return true;
}

std::string AnswerLink::where() const {
  return connection_.url() + ", channels " + options_.states_channel + " and " + options_.wrenches_channel;
}

}  // namespace buoyancy

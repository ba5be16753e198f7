#include "client/lockstep_client.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <utility>

namespace buoyancy {
namespace {

double seconds(Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

Clock::duration to_duration(double time) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time));
}

std::string subject(const AnswerLink& link, std::int64_t seq) {
  return "question " + std::to_string(seq) + " on " + link.where();
}

tl::unexpected<Error> no_answer(const AnswerLink& link, std::int64_t seq, double waited) {
  std::array<char, 64> found{};
  std::snprintf(found.data(), found.size(), "no answer for %.3g s", waited);
  return failure({subject(link, seq), found.data(), "an answer of buoyancyd",
                  "no buoyancyd is running on this LCM URL and these channels, or it rejects the questions",
                  "Start buoyancyd with the same scene, URL and channels, or use --embedded"});
}

tl::unexpected<Error> stopped_error(const AnswerLink& link, std::int64_t seq) {
  return failure({subject(link, seq), "stopped while waiting", "an answer of buoyancyd", "", ""});
}

Expected<const Answer*> checked(const AnswerLink& link, const Question& question, const Answer& answer) {
  const bool same_bodies =
      std::equal(question.bodies.begin(), question.bodies.end(), answer.bodies.begin(), answer.bodies.end(),
                 [](const BodyState& asked, const BodyWrench& got) { return asked.body_id == got.body_id; });
  if (!same_bodies) {
    return failure({subject(link, question.key.seq), "an answer about other bodies than asked",
                    "one wrench per body, in the asked order",
                    "a program that is no buoyancyd publishes on the wrenches channel", ""});
  }
  return &answer;
}

// Sends until answered or out of patience. A sending that the network refuses is a lost question as well:
// interfaces go and come back.
Expected<const Answer*> ask_in_lockstep(AnswerLink& link, const Question& question, const Patience& patience,
                                        AskerStatistics& statistics) {
  const Clock::time_point sent_at = Clock::now();
  ++statistics.questions;
  Expected<void> sent = link.send(question);
  for (std::int64_t repeats = 0;; ++repeats) {
    if (link.wait_for(question.key.seq, Clock::now() + to_duration(patience.timeout))) {
      statistics.round_trip.add(seconds(link.arrivals().back().at - sent_at));
      return checked(link, question, link.newest());
    }
    if (link.stopped()) return stopped_error(link, question.key.seq);
    if (repeats == patience.retries) {
      ++statistics.lost;
      if (!sent) return failure(sent.error());
      return no_answer(link, question.key.seq, seconds(Clock::now() - sent_at));
    }
    ++statistics.retries;
    sent = link.send_again();
  }
}

}  // namespace

LockstepAsker::LockstepAsker(AnswerLink link, Patience patience)
    : link_(std::move(link)), patience_(patience) {}

Expected<const Answer*> LockstepAsker::ask(const Question& question) {
  return ask_in_lockstep(link_, question, patience_, statistics_);
}

FreeRunningAsker::FreeRunningAsker(AnswerLink link, Patience patience, double interval)
    : link_(std::move(link)), patience_(patience), interval_(to_duration(interval)) {}

Expected<const Answer*> FreeRunningAsker::ask(const Question& question) {
  if (!link_.has_answer()) {
    Expected<const Answer*> first = ask_in_lockstep(link_, question, patience_, statistics_);
    next_turn_ = Clock::now() + interval_;
    return first;
  }

  const std::int64_t seq = question.key.seq;
  wait_for(std::numeric_limits<std::int64_t>::max(), next_turn_);
  if (link_.stopped()) return stopped_error(link_, seq);
  const Clock::time_point now = Clock::now();
  ++statistics_.questions;
  unanswered_.push_back({seq, now});
  if (!std::exchange(quiet_, true)) quiet_since_ = now;
  if (const Expected<void> sent = link_.send(question); !sent) return failure(sent.error());

  next_turn_ += interval_;
  if (!wait_for(seq, next_turn_)) {
    const double waited = seconds(Clock::now() - quiet_since_);
    if (quiet_ && waited > patience_.total()) return no_answer(link_, seq, waited);
    ++statistics_.late;
    statistics_.latest = std::max(statistics_.latest, seq - link_.newest().key.seq);
  }
  return checked(link_, question, link_.newest());
}

bool FreeRunningAsker::wait_for(std::int64_t seq, Clock::time_point deadline) {
  const bool answered = link_.wait_for(seq, deadline);
  for (const Arrival& arrival : link_.arrivals()) {
    quiet_ = false;
    const auto sent = std::lower_bound(unanswered_.begin(), unanswered_.end(), arrival.seq,
                                       [](const Sent& s, std::int64_t value) { return s.seq < value; });
    if (sent == unanswered_.end() || sent->seq != arrival.seq) continue;  // a duplicate
    statistics_.round_trip.add(seconds(arrival.at - sent->at));
    unanswered_.erase(sent);
  }
  const Clock::time_point forgotten = Clock::now() - to_duration(patience_.total());
  while (!unanswered_.empty() && unanswered_.front().at < forgotten) {
    ++statistics_.lost;
    unanswered_.pop_front();
  }
  return answered;
}

AskerStatistics FreeRunningAsker::statistics() const {
  AskerStatistics statistics = statistics_;
  statistics.lost += static_cast<std::int64_t>(unanswered_.size());
  return statistics;
}

}  // namespace buoyancy

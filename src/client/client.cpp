#include "client/client.h"

#include <algorithm>
#include <random>
#include <utility>

namespace buoyancy {

Expected<Client> Client::open(const ClientOptions& options) {
  Expected<AnswerLink> link = AnswerLink::open(options.link);
  if (!link) return failure(link.error());
  const std::int64_t session_id = options.session_id ? *options.session_id : draw_session_id();
  if (options.interval) {
    return Client(FreeRunningAsker(std::move(*link), options.patience, *options.interval), session_id);
  }
  return Client(LockstepAsker(std::move(*link), options.patience), session_id);
}

Client::Client(Asker asker, std::int64_t session_id) : asker_(std::move(asker)) {
  question_.key.session_id = session_id;
}

Expected<const Answer*> Client::ask(std::int64_t utime, std::span<const BodyState> states, double lead_time) {
  question_.key.utime = utime;
  question_.lead_time = lead_time;
  question_.bodies.assign(states.begin(), states.end());
  Expected<const Answer*> answer = std::visit([this](auto& asker) { return asker.ask(question_); }, asker_);
  ++question_.key.seq;
  return answer;
}

AskerStatistics Client::statistics() const {
  return std::visit([](const auto& asker) -> AskerStatistics { return asker.statistics(); }, asker_);
}

std::int64_t draw_session_id() {
  std::random_device device;
  const std::uint64_t bits = (std::uint64_t{device()} << 32U) | device();
  return static_cast<std::int64_t>(bits >> 1U);
}

const BodyWrench* first_not_ok(const Answer& answer) {
  const auto found = std::ranges::find_if(
      answer.bodies, [](const BodyWrench& wrench) { return wrench.status != BodyStatus::kOk; });
  return found == answer.bodies.end() ? nullptr : &*found;
}

}  // namespace buoyancy

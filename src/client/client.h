// A simulator's end of the service, for simulators that are not ours: states in, wrenches out.
//
//   buoyancy::Expected<buoyancy::Client> client = buoyancy::Client::open();
//   ...
//   const auto answer = client->ask(utime, states);  // in every step: all bodies in one question
//   if (!answer) return fail(answer.error().message());
//   for (const buoyancy::BodyWrench& wrench : (*answer)->bodies) ...
//
// A client is a session of its own: it draws its number and counts its questions, so several clients share a
// service, and one that is started again is answered at once. docs/sidecar.md goes through it line by line.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <variant>

#include "client/lockstep_client.h"

namespace buoyancy {

struct ClientOptions {
  LinkOptions link;
  Patience patience;
  // s, > 0, of wall-clock time: questions are this far apart, each answered with the newest answer there is
  // (FreeRunningAsker). nullopt: lock-step, every question with its own answer.
  std::optional<double> interval;
  std::optional<std::int64_t> session_id;  // nullopt: drawn by draw_session_id()
};

class Client {
 public:
  // Errors: those of LcmConnection::open.
  static Expected<Client> open(const ClientOptions& options = {});

  // The wrenches on bodies in these states: one per state, in the same order, valid until the next call.
  // utime: us, of the simulation; it comes back in the answer's key. lead_time: s, the wrenches are those at
  // the poses extrapolated by this much; 0 as they are. A body that cannot be answered has a status other
  // than kOk and zeros; first_not_ok() finds it. Errors: the asker's.
  Expected<const Answer*> ask(std::int64_t utime, std::span<const BodyState> states, double lead_time = 0.0);

  AskerStatistics statistics() const;

 private:
  using Asker = std::variant<LockstepAsker, FreeRunningAsker>;
  Client(Asker asker, std::int64_t session_id);

  Asker asker_;
  Question question_;  // reused; its key is that of the next question
};

// A number that no other session has, but for a chance of 1 to 2^63; not negative.
std::int64_t draw_session_id();

// The first wrench that is not one; nullptr: all are OK. A simulator must not go on without a body's force.
const BodyWrench* first_not_ok(const Answer& answer);

}  // namespace buoyancy

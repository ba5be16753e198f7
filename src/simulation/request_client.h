// How the simulator gets an answer to its question: over LCM (client/lockstep_client.h), or from the exchange
// itself in this process, for machines without a network.
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "client/lockstep_client.h"
#include "engine/request_handler.h"

namespace buoyancy {

class EmbeddedAsker {
 public:
  explicit EmbeddedAsker(const Scene& scene) : exchange_(scene) {}  // scene must outlive the asker

  Expected<const Answer*> ask(const Question& question);
  const AskerStatistics& statistics() const { return statistics_; }

 private:
  Exchange exchange_;
  std::vector<std::uint8_t> bytes_;
  Answer answer_;
  AskerStatistics statistics_;
};

using Asker = std::variant<EmbeddedAsker, LockstepAsker, FreeRunningAsker>;

// The answer holds as many bodies as the question, in the same order, and is valid until the next call.
// Errors: the asker's.
Expected<const Answer*> ask(Asker& asker, const Question& question);
AskerStatistics statistics(const Asker& asker);

}  // namespace buoyancy

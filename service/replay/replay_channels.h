// Which of a log's events a replay looks at, and as what.
#pragma once

#include <functional>
#include <optional>
#include <regex>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/error.h"
#include "engine/pose_request_adapter.h"

namespace buoyancy {

class ReplayChannels {
 public:
  struct Use {
    bool request = false;             // a body_states_t
    std::optional<std::size_t> pose;  // of this channel of the PoseRequestAdapter
    bool copied = false;

    bool any() const { return request || pose || copied; }
  };

  // copied: regular expressions, of which one has to match a whole name, as LCM's tools have it. answers: the
  // channels that the replay itself writes, which are never copied: old and new responses could not be told
  // apart. Errors: not a regular expression.
  static Expected<ReplayChannels> make(std::string states_channel, const std::vector<PoseChannel>& poses,
                                       const std::vector<std::string>& copied,
                                       std::vector<std::string> responses);

  // O(1) for a name seen before.
  Use use_of(std::string_view channel);

  // The channels that were named for requests and poses, and that use_of() was never asked about: misspelt,
  // perhaps. That of the requests only where there are no poses.
  std::vector<std::string> unseen_channels() const;

 private:
  struct Hash : std::hash<std::string_view> {
    using is_transparent = void;
  };

  ReplayChannels(std::string states_channel, const std::vector<PoseChannel>& poses,
                 std::vector<std::regex> copied, std::vector<std::string> responses);
  Use look_up(std::string_view channel) const;

  bool saw_states_ = false;
  std::vector<bool> saw_poses_;  // as poses_
  std::string states_channel_;
  std::vector<std::string> poses_;
  std::vector<std::regex> copied_;
  std::vector<std::string> responses_;
  std::unordered_map<std::string, Use, Hash, std::equal_to<>> known_;  // a bounded number
};

}  // namespace buoyancy

// Maps the channels of a log to their roles in a replay: request, pose or copied event.
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

namespace buoyancy::service {

class ReplayChannels {
 public:
  struct Role {
    bool request = false;             // body_states_t
    std::optional<std::size_t> pose;  // index of the channel in the PoseRequestAdapter
    bool sea = false;                 // sea_state_t, of a scene that receives its sea
    bool copied = false;

    bool any() const { return request || pose || sea || copied; }
  };

  // sea_channel: empty unless the scene receives its sea. copied: regular expressions; an event is copied if
  // one of them matches the full channel name, as in LCM's tools. responses: the channels that the replay
  // writes; they are never copied, since recorded and new responses could not be distinguished. Errors: an
  // invalid regular expression.
  static Expected<ReplayChannels> make(std::string states_channel, std::string sea_channel,
                                       const std::vector<PoseChannel>& poses,
                                       const std::vector<std::string>& copied,
                                       std::vector<std::string> responses);

  // O(1) for a channel that was looked up before.
  Role role_of(std::string_view channel);

  // The configured channels of requests, poses and the sea that role_of() was never called with, perhaps
  // because they are misspelt. The request channel is included only if there are no pose channels.
  std::vector<std::string> unseen_channels() const;

 private:
  struct Hash : std::hash<std::string_view> {
    using is_transparent = void;
  };

  ReplayChannels(std::string states_channel, std::string sea_channel, const std::vector<PoseChannel>& poses,
                 std::vector<std::regex> copied, std::vector<std::string> responses);
  Role compute_role(std::string_view channel) const;

  bool saw_states_ = false;
  std::vector<bool> saw_poses_;  // parallel to poses_
  std::string states_channel_;
  bool saw_sea_ = false;
  std::string sea_channel_;  // empty: none
  std::vector<std::string> poses_;
  std::vector<std::regex> copied_;
  std::vector<std::string> responses_;
  std::unordered_map<std::string, Role, Hash, std::equal_to<>> roles_;  // a cache of bounded size
};

}  // namespace buoyancy::service

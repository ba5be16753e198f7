// Maps the channels of a log to their roles in a replay, such as request, pose or copied event.
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
    std::optional<RequestKind> request;  // body_states_t, water_points_t
    std::optional<std::size_t> pose;     // index of the channel in the PoseRequestAdapter
    bool sea = false;                    // sea_state_t or sea_grid_t, of a scene that receives its sea
    bool condition = false;              // body_condition_t, of a scene with compartments or tanks
    bool copied = false;

    bool any() const { return request || pose || sea || condition || copied; }
  };

  struct Names {
    std::string states;
    std::string sea;        // empty unless the scene receives its sea
    std::string condition;  // empty unless the scene has compartments or tanks
    std::string water_points;
  };

  // copied: regular expressions; an event is copied if one of them matches the full channel name, as in LCM's
  // tools. responses: the channels that the replay writes; they are never copied, since recorded and new
  // responses could not be distinguished. Errors: an invalid regular expression.
  static Expected<ReplayChannels> make(Names names, const std::vector<PoseChannel>& poses,
                                       const std::vector<std::string>& copied,
                                       std::vector<std::string> responses);

  // O(1) for a channel that was looked up before.
  Role role_of(std::string_view channel);

  // The configured channels of requests, poses and the sea that role_of() was never called with, perhaps
  // because they are misspelt. The channel of states is included only if there are no pose channels; those of
  // conditions and points never, since a run need not have any.
  std::vector<std::string> unseen_channels() const;

 private:
  struct Hash : std::hash<std::string_view> {
    using is_transparent = void;
  };

  ReplayChannels(Names names, const std::vector<PoseChannel>& poses, std::vector<std::regex> copied,
                 std::vector<std::string> responses);
  Role compute_role(std::string_view channel) const;

  bool saw_states_ = false;
  std::vector<bool> saw_poses_;  // parallel to poses_
  bool saw_sea_ = false;
  Names names_;
  std::vector<std::string> poses_;
  std::vector<std::regex> copied_;
  std::vector<std::string> responses_;
  std::unordered_map<std::string, Role, Hash, std::equal_to<>> roles_;  // a cache of bounded size
};

}  // namespace buoyancy::service

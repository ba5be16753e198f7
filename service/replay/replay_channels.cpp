#include "service/replay/replay_channels.h"

#include <algorithm>
#include <utility>

namespace buoyancy::service {
namespace {

constexpr std::size_t kMaxCachedRoles = 4096;  // a corrupt log may hold any number of channel names

}  // namespace

Expected<ReplayChannels> ReplayChannels::make(Names names, const std::vector<PoseChannel>& poses,
                                              const std::vector<std::string>& copied,
                                              std::vector<std::string> responses) {
  std::vector<std::regex> expressions;
  for (const std::string& text : copied) {
    try {
      expressions.emplace_back(text, std::regex::ECMAScript | std::regex::optimize);
    } catch (const std::regex_error& error) {
      return make_error(
          {"--copy " + text, error.what(), "a regular expression, '.*' for every channel", "", ""});
    }
  }
  return ReplayChannels(std::move(names), poses, std::move(expressions), std::move(responses));
}

ReplayChannels::ReplayChannels(Names names, const std::vector<PoseChannel>& poses,
                               std::vector<std::regex> copied, std::vector<std::string> responses)
    : names_(std::move(names)), copied_(std::move(copied)), responses_(std::move(responses)) {
  for (const PoseChannel& pose : poses) poses_.push_back(pose.channel);
  saw_poses_.resize(poses_.size());
}

ReplayChannels::Role ReplayChannels::role_of(std::string_view channel) {
  if (const auto known = roles_.find(channel); known != roles_.end()) return known->second;
  if (roles_.size() >= kMaxCachedRoles) roles_.clear();
  const Role role = compute_role(channel);
  if (role.request == RequestKind::kBodies) saw_states_ = true;
  if (role.sea) saw_sea_ = true;
  if (role.pose) saw_poses_[*role.pose] = true;
  return roles_.emplace(channel, role).first->second;
}

std::vector<std::string> ReplayChannels::unseen_channels() const {
  std::vector<std::string> names;
  if (poses_.empty() && !saw_states_) names.push_back(names_.states);
  if (!names_.sea.empty() && !saw_sea_) names.push_back(names_.sea);
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    if (!saw_poses_[i]) names.push_back(poses_[i]);
  }
  return names;
}

ReplayChannels::Role ReplayChannels::compute_role(std::string_view channel) const {
  Role role;
  if (channel == names_.states) role.request = RequestKind::kBodies;
  if (channel == names_.water_points) role.request = RequestKind::kWaterPoints;
  role.sea = !names_.sea.empty() && channel == names_.sea;
  role.condition = !names_.condition.empty() && channel == names_.condition;
  if (const auto pose = std::ranges::find(poses_, channel); pose != poses_.end()) {
    role.pose = static_cast<std::size_t>(pose - poses_.begin());
  }
  role.copied = std::ranges::find(responses_, channel) == responses_.end() &&
                std::ranges::any_of(copied_, [channel](const std::regex& expression) {
                  return std::regex_match(channel.begin(), channel.end(), expression);
                });
  return role;
}

}  // namespace buoyancy::service

#include "service/replay/replay_channels.h"

#include <algorithm>
#include <utility>

namespace buoyancy {
namespace {

constexpr std::size_t kMaxKnown = 4096;  // a damaged log may hold any number of names

}  // namespace

Expected<ReplayChannels> ReplayChannels::make(std::string states_channel,
                                              const std::vector<PoseChannel>& poses,
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
  return ReplayChannels(std::move(states_channel), poses, std::move(expressions), std::move(responses));
}

ReplayChannels::ReplayChannels(std::string states_channel, const std::vector<PoseChannel>& poses,
                               std::vector<std::regex> copied, std::vector<std::string> responses)
    : states_channel_(std::move(states_channel)),
      copied_(std::move(copied)),
      responses_(std::move(responses)) {
  for (const PoseChannel& pose : poses) poses_.push_back(pose.channel);
  saw_poses_.resize(poses_.size());
}

ReplayChannels::Use ReplayChannels::use_of(std::string_view channel) {
  if (const auto known = known_.find(channel); known != known_.end()) return known->second;
  if (known_.size() >= kMaxKnown) known_.clear();
  const Use use = look_up(channel);
  if (use.request) saw_states_ = true;
  if (use.pose) saw_poses_[*use.pose] = true;
  return known_.emplace(channel, use).first->second;
}

std::vector<std::string> ReplayChannels::unseen_channels() const {
  std::vector<std::string> names;
  if (poses_.empty() && !saw_states_) names.push_back(states_channel_);
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    if (!saw_poses_[i]) names.push_back(poses_[i]);
  }
  return names;
}

ReplayChannels::Use ReplayChannels::look_up(std::string_view channel) const {
  Use use;
  use.request = channel == states_channel_;
  if (const auto pose = std::ranges::find(poses_, channel); pose != poses_.end()) {
    use.pose = static_cast<std::size_t>(pose - poses_.begin());
  }
  use.copied = std::ranges::find(responses_, channel) == responses_.end() &&
               std::ranges::any_of(copied_, [channel](const std::regex& expression) {
                 return std::regex_match(channel.begin(), channel.end(), expression);
               });
  return use;
}

}  // namespace buoyancy

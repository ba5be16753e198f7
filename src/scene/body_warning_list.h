// Internal to the warnings about scenes: merges equal warnings about several bodies.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/format.h"
#include "scene/scene.h"

namespace buoyancy {

// Collects warnings without their subjects, each with the bodies to which it applies.
class BodyWarningList {
 public:
  void add(const Body& body, Warning warning) {
    const auto [entry, is_new] = index_.try_emplace(warning.message(), entries_.size());
    if (is_new) entries_.push_back({std::move(warning), body.id, 0});
    ++entries_[entry->second].bodies;
  }

  std::vector<Warning> with_subjects(const std::string& scene_name) {
    std::vector<Warning> warnings;
    for (Entry& entry : entries_) {
      entry.warning.subject = scene_name + ": body " + std::to_string(entry.first_id);
      if (entry.bodies > 1) entry.warning.subject += " and " + pluralize(entry.bodies - 1, "other", "others");
      warnings.push_back(std::move(entry.warning));
    }
    return warnings;
  }

 private:
  struct Entry {
    Warning warning;
    std::int32_t first_id = 0;
    std::int64_t bodies = 0;
  };

  std::map<std::string, std::size_t> index_;
  std::vector<Entry> entries_;
};

}  // namespace buoyancy

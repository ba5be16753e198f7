// Searches for the largest value of a figure of random draws, such as the error of a result over its
// published bound. It climbs: from the draws of the highest value among many it changes a few at a time, a
// little or entirely, and keeps what is not lower. Any generator of random cases can be searched so, without
// parameters of its own.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "tests/hydrostatics/random_poses.h"

namespace buoyancy {

struct ClimbEffort {
  int draws = 200;  // from the best of which it climbs
  int climbs = 3;
  int steps = 200;  // of each climb
};

// figure: a pure function of what it draws; NaN counts as 0. Returns the largest value that was met.
inline double highest(std::uint64_t seed, const ClimbEffort& effort,
                      const std::function<double(RandomPoses&)>& figure) {
  struct Place {
    double value;
    RandomPoses draws;
  };
  const auto at = [&figure](RandomPoses random) {
    const double value = figure(random);
    return Place{value >= 0.0 ? value : 0.0, random.again()};
  };
  std::vector<Place> places;
  for (int i = 0; i < effort.draws; ++i) places.push_back(at(RandomPoses(seed + static_cast<unsigned>(i))));
  std::ranges::sort(places, std::ranges::greater{}, &Place::value);
  std::mt19937_64 changes(seed);
  double largest = places.front().value;
  for (int i = 0; i < std::min(effort.climbs, effort.draws); ++i) {
    Place& place = places[static_cast<std::size_t>(i)];
    for (int step = 0; step < effort.steps; ++step) {
      Place next = at(place.draws.changed(changes));
      if (next.value >= place.value) place = std::move(next);
    }
    largest = std::max(largest, place.value);
  }
  return largest;
}

}  // namespace buoyancy

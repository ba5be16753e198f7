// A sea with what the loads of bodies need of it: prepared once per sea, immutable, shared by all threads.
#pragma once

#include <span>
#include <vector>

#include "wave_loads/sea_expansion.h"
#include "waves/sea.h"
#include "waves/sea_snapshot.h"

namespace buoyancy {

class PreparedSea : public Sea {
 public:
  // sea: not still. Complexity: O(components), about 1 us per component.
  explicit PreparedSea(Sea sea);
  // Snapshots and queries refer to the sea.
  PreparedSea(const PreparedSea&) = delete;
  PreparedSea& operator=(const PreparedSea&) = delete;

  // Of a sea on grids only the bounds on elevation, slope and curvature, amplitude_sums, are of use.
  const SeaExpansion& expansion() const { return expansion_; }

  // Bound on the norm of the gradient of the wave pressure over rho g, at full amplitudes, at and below this
  // height over the level: B_1 in docs/wave_mathematics.md. Not of a sea on grids. z: [m], <= 0. Complexity:
  // O(1).
  double max_gradient(double z) const;

  // Replaces the surfaces and the level [m] of a sea on grids, while nobody else refers to it. No heap
  // allocation.
  void set_surfaces(std::span<const TimedElevation> surfaces, double level);
  void release_surfaces() { Sea::release_surfaces(); }  // until set_surfaces() is called

 private:
  void set_bounds_of_surfaces();

  SeaExpansion expansion_;
  std::vector<double> max_gradients_;  // at heights that descend from 0, see depth_of() in the source
};

// A prepared sea at one instant, for the queries of one request.
class SeaAtTime : public SeaSnapshot {
 public:
  // sea must outlive this object.
  explicit SeaAtTime(const PreparedSea& sea) : SeaSnapshot(sea), sea_(&sea) {}
  SeaAtTime(const PreparedSea& sea, std::int64_t utime, double lead_time = 0.0)
      : SeaSnapshot(sea, utime, lead_time), sea_(&sea) {}

  const PreparedSea& sea() const { return *sea_; }
  // [m], no crest is higher and no trough deeper at this instant; with a margin for rounding.
  double max_elevation() const;

 private:
  const PreparedSea* sea_;
};

}  // namespace buoyancy

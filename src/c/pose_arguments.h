// Converts water, poses and arrays of results from the C interface to what src/query takes.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "c/argument_checks.h"
#include "messages/hydrostatics.h"
#include "messages/loads.h"
#include "query/pose_arrays.h"
#include "query/pose_evaluation.h"

namespace buoyancy {

inline constexpr buoyancy_water kDefaultWater{
    sizeof(buoyancy_water), 0.0, kSeawaterDensity, kStandardGravity, {0.0, 0.0, 1.0}, nullptr};

// given: NULL for the defaults.
QueryWater check_water(ArgumentChecks& checks, const buoyancy_water* given);

PoseArrays check_poses(ArgumentChecks& checks, const buoyancy_poses* given);

// The arrays of wrenches of n poses. Those that the caller does not want are kept here.
class WrenchOutput {
 public:
  WrenchOutput(ArgumentChecks& checks, const buoyancy_wrenches* given, std::size_t n);

  const WrenchArrays& arrays() const { return arrays_; }

 private:
  WrenchArrays arrays_;
  std::vector<double> unwanted_;
  std::vector<std::int32_t> unwanted_statuses_;
};

// Arrays of other results are checked once, and then written for one block of poses after the other.
void check_loads(ArgumentChecks& checks, const buoyancy_loads& given, std::size_t n);
void store_loads(std::span<const BodyLoads> loads, const buoyancy_loads& out, std::size_t first);
void check_hydrostatics(ArgumentChecks& checks, const buoyancy_hydrostatics& given, std::size_t n);
void store_hydrostatics(std::span<const BodyHydrostatics> hydrostatics, const buoyancy_hydrostatics& out,
                        std::size_t first);

// Return the poses [first, first + n) of an array, and likewise their wrenches.
PoseArrays part_of(const PoseArrays& poses, std::size_t first, std::size_t n);
WrenchArrays part_of(const WrenchArrays& wrenches, std::size_t first, std::size_t n);

// Evaluates the hydrostatics of each pose and stores them.
void evaluate_hydrostatics(const Body& body, const Water& water, const PoseArrays& poses,
                           const buoyancy_hydrostatics& out, unsigned threads);

// The poses of one block: results that do not go straight into the caller's arrays take 1 kB per pose.
inline constexpr std::size_t kBlock = 8192;

}  // namespace buoyancy

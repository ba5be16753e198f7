// Forces an instruction set for one scope.
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "hydrostatics/wetted_tree_sum.h"

namespace buoyancy {

class ForcedTarget {
 public:
  explicit ForcedTarget(const std::string& name) { EXPECT_TRUE(force_simd_target(name)) << name; }
  ForcedTarget(const ForcedTarget&) = delete;
  ForcedTarget& operator=(const ForcedTarget&) = delete;
  ~ForcedTarget() { force_simd_target(""); }
};

}  // namespace buoyancy

// Poses for property tests: random ones over all depths of a body, and adversarial ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

// Uniformly random bits that are remembered, so that they can be given again, with some of them changed.
class RandomBits {
 public:
  using result_type = std::uint64_t;

  explicit RandomBits(std::uint64_t seed) : fresh_(seed) {}

  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return ~result_type{0}; }
  result_type operator()() {
    if (next_ == given_.size()) given_.push_back(fresh_());
    return given_[next_++];
  }

  // Gives the same again from the beginning.
  void rewind() { next_ = 0; }
  // Replaces one to four of the numbers that it gave, or moves them by a little.
  void change(std::mt19937_64& random);

 private:
  std::mt19937_64 fresh_;
  std::vector<std::uint64_t> given_;
  std::size_t next_ = 0;
};

class RandomPoses {
 public:
  using result_type = RandomBits::result_type;

  explicit RandomPoses(std::uint64_t seed) : generator_(seed) {}

  static constexpr result_type min() { return RandomBits::min(); }
  static constexpr result_type max() { return RandomBits::max(); }
  result_type operator()() { return generator_(); }

  // Draws the same again, and the same but for a few changes.
  RandomPoses again() const;
  RandomPoses changed(std::mt19937_64& random) const;

  double uniform(double low, double high);
  double power_of_ten(double low_exponent, double high_exponent);
  double log_uniform(double low, double high);
  double sign() { return pick(2) == 0 ? 1.0 : -1.0; }
  Eigen::Quaterniond rotation();
  Vec3 direction();
  // In any direction, with a length that is uniform, or a power of ten with such an exponent.
  Vec3 vector(double shortest, double longest);
  Vec3 far_vector(double low_exponent, double high_exponent);

  // Any rotation; the height of the box's centre over the water is uniform in +-0.55 times the diagonal.
  Pose crossing(const BoundingBox& box, const Water& water);

  // The water plane passes through, or within a few ulp of, a vertex, the midpoint of an edge or a face of
  // the mesh; the rotation often maps axes to axes, or nearly so.
  Pose adversarial(const TriangleMesh& mesh, const Water& water);

  // Uniform in 0 .. count - 1.
  std::size_t pick(std::size_t count);

  // Any rotation that maps axes to axes.
  Eigen::Quaterniond quarter_turns();

 private:
  RandomBits generator_;
};

}  // namespace buoyancy

#include "tests/truth/reference_load.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "tests/truth/reference_elements.h"

namespace buoyancy {
namespace reference {
namespace {

class Integrator {
 public:
  Integrator(const TriangleMesh& surface_B, const Vec3& center_B, const ReferenceWaters& sea,
             const Vec3& reference_B, const ReferenceGoal& goal)
      : sea_(sea), goal_(goal), reference_(reference_B - center_B) {
    TriangleMesh about_c = surface_B;
    for (std::size_t i = 0; i < surface_B.vertex_count(); ++i) {
      about_c.x[i] -= center_B.x();
      about_c.y[i] -= center_B.y();
      about_c.z[i] -= center_B.z();
    }
    for (std::size_t i = 0; i < about_c.vertex_count(); ++i) {
      points_.add(about_c.vertex(static_cast<std::int32_t>(i)));
    }
    sea_.set_heights(points_);
    count_work(points_.size());
    for (const Triangle& triangle : about_c.triangles) {
      Element element;
      for (std::size_t i = 0; i < 3; ++i) {
        element.corners[i] = about_c.vertex(triangle[i]);
        element.heights[i] = points_.height[static_cast<std::size_t>(triangle[i])];
      }
      const Vec3 normal =
          (element.corners[1] - element.corners[0]).cross(element.corners[2] - element.corners[0]);
      const double area = 0.5 * normal.norm();
      if (!(area > 0.0)) continue;
      element.triangle = static_cast<std::uint32_t>(normals_.size());
      normals_.push_back(normal / (2.0 * area));
      total_area_ += area;
      elements_.push_back(element);
    }
    resolution_.emplace(sea_, negligible());
  }

  ReferenceLoad run() {
    std::size_t first = 0;
    bool within = true;
    constexpr int kMaxRounds = 60;
    for (int round = 0; round < kMaxRounds; ++round) {
      evaluate(first);
      first = elements_.size();
      within = result_.work <= goal_.max_work;
      if (!within || !refine()) break;
    }
    return sum();
  }

 private:
  void count_work(std::size_t points) {
    result_.work += static_cast<std::int64_t>(points * (sea_.components() + 2));
  }

  // What may be left out of waves that are shorter than the points of an element are apart.
  double negligible() const { return 0.05 * goal_.force_error / total_area_; }

  double largest_lever(const Element& element) const {
    double squared = 0.0;
    for (const Vec3& corner : element.corners) {
      squared = std::max(squared, (corner - reference_).squaredNorm());
    }
    return std::sqrt(squared);
  }

  // How far the height may be from its linear interpolant, besides what the midpoints of the edges show.
  double unseen_bend(double edge) const { return sea_.third_derivative() * edge * edge * edge / 40.0; }

  void evaluate(std::size_t first) {
    constexpr std::size_t kChunk = 2048;
    for (std::size_t begin = first; begin < elements_.size(); begin += kChunk) {
      evaluate_chunk(begin, std::min(begin + kChunk, elements_.size()));
      if (result_.work > goal_.max_work) {
        // The rest counts as not resolved.
        for (std::size_t i = begin + kChunk; i < elements_.size(); ++i) leave(elements_[i]);
        return;
      }
    }
  }

  // Gives up on an element: its error is infinite.
  void leave(Element& element) const {
    element.force_error = element.torque_error = element.volume_error =
        std::numeric_limits<double>::infinity();
    element.score = std::numeric_limits<double>::infinity();
  }

  void evaluate_chunk(std::size_t begin, std::size_t end) {
    // What is known from the corners alone.
    points_.clear();
    for (std::size_t n = begin; n < end; ++n) {
      Element& element = elements_[n];
      if (element.state != State::kUnknown) continue;
      const double edge = longest_edge(element.corners);
      const double bend = sea_.curvature() * edge * edge / 4.0 + unseen_bend(edge);
      const auto [low, high] = std::minmax_element(element.heights.begin(), element.heights.end());
      if (*low > bend) {
        element.state = State::kDry;
      } else if (*high < -bend) {
        element.state = State::kWet;
        element.highest = *high + bend;
      } else {
        for (std::size_t i = 0; i < 3; ++i) {
          points_.add(0.5 * (element.corners[i] + element.corners[(i + 1) % 3]));
        }
      }
    }
    sea_.set_heights(points_);
    count_work(points_.size() / 2);

    parts_.clear();
    std::size_t next = 0;
    for (std::size_t n = begin; n < end; ++n) {
      Element& element = elements_[n];
      std::array<double, 3> middles{};
      double bend = 0.0;
      if (element.state == State::kUnknown) {
        const double edge = longest_edge(element.corners);
        for (std::size_t i = 0; i < 3; ++i) {
          middles[i] = points_.height[next++];
          const double straight = 0.5 * (element.heights[i] + element.heights[(i + 1) % 3]);
          bend = std::max(bend, 2.0 * std::abs(middles[i] - straight));
        }
        bend += unseen_bend(edge);
        double low = middles[0];
        double high = middles[0];
        for (std::size_t i = 0; i < 3; ++i) {
          low = std::min({low, middles[i], element.heights[i]});
          high = std::max({high, middles[i], element.heights[i]});
        }
        // Midpoints show nothing of waves that are shorter than the edges.
        const bool coarse = edge * resolution_->wave_number(0.0) > kLongestEdge;
        if (coarse) {
          leave(element);
          continue;
        }
        element.state = low > bend ? State::kDry : high < -bend ? State::kWet : State::kCrossing;
        element.highest = high + bend;
      }
      if (element.state == State::kDry) continue;
      if (element.state == State::kWet) {
        if (longest_edge(element.corners) * resolution_->wave_number(-element.highest) > kLongestEdge) {
          leave(element);
          continue;
        }
        add_part(element.corners, 1.0, n);
      } else {
        clip(n, bend);
      }
    }
    integrate_parts();
    for (std::size_t n = begin; n < end; ++n) set_score(elements_[n]);
  }

  double area_of(const std::array<Vec3, 3>& c) const { return 0.5 * (c[1] - c[0]).cross(c[2] - c[0]).norm(); }

  void add_part(const std::array<Vec3, 3>& corners, double sign, std::size_t element) {
    const double area = sign * area_of(corners);
    if (area == 0.0) return;
    parts_.push_back({corners, area, element});
  }

  void clip(std::size_t n, double bend) {
    Element& element = elements_[n];
    const std::array<double, 3>& s = element.heights;
    const std::array<Vec3, 3>& c = element.corners;
    // Where the surface may be on the other side of the interpolant, |s| is below `bend`.
    const auto raised = [&](double by) { return mean_positive_part({s[0] + by, s[1] + by, s[2] + by}); };
    const double strip = area_of(c) * std::max(raised(bend) - 2.0 * raised(0.0) + raised(-bend), 0.0);
    element.force_error += 1.2 * strip;
    element.torque_error += 1.2 * strip * largest_lever(element);
    element.volume_error += strip;
    const int wet = (s[0] < 0.0) + (s[1] < 0.0) + (s[2] < 0.0);
    if (wet == 0) return;
    if (wet == 3) return add_part(c, 1.0, n);
    std::size_t lone = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      if ((s[i] < 0.0) == (wet == 1)) lone = i;
    }
    const std::size_t second = (lone + 1) % 3;
    const std::size_t third = (lone + 2) % 3;
    const Vec3 on_second = c[lone] + s[lone] / (s[lone] - s[second]) * (c[second] - c[lone]);
    const Vec3 on_third = c[lone] + s[lone] / (s[lone] - s[third]) * (c[third] - c[lone]);
    if (wet == 1) return add_part({c[lone], on_second, on_third}, 1.0, n);
    add_part({on_second, c[second], c[third]}, 1.0, n);
    add_part({on_second, c[third], on_third}, 1.0, n);
  }

  void integrate_parts() {
    points_.clear();
    for (const Part& part : parts_) {
      for (const Orbit& orbit : kOrbits) {
        for (std::size_t i = 0; i < 3; ++i) {
          points_.add(orbit.same * (part.corners[(i + 1) % 3] + part.corners[(i + 2) % 3]) +
                      (1.0 - 2.0 * orbit.same) * part.corners[i]);
        }
      }
    }
    sea_.set_pressures(points_);
    count_work(points_.size());
    std::size_t p = 0;
    for (const Part& part : parts_) {
      Element& element = elements_[part.element];
      double of_fine = 0.0;
      double of_coarse = 0.0;
      double height_fine = 0.0;
      double height_coarse = 0.0;
      Vec3 moment_fine = Vec3::Zero();
      Vec3 moment_coarse = Vec3::Zero();
      for (std::size_t i = 0; i < kPointsPerPart; ++i, ++p) {
        const double weight = kOrbits[i / 3].weight;
        const double pressure = weight * points_.pressure[p];
        const Vec3 y(points_.x[p], points_.y[p], points_.z[p]);
        if (i < 6) {
          of_fine += pressure;
          moment_fine += pressure * y;
          height_fine += weight * points_.height[p];
        } else {
          of_coarse += pressure;
          moment_coarse += pressure * y;
          height_coarse += weight * points_.height[p];
        }
      }
      element.pressure += part.area * of_fine;
      element.moment += part.area * moment_fine;
      element.height += part.area * height_fine;
      const double difference = of_fine - of_coarse;
      element.force_error += part.area * std::abs(difference);
      element.torque_error +=
          part.area *
          (moment_fine - moment_coarse - difference * reference_).cross(normals_[element.triangle]).norm();
      element.volume_error +=
          part.area * std::abs((height_fine - height_coarse) * normals_[element.triangle].dot(sea_.up_B()));
    }
  }

  void set_score(Element& element) const {
    element.score =
        std::max({element.force_error / goal_.force_error, element.torque_error / goal_.torque_error,
                  element.volume_error / goal_.volume_error});
  }

  // Replaces the elements with the largest errors by parts, so that the others have half of what is allowed.
  // Returns false if the sum is small enough.
  bool refine() {
    std::array<double, 64> sums{};  // by the exponent of the score
    double total = 0.0;
    const auto place_of = [](double score) {
      if (!(score > 0.0)) return std::size_t{0};
      if (std::isinf(score)) return std::size_t{63};
      return static_cast<std::size_t>(std::clamp(std::ilogb(score) + 50, 0, 62));
    };
    for (const Element& element : elements_) {
      if (element.done) continue;
      total += element.score;
      sums[place_of(element.score)] += element.score;
    }
    if (total <= kShareOfElements) return false;
    std::size_t from = 0;
    double below = 0.0;
    while (from < 63 && below + sums[from] <= 0.5 * kShareOfElements) below += sums[from++];
    const std::size_t count = elements_.size();
    new_elements_ = count;
    for (std::size_t n = 0; n < count; ++n) {
      if (elements_[n].done || !(elements_[n].score > 0.0) || place_of(elements_[n].score) < from) continue;
      elements_[n].done = true;
      split(elements_[n]);
    }
    set_heights_of_new();
    return true;
  }

  // By value: the parts are appended to the array that it is in.
  void split(Element element) {
    const std::array<Vec3, 3> c = element.corners;
    Element part;
    part.triangle = element.triangle;
    if (element.state == State::kWet) {
      part.state = State::kWet;
      part.highest = element.highest;
    }
    const auto add = [&](const Vec3& p, const Vec3& q, const Vec3& r) {
      part.corners = {p, q, r};
      elements_.push_back(part);
    };
    const std::array<double, 3> edges{(c[1] - c[0]).norm(), (c[2] - c[1]).norm(), (c[0] - c[2]).norm()};
    const auto longest =
        static_cast<std::size_t>(std::max_element(edges.begin(), edges.end()) - edges.begin());
    const double shortest = *std::min_element(edges.begin(), edges.end());
    if (edges[longest] > 1.8 * shortest) {
      const Vec3& a = c[longest];
      const Vec3& b = c[(longest + 1) % 3];
      const Vec3& apex = c[(longest + 2) % 3];
      const Vec3 middle = 0.5 * (a + b);
      add(a, middle, apex);
      add(middle, b, apex);
      return;
    }
    const Vec3 ab = 0.5 * (c[0] + c[1]);
    const Vec3 bc = 0.5 * (c[1] + c[2]);
    const Vec3 ca = 0.5 * (c[2] + c[0]);
    add(c[0], ab, ca);
    add(ab, c[1], bc);
    add(ca, bc, c[2]);
    add(ab, bc, ca);
  }

  void set_heights_of_new() {
    points_.clear();
    for (std::size_t n = new_elements_; n < elements_.size(); ++n) {
      if (elements_[n].state != State::kUnknown) continue;
      for (const Vec3& corner : elements_[n].corners) points_.add(corner);
    }
    sea_.set_heights(points_);
    count_work(points_.size() / 2);
    std::size_t next = 0;
    for (std::size_t n = new_elements_; n < elements_.size(); ++n) {
      if (elements_[n].state != State::kUnknown) continue;
      for (double& height : elements_[n].heights) height = points_.height[next++];
    }
  }

  ReferenceLoad sum() {
    double wet_area = 0.0;
    double largest_term = 0.0;
    for (const Element& element : elements_) {
      if (element.done) continue;
      const Vec3& normal = normals_[element.triangle];
      result_.force -= element.pressure * normal;
      result_.torque -= (element.moment - element.pressure * reference_).cross(normal);
      result_.volume += element.height * normal.dot(sea_.up_B());
      result_.force_error += element.force_error;
      result_.torque_error += element.torque_error;
      result_.volume_error += element.volume_error;
      largest_term = std::max(largest_term, std::abs(element.pressure));
      if (element.state != State::kDry) wet_area += area_of(element.corners);
    }
    double reach = 0.0;
    for (const Element& element : elements_) {
      if (!element.done) reach = std::max(reach, largest_lever(element));
    }
    // Phases, the waves that are not resolved, and the rounding of the sum.
    const double rounding = 1e-13 * std::max(largest_term, result_.force.norm());
    const double everywhere = 2.0 * sea_.error() * wet_area + negligible() * wet_area + rounding;
    result_.force_error += everywhere;
    result_.torque_error += everywhere * reach;
    result_.volume_error += everywhere;
    result_.resolved = result_.force_error <= 1.1 * goal_.force_error &&
                       result_.torque_error <= 1.1 * goal_.torque_error &&
                       result_.volume_error <= 1.1 * goal_.volume_error;
    return result_;
  }

  // Longest edge of an element in radians of the waves that matter there.
  static constexpr double kLongestEdge = 1.5;
  static constexpr double kShareOfElements = 0.9;

  const ReferenceWaters& sea_;
  ReferenceGoal goal_;
  Vec3 reference_;
  std::vector<Vec3> normals_;
  double total_area_ = 0.0;
  std::vector<Element> elements_;
  std::size_t new_elements_ = 0;
  std::vector<Part> parts_;
  SeaPoints points_;
  std::optional<WaveResolution> resolution_;
  ReferenceLoad result_;
};

}  // namespace
}  // namespace reference

ReferenceLoad reference_load(const TriangleMesh& surface_B, const Vec3& center_B, const ReferenceWaters& sea,
                             const Vec3& reference_B, const ReferenceGoal& goal) {
  return reference::Integrator(surface_B, center_B, sea, reference_B, goal).run();
}

}  // namespace buoyancy

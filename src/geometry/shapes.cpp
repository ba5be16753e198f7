#include "geometry/shapes.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "base/format.h"
#include "geometry/shape_generators.h"

namespace buoyancy {
namespace {

constexpr double kMinSize = 1e-9;  // [m]
constexpr double kMaxSize = 1e9;   // [m]
constexpr std::int32_t kMaxCount = 100'000;
constexpr std::int64_t kMaxTriangleCount = 20'000'000;
constexpr double kMaxRoughness = 0.6;
constexpr std::int32_t kMaxWinding = 32;
constexpr std::int32_t kStepsPerWinding = 12;

// Checks a shape's arguments and keeps the first error.
class Check {
 public:
  explicit Check(std::string_view type) : subject_(std::string(type) + " shape") {}

  Check& size(const char* key, double value) {
    if (!(value >= kMinSize && value <= kMaxSize)) {
      fail(std::string(key) + " = " + format_shortest(value),
           "a length from " + format_shortest(kMinSize) + " to " + format_shortest(kMaxSize) + " (m)");
    }
    return *this;
  }
  Check& count(const char* key, std::int32_t value, std::int32_t min, std::int32_t max = kMaxCount) {
    if (value < min || value > max) {
      fail(std::string(key) + " = " + std::to_string(value),
           "a whole number from " + std::to_string(min) + " to " + std::to_string(max));
    }
    return *this;
  }
  Check& triangles(std::int64_t count) {
    if (count > kMaxTriangleCount) {
      fail(std::to_string(count) + " triangles", "at most " + std::to_string(kMaxTriangleCount),
           "the subdivision is too fine");
    }
    return *this;
  }
  Check& require(bool condition, const std::string& actual, const std::string& expected,
                 const std::string& cause = {}) {
    if (!condition) fail(actual, expected, cause);
    return *this;
  }

  bool passed() const { return !error_; }
  std::optional<Error> error() && { return std::move(error_); }

 private:
  void fail(const std::string& actual, const std::string& expected, const std::string& cause = {}) {
    if (!error_) error_ = Error{subject_, actual, expected, cause, {}};
  }

  std::string subject_;
  std::optional<Error> error_;
};

std::optional<Error> find_error(const BoxShape& box) {
  Check check("box");
  check.size("size[0]", box.size[0]).size("size[1]", box.size[1]).size("size[2]", box.size[2]);
  check.count("segments[0]", box.segments[0], 1)
      .count("segments[1]", box.segments[1], 1)
      .count("segments[2]", box.segments[2], 1);
  const std::int64_t a = box.segments[0];
  const std::int64_t b = box.segments[1];
  const std::int64_t c = box.segments[2];
  if (check.passed()) check.triangles(4 * (a * b + b * c + c * a));
  return std::move(check).error();
}

std::optional<Error> find_error(const SphereShape& sphere) {
  Check check("sphere");
  check.size("radius", sphere.radius).count("segments", sphere.segments, 3);
  if (check.passed()) check.triangles(2 * std::int64_t{sphere.segments} * sphere.segments);
  return std::move(check).error();
}

std::optional<Error> find_error(const CylinderShape& cylinder) {
  Check check("cylinder");
  check.size("radius", cylinder.radius).size("height", cylinder.height);
  check.count("segments", cylinder.segments, 3).count("stacks", cylinder.stacks, 1);
  if (check.passed())
    check.triangles(2 * std::int64_t{cylinder.segments} * (std::int64_t{cylinder.stacks} + 1));
  return std::move(check).error();
}

std::optional<Error> find_error(const ConeShape& cone) {
  Check check("cone");
  check.size("radius", cone.radius).size("height", cone.height);
  check.count("segments", cone.segments, 3).count("stacks", cone.stacks, 1);
  if (check.passed()) check.triangles(2 * std::int64_t{cone.segments} * cone.stacks);
  return std::move(check).error();
}

std::optional<Error> find_error(const TorusKnotShape& knot) {
  Check check("torus_knot");
  check.size("radius", knot.radius).size("tube", knot.tube);
  check.count("p", knot.p, 1, kMaxWinding).count("q", knot.q, 1, kMaxWinding);
  check.count("radial", knot.radial, 3);
  if (check.passed()) {
    check.require(
        std::gcd(knot.p, knot.q) == 1, "p = " + std::to_string(knot.p) + " and q = " + std::to_string(knot.q),
        "numbers without a common divisor", "these numbers give a link of several strands, not a knot");
    // With fewer steps, the straight pieces of the tube deviate from the curve towards each other.
    check.count("tubular", knot.tubular, kStepsPerWinding * std::max(knot.p, knot.q));
  }
  if (check.passed()) check.triangles(2 * std::int64_t{knot.tubular} * knot.radial);
  if (check.passed()) {
    const double max_tube = 0.9 * max_tube_radius(knot);
    check.require(knot.tube <= max_tube, "tube = " + format_shortest(knot.tube),
                  "at most " + format_shortest(max_tube) + " (m) for this radius, p and q",
                  "the tube is wider than the distance of the knot's strands");
  }
  return std::move(check).error();
}

std::optional<Error> find_error(const WigleyShape& hull) {
  Check check("wigley");
  check.size("length", hull.length)
      .size("beam", hull.beam)
      .size("draft", hull.draft)
      .size("freeboard", hull.freeboard);
  check.count("segments", hull.segments, 2).count("levels", hull.levels, 1);
  if (check.passed())
    check.triangles(4 * std::int64_t{hull.segments} * (std::int64_t{hull.levels} + 1) +
                    2 * std::int64_t{hull.segments} - 2);
  return std::move(check).error();
}

std::optional<Error> find_error(const RockShape& rock) {
  Check check("rock");
  check.size("radius", rock.radius).count("frequency", rock.frequency, 1);
  check.require(rock.roughness >= 0.0 && rock.roughness <= kMaxRoughness,
                "roughness = " + format_shortest(rock.roughness),
                "a number from 0 to " + format_shortest(kMaxRoughness));
  if (check.passed()) check.triangles(20 * std::int64_t{rock.frequency} * rock.frequency);
  return std::move(check).error();
}

void round_to_float32(TriangleMesh& mesh) {
  for (std::vector<double>* const coordinates : {&mesh.x, &mesh.y, &mesh.z}) {
    for (double& value : *coordinates) value = static_cast<double>(static_cast<float>(value));
  }
}

}  // namespace

std::string_view type_name(const Shape& shape) {
  constexpr std::array<std::string_view, std::variant_size_v<Shape>> kNames{
      "box", "sphere", "cylinder", "cone", "torus_knot", "wigley", "rock"};
  return kNames[shape.index()];
}

Expected<Shape> check_shape(const Shape& shape) {
  std::optional<Error> error = std::visit([](const auto& s) { return find_error(s); }, shape);
  if (error) return make_error(*std::move(error));
  return shape;
}

TriangleMesh make_shape(const Shape& shape) {
  TriangleMesh mesh = std::visit([](const auto& s) { return generate(s); }, shape);
  const bool is_curved = std::holds_alternative<SphereShape>(shape) ||
                         std::holds_alternative<TorusKnotShape>(shape) ||
                         std::holds_alternative<RockShape>(shape);
  if (is_curved) round_to_float32(mesh);
  return mesh;
}

}  // namespace buoyancy

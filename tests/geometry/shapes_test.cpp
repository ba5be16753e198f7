#include "geometry/shapes.h"

#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "geometry/self_intersection.h"
#include "tests/geometry/sample_meshes.h"
#include "tests/support/contains.h"

namespace buoyancy {
namespace {

// Relative error of coordinates that are rounded to float32.
constexpr double kFloat32 = 0x1p-24;

TriangleMesh made(const Shape& shape) {
  const Expected<Shape> checked = check_shape(shape);
  EXPECT_TRUE(checked.has_value()) << (checked ? "" : checked.error().message());
  return make_shape(shape);
}

// Returns an empty text if each edge is used once in each direction, all vertices are used and distinct, no
// triangle has zero area and the volume is positive; else the first fault.
std::string find_fault(const TriangleMesh& mesh) {
  std::map<std::pair<std::int32_t, std::int32_t>, int> uses;
  std::vector<bool> used(mesh.vertex_count(), false);
  for (const Triangle& triangle : mesh.triangles) {
    for (std::size_t side = 0; side < 3; ++side) {
      ++uses[{triangle[side], triangle[(side + 1) % 3]}];
      used[static_cast<std::size_t>(triangle[side])] = true;
    }
    const Vec3 a = mesh.vertex(triangle[0]);
    const Vec3 ab = mesh.vertex(triangle[1]) - a;
    const Vec3 ac = mesh.vertex(triangle[2]) - a;
    if (!(ab.cross(ac).norm() > 0.0)) return "a triangle without area";
  }
  for (const auto& [edge, count] : uses) {
    if (edge.first == edge.second) return "a triangle names a vertex twice";
    if (count != 1) return "an edge is used more than once the same way";
    if (uses.count({edge.second, edge.first}) == 0) return "an edge has no partner";
  }
  std::set<std::array<double, 3>> places;
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    if (!used[i]) return "a vertex is used by no triangle";
    if (!places.insert({mesh.x[i] + 0.0, mesh.y[i] + 0.0, mesh.z[i] + 0.0}).second) {
      return "two vertices at the same place";
    }
  }
  if (!(volume_of(mesh) > 0.0)) return "inside out";
  return {};
}

// Returns the Euler characteristic: 2 for a topological sphere, 0 for a torus.
std::int64_t euler_characteristic(const TriangleMesh& mesh) {
  return static_cast<std::int64_t>(mesh.vertex_count()) -
         static_cast<std::int64_t>(mesh.triangles.size()) / 2;
}

std::string check_error(const Shape& shape) {
  const Expected<Shape> checked = check_shape(shape);
  return checked ? "accepted" : checked.error().message();
}

// Returns the FNV-1a hash of the coordinates' bits.
std::uint64_t hash_of(const TriangleMesh& mesh) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const std::vector<double>* coordinates : {&mesh.x, &mesh.y, &mesh.z}) {
    for (const double value : *coordinates) {
      const auto bits = std::bit_cast<std::uint64_t>(value);
      for (unsigned shift = 0; shift < 64; shift += 8) {
        hash = (hash ^ ((bits >> shift) & 0xffU)) * 0x100000001b3U;
      }
    }
  }
  return hash;
}

TEST(BoxShape, HasTriangleCountsOfPaper) {
  EXPECT_EQ(made(BoxShape{{1, 1, 1}, {10, 10, 10}}).triangles.size(), 1'200U);
  EXPECT_EQ(made(BoxShape{{1, 1, 1}, {100, 100, 100}}).triangles.size(), 120'000U);
}

TEST(BoxShape, IsClosedForUnequalSegments) {
  const TriangleMesh mesh = made(BoxShape{{1, 2, 3}, {4, 1, 7}});
  EXPECT_EQ(find_fault(mesh), "");
  EXPECT_EQ(mesh.triangles.size(), 4U * (4 * 1 + 1 * 7 + 7 * 4));
  EXPECT_EQ(euler_characteristic(mesh), 2);
  EXPECT_NEAR(volume_of(mesh), 6.0, 1e-14);
}

TEST(BoxShape, IsCentredOnOrigin) {
  const BoundingBox box = bounding_box(made(BoxShape{{1, 2, 3}, {2, 3, 4}}));
  EXPECT_EQ(box.min_B, Vec3(-0.5, -1, -1.5));
  EXPECT_EQ(box.max_B, Vec3(0.5, 1, 1.5));
}

TEST(SphereShape, HasTriangleCountsOfPaper) {
  EXPECT_EQ(made(SphereShape{1, 50}).triangles.size(), 5'000U);
  EXPECT_EQ(made(SphereShape{1, 200}).triangles.size(), 80'000U);
}

TEST(SphereShape, HasVerticesOnSphere) {
  const TriangleMesh mesh = made(SphereShape{2.5, 31});
  EXPECT_EQ(find_fault(mesh), "");
  EXPECT_EQ(euler_characteristic(mesh), 2);
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    EXPECT_NEAR(mesh.vertex(static_cast<std::int32_t>(i)).norm(), 2.5, 2.5 * kFloat32);
  }
}

TEST(SphereShape, HasEqualBandsOfLatitude) {
  constexpr std::int32_t kSegments = 12;
  const TriangleMesh mesh = made(SphereShape{1, kSegments});
  std::set<double> heights(mesh.z.begin(), mesh.z.end());
  ASSERT_EQ(heights.size(), kSegments + 2U);
  double latitude = -0.5 * std::numbers::pi;
  for (const double height : heights) {
    EXPECT_NEAR(height, std::sin(latitude), kFloat32);
    latitude += std::numbers::pi / (kSegments + 1);
  }
}

TEST(SphereShape, ConvergesQuadraticallyToBall) {
  const double ball = 4.0 / 3.0 * std::numbers::pi;
  const double coarse = ball - volume_of(made(SphereShape{1, 25}));
  const double fine = ball - volume_of(made(SphereShape{1, 100}));
  EXPECT_GT(fine, 0.0);
  EXPECT_NEAR(coarse / fine, 16.0, 1.0);
}

double regular_polygon_area(double radius, std::int32_t sides) {
  return 0.5 * sides * std::sin(2.0 * std::numbers::pi / sides) * radius * radius;
}

TEST(CylinderShape, IsRegularPrism) {
  const TriangleMesh mesh = made(CylinderShape{0.5, 3, 12, 4});
  EXPECT_EQ(find_fault(mesh), "");
  EXPECT_EQ(mesh.triangles.size(), 2U * 12 * (4 + 1));
  EXPECT_NEAR(volume_of(mesh), regular_polygon_area(0.5, 12) * 3, 1e-14);
  const BoundingBox box = bounding_box(mesh);
  EXPECT_EQ(box.min_B.z(), -1.5);
  EXPECT_EQ(box.max_B.z(), 1.5);
}

TEST(ConeShape, IsPyramidWithBaseAtZero) {
  const TriangleMesh mesh = made(ConeShape{0.5, 3, 12, 4});
  EXPECT_EQ(find_fault(mesh), "");
  EXPECT_EQ(mesh.triangles.size(), 2U * 12 * 4);
  EXPECT_NEAR(volume_of(mesh), regular_polygon_area(0.5, 12), 1e-14);
  const BoundingBox box = bounding_box(mesh);
  EXPECT_EQ(box.min_B.z(), 0.0);
  EXPECT_EQ(box.max_B.z(), 3.0);
  EXPECT_EQ(box.max_B.x(), 0.5);
}

TEST(TorusKnotShape, HasTriangleCountOfPaper) {
  const TriangleMesh mesh = made(TorusKnotShape{});
  EXPECT_EQ(mesh.triangles.size(), 1'760U);
  EXPECT_EQ(find_fault(mesh), "");
  EXPECT_EQ(euler_characteristic(mesh), 0);
}

TEST(TorusKnotShape, MatchesVolumeByPappus) {
  // Pappus: the volume of a tube around a closed curve is its cross section times the length of the curve, if
  // the cross section's centroid lies on the curve.
  const TorusKnotShape knot{1, 0.1, 3, 2, 4'000, 64};
  double length = 0.0;
  constexpr int kSteps = 10'000;
  for (int i = 0; i < kSteps; ++i) {
    const double t = 2.0 * std::numbers::pi * i / kSteps;
    const double distance = (2.0 + std::cos(3 * t)) / 3.0;
    length += std::hypot(2 * distance, 1.0) * 2.0 * std::numbers::pi / kSteps;
  }
  const double expected = length * regular_polygon_area(0.1, 64);
  EXPECT_NEAR(volume_of(made(knot)), expected, 1e-4 * expected);
}

TEST(TorusKnotShape, LimitsRadiusOfTube) {
  EXPECT_EQ(check_error(TorusKnotShape{}), "accepted");
  const std::string message = check_error(TorusKnotShape{1, 0.5});
  EXPECT_TRUE(contains(message, "tube = 0.5"));
  EXPECT_TRUE(contains(message, "at most 0.2"));
}

TEST(WigleyShape, EnclosesHullAndFreeboard) {
  const WigleyShape hull{10, 1, 0.625, 0.3, 256, 128};
  const TriangleMesh mesh = made(hull);
  EXPECT_EQ(find_fault(mesh), "");
  EXPECT_EQ(euler_characteristic(mesh), 2);
  EXPECT_EQ(mesh.triangles.size(), 4U * 256 * 129 + 2 * 256 - 2);
  const double below = 4.0 / 9.0 * 10 * 1 * 0.625;
  const double above = 2.0 / 3.0 * 10 * 1 * 0.3;
  EXPECT_NEAR(volume_of(mesh), below + above, 1e-4 * (below + above));
}

TEST(WigleyShape, ConvergesQuadraticallyToHull) {
  const double hull = 4.0 / 9.0 * 10 * 0.625 + 2.0 / 3.0 * 10 * 0.3;
  const double coarse = hull - volume_of(made(WigleyShape{10, 1, 0.625, 0.3, 16, 8}));
  const double fine = hull - volume_of(made(WigleyShape{10, 1, 0.625, 0.3, 64, 32}));
  EXPECT_GT(fine, 0.0);
  EXPECT_NEAR(coarse / fine, 16.0, 0.5);
}

TEST(WigleyShape, HasVerticesOnHullAndVerticalFreeboard) {
  const WigleyShape hull{10, 1, 0.625, 0.3, 9, 5};
  const TriangleMesh mesh = made(hull);
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    const double xi = 2.0 * mesh.x[i] / hull.length;
    const double zeta = std::min(mesh.z[i], 0.0) / hull.draft;
    EXPECT_NEAR(std::abs(mesh.y[i]), 0.5 * hull.beam * (1 - xi * xi) * (1 - zeta * zeta), 1e-15);
  }
  const BoundingBox box = bounding_box(mesh);
  EXPECT_EQ(box.min_B.z(), -0.625);
  EXPECT_EQ(box.max_B.z(), 0.3);
}

TEST(RockShape, HasTwentyTimesFrequencySquaredTriangles) {
  EXPECT_EQ(made(RockShape{1, 16}).triangles.size(), 5'120U);
  EXPECT_EQ(made(RockShape{1, 224}).triangles.size(), 1'003'520U);
}

TEST(RockShape, IsStarShapedAboutCentre) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const TriangleMesh mesh = made(RockShape{1, 24, 0.6, seed});
    EXPECT_EQ(find_fault(mesh), "");
    EXPECT_EQ(euler_characteristic(mesh), 2);
    for (const auto& [a, b, c] : mesh.triangles) {
      EXPECT_GT(mesh.vertex(a).dot(mesh.vertex(b).cross(mesh.vertex(c))), 0.0);
    }
  }
}

TEST(RockShape, IsIcosphereWithoutRoughness) {
  const TriangleMesh mesh = made(RockShape{3, 8, 0.0});
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    EXPECT_NEAR(mesh.vertex(static_cast<std::int32_t>(i)).norm(), 3.0, 3.0 * kFloat32);
  }
}

TEST(RockShape, IsRoughWithBoundedSlope) {
  const TriangleMesh mesh = made(RockShape{1, 64, 0.25});
  double lowest = 2.0;
  double highest = 0.0;
  double steepest = 0.0;
  for (const Triangle& triangle : mesh.triangles) {
    for (std::size_t side = 0; side < 3; ++side) {
      const Vec3 a = mesh.vertex(triangle[side]);
      const Vec3 b = mesh.vertex(triangle[(side + 1) % 3]);
      lowest = std::min(lowest, a.norm());
      highest = std::max(highest, a.norm());
      steepest = std::max(steepest, std::abs(a.norm() - b.norm()) / (a - b).norm());
    }
  }
  EXPECT_GT(highest - lowest, 0.1);
  EXPECT_GT(steepest, 0.1);
  EXPECT_LT(steepest, 0.8);
}

TEST(RockShape, HasSameBitsOnEveryMachine) {
  EXPECT_EQ(hash_of(made(RockShape{1, 16, 0.25, 1})), 7483254079077531942U);
}

TEST(RockShape, DependsOnSeed) {
  EXPECT_EQ(hash_of(made(RockShape{1, 8, 0.25, 7})), hash_of(made(RockShape{1, 8, 0.25, 7})));
  EXPECT_NE(hash_of(made(RockShape{1, 8, 0.25, 7})), hash_of(made(RockShape{1, 8, 0.25, 8})));
}

TEST(CheckShape, NamesKeyValueAndRange) {
  EXPECT_EQ(check_error(SphereShape{-1, 50}),
            "sphere shape: radius = -1; expected a length from 1e-09 to 1e+09 (m).");
  EXPECT_EQ(check_error(SphereShape{1, 2}),
            "sphere shape: segments = 2; expected a whole number from 3 to 100000.");
  EXPECT_EQ(check_error(BoxShape{{1, std::nan(""), 1}}),
            "box shape: size[1] = nan; expected a length from 1e-09 to 1e+09 (m).");
  EXPECT_EQ(check_error(RockShape{1, 16, 0.7}),
            "rock shape: roughness = 0.7; expected a number from 0 to 0.6.");
}

TEST(CheckShape, RejectsInvalidArguments) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::vector<std::pair<Shape, std::string>> invalid{
      {BoxShape{{0, 1, 1}}, "size[0] = 0"},
      {BoxShape{{1, 1, kInfinity}}, "size[2] = inf"},
      {BoxShape{{1, 1, 1}, {1, 0, 1}}, "segments[1] = 0"},
      {BoxShape{{1, 1, 1}, {5'000, 5'000, 1}}, "triangles"},
      {SphereShape{1, 100'001}, "segments = 100001"},
      {SphereShape{1, 5'000}, "50000000 triangles"},
      {CylinderShape{-0.5}, "radius = -0.5"},
      {CylinderShape{1, 0}, "height = 0"},
      {CylinderShape{1, 1, 2}, "segments = 2"},
      {CylinderShape{1, 1, 64, 0}, "stacks = 0"},
      {ConeShape{1, -1}, "height = -1"},
      {ConeShape{1, 1, 64, -3}, "stacks = -3"},
      {TorusKnotShape{1, -0.1}, "tube = -0.1"},
      {TorusKnotShape{1, 0.1, 4, 2}, "p = 4 and q = 2"},
      {TorusKnotShape{1, 0.1, 0, 1}, "p = 0"},
      {TorusKnotShape{1, 0.1, 3, 2, 10}, "tubular = 10"},
      {TorusKnotShape{1, 0.1, 3, 2, 110, 2}, "radial = 2"},
      {WigleyShape{10, 1, 0.6, -1}, "freeboard = -1"},
      {WigleyShape{10, 1, 0.6, 1, 1}, "segments = 1"},
      {WigleyShape{10, 1, 0.6, 1, 8, 0}, "levels = 0"},
      {RockShape{0}, "radius = 0"},
      {RockShape{1, 0}, "frequency = 0"},
      {RockShape{1, 1'001}, "triangles"},
      {BoxShape{{1, 1, 1}, {2147483647, 2147483647, 2147483647}}, "segments[0] = 2147483647"},
      {RockShape{1, 16, -0.1}, "roughness = -0.1"},
  };
  for (const auto& [shape, actual] : invalid) {
    const std::string message = check_error(shape);
    EXPECT_TRUE(contains(message, actual)) << "\nexpected to contain: " << actual;
  }
}

double random_size() {
  return std::exp2(*rc::gen::inRange(-400, 400) / 20.0);
}

// Returns a random shape of any type; only the tube of a knot may fail check_shape.
Shape random_shape() {
  const auto count = [](int min, int max) { return *rc::gen::inRange<std::int32_t>(min, max); };
  switch (*rc::gen::inRange(0, 7)) {
    case 0:
      return BoxShape{{random_size(), random_size(), random_size()}, {count(1, 9), count(1, 9), count(1, 9)}};
    case 1:
      return SphereShape{random_size(), count(3, 40)};
    case 2:
      return CylinderShape{random_size(), random_size(), count(3, 40), count(1, 9)};
    case 3:
      return ConeShape{random_size(), random_size(), count(3, 40), count(1, 9)};
    case 4: {
      const double radius = random_size();
      return TorusKnotShape{radius,         *rc::gen::inRange(1, 40) / 100.0 * radius,
                            count(1, 5),    count(1, 5),
                            count(60, 150), count(3, 12)};
    }
    case 5:
      return WigleyShape{random_size(), random_size(), random_size(),
                         random_size(), count(2, 30),  count(1, 9)};
    default:
      return RockShape{random_size(), count(1, 20), *rc::gen::inRange(0, 61) / 100.0,
                       *rc::gen::arbitrary<std::uint64_t>()};
  }
}

RC_GTEST_PROP(MakeShape, ReturnsClosedOutwardOrientedMesh, ()) {
  const Shape shape = random_shape();
  RC_PRE(check_shape(shape).has_value());
  RC_ASSERT(find_fault(make_shape(shape)) == std::string());
}

RC_GTEST_PROP(MakeShape, ReturnsMeshWithoutSelfIntersection, ()) {
  const Shape shape = random_shape();
  RC_PRE(check_shape(shape).has_value());
  RC_ASSERT(count_intersecting_pairs(make_shape(shape)) == 0);
}

RC_GTEST_PROP(TorusKnotShape, DoesNotIntersectItselfAtMaxTube, ()) {
  const auto [p, q] = *rc::gen::element(std::pair(1, 1), std::pair(2, 3), std::pair(3, 2), std::pair(1, 4),
                                        std::pair(5, 1), std::pair(5, 2), std::pair(3, 7), std::pair(8, 3));
  TorusKnotShape knot{
      1, 0.001, p, q, 12 * std::max(p, q) + *rc::gen::inRange(0, 50), *rc::gen::inRange(3, 12)};
  const Expected<Shape> too_wide = check_shape(TorusKnotShape{1, 1, p, q, knot.tubular, knot.radial});
  RC_ASSERT(!too_wide.has_value());
  knot.tube = std::stod(too_wide.error().expected.substr(std::string("at most ").size()));
  RC_ASSERT(check_shape(knot).has_value());
  RC_ASSERT(count_intersecting_pairs(make_shape(knot)) == 0);
}

RC_GTEST_PROP(RockShape, StaysWithinRoughness, ()) {
  const RockShape rock{random_size(), *rc::gen::inRange<std::int32_t>(1, 24),
                       *rc::gen::inRange(0, 61) / 100.0, *rc::gen::arbitrary<std::uint64_t>()};
  const TriangleMesh mesh = make_shape(rock);
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    const double height = mesh.vertex(static_cast<std::int32_t>(i)).norm() / rock.radius;
    RC_ASSERT(std::abs(height - 1.0) <= rock.roughness + 2.0 * kFloat32);
  }
}

}  // namespace
}  // namespace buoyancy

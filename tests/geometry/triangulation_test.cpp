#include "geometry/triangulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "geometry/exact_predicates.h"
#include "tests/geometry/sample_meshes.h"

namespace buoyancy {
namespace {

using Places = std::vector<Vec3>;

struct Result {
  TriangleMesh mesh;
  PolygonSplit split;
};

Result split_polygon(const Places& places) {
  Result result;
  std::vector<std::int32_t> corners;
  for (const Vec3& place : places) corners.push_back(result.mesh.add_vertex(place));
  Polygons polygons;
  polygons.add(corners);
  result.split = triangulate(polygons, result.mesh);
  return result;
}

Vec3 area_vector(const Places& places) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < places.size(); ++i) sum += places[i].cross(places[(i + 1) % places.size()]);
  return 0.5 * sum;
}

Vec3 area_vector(const TriangleMesh& mesh, const Triangle& face) {
  return 0.5 *
         (mesh.vertex(face[1]) - mesh.vertex(face[0])).cross(mesh.vertex(face[2]) - mesh.vertex(face[0]));
}

Vec3 area_vector(const TriangleMesh& mesh) {
  Vec3 sum = Vec3::Zero();
  for (const Triangle& face : mesh.triangles) sum += area_vector(mesh, face);
  return sum;
}

double least_share_along(const TriangleMesh& mesh, const Vec3& direction) {
  double least = std::numeric_limits<double>::infinity();
  for (const Triangle& face : mesh.triangles) least = std::min(least, area_vector(mesh, face).dot(direction));
  return least;
}

// The directed edges that no opposite edge matches.
std::multiset<std::pair<std::int32_t, std::int32_t>> rim(const TriangleMesh& mesh) {
  std::multiset<std::pair<std::int32_t, std::int32_t>> edges;
  for (const Triangle& face : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::pair<std::int32_t, std::int32_t> edge{face[i], face[(i + 1) % 3]};
      const auto opposite = edges.find({edge.second, edge.first});
      if (opposite != edges.end()) {
        edges.erase(opposite);
      } else {
        edges.insert(edge);
      }
    }
  }
  return edges;
}

// Requires that the triangles have the polygon's own edges as their rim.
void expect_rim_of_polygon(const TriangleMesh& mesh, std::size_t corners) {
  std::multiset<std::pair<std::int32_t, std::int32_t>> expected;
  for (std::size_t i = 0; i < corners; ++i) {
    expected.insert({static_cast<std::int32_t>(i), static_cast<std::int32_t>((i + 1) % corners)});
  }
  EXPECT_EQ(rim(mesh), expected);
}

bool cross_or_touch(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                    const Eigen::Vector2d& d) {
  const auto within = [](const Eigen::Vector2d& p, const Eigen::Vector2d& q, const Eigen::Vector2d& r) {
    return (r - p).dot(r - q) <= 0.0;
  };
  const int ab_c = orient_2d(a, b, c);
  const int ab_d = orient_2d(a, b, d);
  const int cd_a = orient_2d(c, d, a);
  const int cd_b = orient_2d(c, d, b);
  if (ab_c * ab_d < 0 && cd_a * cd_b < 0) return true;
  return (ab_c == 0 && within(a, b, c)) || (ab_d == 0 && within(a, b, d)) || (cd_a == 0 && within(c, d, a)) ||
         (cd_b == 0 && within(c, d, b));
}

using Outline = std::vector<Eigen::Vector2d>;

// A random simple polygon on a small grid, with many collinear corners, by removing crossings; empty if that
// does not end.
Outline random_outline(std::mt19937& random, std::size_t corners) {
  std::uniform_int_distribution<int> coordinate(0, 7);
  std::set<std::pair<int, int>> taken;
  while (taken.size() < corners) taken.insert({coordinate(random), coordinate(random)});
  Outline outline;
  for (const auto& [x, y] : taken) outline.emplace_back(x, y);
  std::shuffle(outline.begin(), outline.end(), random);
  const std::size_t n = outline.size();
  for (int round = 0; round < 200; ++round) {
    bool is_simple = true;
    for (std::size_t i = 0; i + 1 < n; ++i) {
      for (std::size_t j = i + 1; j < n; ++j) {
        const bool is_next = j == i + 1;
        const bool is_last = i == 0 && j == n - 1;
        if (is_last) continue;
        const Eigen::Vector2d& a = outline[i];
        const Eigen::Vector2d& b = outline[i + 1];
        const Eigen::Vector2d& c = outline[j];
        const Eigen::Vector2d& d = outline[(j + 1) % n];
        const bool is_bad =
            is_next ? orient_2d(a, b, d) == 0 && (a - b).dot(d - b) > 0.0 : cross_or_touch(a, b, c, d);
        if (!is_bad) continue;
        is_simple = false;
        std::reverse(outline.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                     outline.begin() + static_cast<std::ptrdiff_t>(j) + (is_next ? 2 : 1) -
                         (is_next && j + 1 == n ? 1 : 0));
      }
    }
    const bool closes_badly = orient_2d(outline[n - 2], outline[n - 1], outline[0]) == 0 &&
                              (outline[n - 2] - outline[n - 1]).dot(outline[0] - outline[n - 1]) > 0.0;
    const bool starts_badly = orient_2d(outline[n - 1], outline[0], outline[1]) == 0 &&
                              (outline[n - 1] - outline[0]).dot(outline[1] - outline[0]) > 0.0;
    if (is_simple && !closes_badly && !starts_badly) return outline;
    if (is_simple) std::shuffle(outline.begin(), outline.end(), random);
  }
  return {};
}

double signed_area(const Outline& outline) {
  double sum = 0.0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d& a = outline[i];
    const Eigen::Vector2d& b = outline[(i + 1) % outline.size()];
    sum += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  return sum;
}

// Into the plane of u and v through `origin`; exact for small whole numbers.
Places placed(const Outline& outline, const Vec3& origin, const Vec3& u, const Vec3& v) {
  Places places;
  for (const Eigen::Vector2d& point : outline) places.emplace_back(origin + point.x() * u + point.y() * v);
  return places;
}

TEST(Triangulation, KeepsTrianglesAsTheyAre) {
  TriangleMesh mesh;
  for (int i = 0; i < 5; ++i) mesh.add_vertex({1.0 * i, 1.0 * i * i, 0.0});
  Polygons polygons;
  polygons.add(std::array<std::int32_t, 3>{2, 1, 0});
  polygons.add(std::array<std::int32_t, 3>{3, 3, 0});
  polygons.add(std::array<std::int32_t, 3>{4, 2, 1});
  const PolygonSplit split = triangulate(polygons, mesh);
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{2, 1, 0}, {3, 3, 0}, {4, 2, 1}}));
  EXPECT_EQ(split.polygons, 0);
}

TEST(Triangulation, KeepsCollinearCorners) {
  const Places rectangle{{0, 0, 0},    {4, 0, 0},     {4, 3, 0},     {3.9, 3, 0}, {2.5, 3, 0},
                         {1.25, 3, 0}, {1.125, 3, 0}, {0.0, 3.0, 0}, {0.0, 2, 0}};
  for (std::size_t start = 0; start < rectangle.size(); ++start) {
    Places turned = rectangle;
    std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(start), turned.end());
    const Result result = split_polygon(turned);
    EXPECT_EQ(result.mesh.triangles.size(), 7U);
    EXPECT_GT(least_share_along(result.mesh, Vec3::UnitZ()), 0.0);
    EXPECT_NEAR(area_vector(result.mesh).z(), 12.0, 1e-14);
    expect_rim_of_polygon(result.mesh, turned.size());
  }
}

TEST(Triangulation, SplitsSimplePlanarPolygonsWithoutFolds) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> range(-3, 3);
  const auto whole = [&] { return static_cast<double>(range(random)); };
  const auto whole_vector = [&] { return Vec3{whole(), whole(), whole()}; };
  int tried = 0;
  for (int i = 0; i < 4000; ++i) {
    const Outline outline = random_outline(random, 4 + static_cast<std::size_t>(i) % 20);
    const Vec3 u = whole_vector();
    const Vec3 v = whole_vector();
    if (outline.empty() || u.cross(v).isZero()) continue;
    ++tried;
    const Places places = placed(outline, whole_vector(), u, v);
    const Result result = split_polygon(places);
    const Vec3 expected = signed_area(outline) * u.cross(v);
    EXPECT_EQ(result.split.non_planar, 0);
    EXPECT_EQ(result.mesh.vertex_count(), places.size());
    ASSERT_EQ(result.mesh.triangles.size(), places.size() - 2);
    EXPECT_GT(least_share_along(result.mesh, expected), 0.0) << i;
    EXPECT_LT((area_vector(result.mesh) - expected).norm(), 1e-9);
    EXPECT_NEAR(volume_of(result.mesh), places[0].dot(expected) / 3.0, 1e-9);
    expect_rim_of_polygon(result.mesh, places.size());
  }
  EXPECT_GT(tried, 1000);
}

TEST(Triangulation, KeepsAreaVectorOfPolygonsThatCrossThemselves) {
  std::mt19937 random(2);
  std::uniform_int_distribution<int> range(0, 5);
  const auto whole = [&] { return static_cast<double>(range(random)); };
  for (int i = 0; i < 2000; ++i) {
    Places places;
    for (int corner = 0; corner < 4 + i % 12; ++corner) places.push_back({whole(), whole(), 2.0});
    const Result result = split_polygon(places);
    EXPECT_EQ(result.split.non_planar, 0);
    EXPECT_LT((area_vector(result.mesh) - area_vector(places)).norm(), 1e-12);
    EXPECT_NEAR(volume_of(result.mesh), 2.0 * area_vector(places).z() / 3.0, 1e-12);
  }
}

TEST(Triangulation, CountsCornersAtOnePlaceOnce) {
  const Result quad = split_polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}});
  EXPECT_EQ(quad.mesh.triangles.size(), 2U);
  EXPECT_NEAR(area_vector(quad.mesh).z(), 1.0, 1e-15);
  const Result triangle = split_polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 0}});
  EXPECT_EQ(triangle.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
  EXPECT_EQ(split_polygon({{0, 0, 0}, {0, 0, 0}, {1, 1, 0}, {1, 1, 0}}).mesh.triangles.size(), 1U);
}

TEST(Triangulation, SplitsCornersOnALineIntoAFan) {
  const Result result = split_polygon({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {5, 5, 5}, {3, 3, 3}});
  EXPECT_EQ(result.split.non_planar, 0);
  EXPECT_EQ(result.mesh.triangles.size(), 3U);
  expect_rim_of_polygon(result.mesh, 5);
}

TEST(Triangulation, GivesNonPlanarPolygonsAVertexAtTheirMean) {
  const Places quad{{0, 0, 0}, {2, 0, 0.5}, {2, 1, 0}, {0, 1, 0.25}};
  const Result result = split_polygon(quad);
  EXPECT_EQ(result.split.polygons, 1);
  EXPECT_EQ(result.split.non_planar, 1);
  EXPECT_EQ(result.split.centers, 1);
  ASSERT_EQ(result.mesh.vertex_count(), 5U);
  EXPECT_EQ(result.mesh.vertex(4), Vec3(1, 0.5, 0.1875));
  EXPECT_EQ(result.mesh.triangles, (std::vector<Triangle>{{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}));
  const auto with = [&quad](std::vector<Triangle> triangles) {
    TriangleMesh mesh;
    for (const Vec3& place : quad) mesh.add_vertex(place);
    mesh.triangles = std::move(triangles);
    return volume_of(mesh);
  };
  const double one = with({{0, 1, 2}, {0, 2, 3}});
  const double other = with({{0, 1, 3}, {1, 2, 3}});
  EXPECT_NEAR(volume_of(result.mesh), 0.5 * (one + other), 1e-15);
  EXPECT_NEAR(result.split.split_volume, std::abs(one - other), 1e-15);
  // The plane amid the corners is parallel to both diagonals.
  const Vec3 normal = (quad[2] - quad[0]).cross(quad[3] - quad[1]).normalized();
  EXPECT_NEAR(result.split.largest_distance, 0.5 * std::abs(normal.dot(quad[1] - quad[0])), 1e-15);
}

TEST(Triangulation, TakesPolygonsFlatToAMillionthOfTheirSizeAsPlanar) {
  const double size = std::sqrt(1'000.0 * 1'000.0 + 1'000.0 * 1'000.0);
  for (const double share : {0.9e-6, 1.1e-6}) {
    const double height =
        2.0 * share * size;  // of a corner: a quarter of it below, a quarter above the plane
    const Result result =
        split_polygon({{0, 0, 0}, {1'000, 0, 2.0 * height}, {1'000, 1'000, 0}, {0, 1'000, 0}});
    EXPECT_EQ(result.split.non_planar, share > 1e-6 ? 1 : 0) << share;
    EXPECT_EQ(result.mesh.triangles.size(), share > 1e-6 ? 4U : 2U);
  }
}

TEST(Triangulation, FindsExtremeSplitsOfPentagons) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> height(-0.3, 0.3);
  for (int i = 0; i < 100; ++i) {
    Places places;
    for (int corner = 0; corner < 5; ++corner) {
      const double angle = 2.0 * M_PI * corner / 5.0;
      places.emplace_back(std::cos(angle), std::sin(angle), height(random));
    }
    // Each of the five triangulations is the fan from one corner.
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (std::int32_t apex = 0; apex < 5; ++apex) {
      TriangleMesh mesh;
      for (const Vec3& place : places) mesh.add_vertex(place);
      for (std::int32_t k = 1; k < 4; ++k) {
        mesh.triangles.push_back({apex, (apex + k) % 5, (apex + k + 1) % 5});
      }
      least = std::min(least, volume_of(mesh));
      most = std::max(most, volume_of(mesh));
    }
    EXPECT_NEAR(split_polygon(places).split.split_volume, most - least, 1e-14);
  }
}

// The corners of the triangles, without the order of the triangles and of the corners in each.
std::multiset<std::vector<std::array<double, 3>>> coordinates(const TriangleMesh& mesh, const Vec3& signs) {
  std::multiset<std::vector<std::array<double, 3>>> all;
  for (const Triangle& face : mesh.triangles) {
    std::vector<std::array<double, 3>> corners;
    for (const std::int32_t v : face) {
      const Vec3 place = mesh.vertex(v).cwiseProduct(signs) + Vec3::Zero();  // no negative zero
      corners.push_back({place.x(), place.y(), place.z()});
    }
    std::sort(corners.begin(), corners.end());
    all.insert(corners);
  }
  return all;
}

TEST(Triangulation, MirrorsNonPlanarPolygonsBitForBit) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> radius(0.1, 3.0);
  std::uniform_real_distribution<double> height(-1.0, 1.0);
  for (int i = 0; i < 1000; ++i) {
    const int corners = 4 + i % 9;
    Places places;
    for (int corner = 0; corner < corners; ++corner) {
      const double angle = 2.0 * M_PI * corner / corners;
      const double r = radius(random);
      places.emplace_back(100.0 + r * std::cos(angle), r * std::sin(angle), -7.0 + height(random));
    }
    const Vec3 signs(i % 2 == 0 ? -1 : 1, i % 3 == 0 ? -1 : 1, i % 5 == 0 ? -1 : 1);
    Places mirrored;
    for (const Vec3& place : places) mirrored.emplace_back(place.cwiseProduct(signs));
    if (signs.prod() < 0.0) std::reverse(mirrored.begin(), mirrored.end());
    std::rotate(mirrored.begin(), mirrored.begin() + i % corners, mirrored.end());
    const Result one = split_polygon(places);
    const Result other = split_polygon(mirrored);
    EXPECT_EQ(one.split.centers, other.split.centers);
    EXPECT_EQ(coordinates(one.mesh, Vec3::Ones()), coordinates(other.mesh, signs)) << i;
    EXPECT_EQ(one.split.largest_distance, other.split.largest_distance);
  }
}

TEST(Triangulation, SplitsNonPlanarPolygonsThatHideCornersWithoutFolds) {
  // A U whose mean lies between its arms.
  const Places u_shape{{0, 0, 0},   {6, 0, 0.1}, {6, 9, 0},   {5, 9, 0.1},
                       {5, 1, 0.2}, {1, 1, 0},   {1, 9, 0.1}, {0, 9, 0}};
  const Result result = split_polygon(u_shape);
  EXPECT_EQ(result.split.non_planar, 1);
  EXPECT_EQ(result.split.centers, 0);
  EXPECT_EQ(result.mesh.triangles.size(), 6U);
  EXPECT_GT(least_share_along(result.mesh, Vec3::UnitZ()), 0.0);
}

TEST(Triangulation, SplitsPolygonsOfExtremeSizeAndPosition) {
  for (const double scale : {1e-160, 1e-80, 1e-30, 1e30, 1e120, 1e300}) {
    const Result quad =
        split_polygon({{0, 0, 0}, {scale, 0, 0.1 * scale}, {scale, scale, 0}, {0, scale, -0.3 * scale}});
    EXPECT_GE(quad.mesh.triangles.size(), 2U);
    for (std::size_t v = 0; v < quad.mesh.vertex_count(); ++v) {
      EXPECT_TRUE(quad.mesh.vertex(static_cast<std::int32_t>(v)).allFinite()) << scale;
    }
  }
}

// 100,000 corners each: with an exhaustive search for every ear these would take hours.
class LargePolygons : public testing::TestWithParam<int> {};

Outline large_outline(int kind) {
  constexpr int kCorners = 100'000;
  Outline outline;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> radius(0.01, 1.0);
  switch (kind) {
    case 0:  // a circle
      for (int i = 0; i < kCorners; ++i) {
        const double angle = 2.0 * M_PI * i / kCorners;
        outline.emplace_back(std::cos(angle), std::sin(angle));
      }
      break;
    case 1:  // a star with teeth of random length
      for (int i = 0; i < kCorners; ++i) {
        const double angle = 2.0 * M_PI * i / kCorners;
        const double r = radius(random);
        outline.emplace_back(r * std::cos(angle), r * std::sin(angle));
      }
      break;
    case 2:  // a comb of long teeth
      for (int i = 0; i < kCorners - 2; ++i) outline.emplace_back(i, i % 2 == 0 ? 1.0 : 100'000.0);
      outline.emplace_back(kCorners, 0.0);
      outline.emplace_back(-1.0, 0.0);
      std::reverse(outline.begin(), outline.end());
      break;
    case 3: {  // a spiral: a strip of width 1 that winds 500 times
      constexpr double kTurn = 2.0 * M_PI / 100.0;
      for (int i = 0; i < kCorners / 2; ++i) {
        const double r = 10.0 + 2.0 * i / 100.0;
        outline.emplace_back(r * std::cos(kTurn * i), r * std::sin(kTurn * i));
      }
      for (int i = kCorners / 2; i-- > 0;) {
        const double r = 9.0 + 2.0 * i / 100.0;
        outline.emplace_back(r * std::cos(kTurn * i), r * std::sin(kTurn * i));
      }
      break;
    }
    case 4:  // a triangle with all but two corners along one edge
      for (int i = 0; i < kCorners - 1; ++i) outline.emplace_back(i, 0.0);
      outline.emplace_back(0.0, 1.0);
      break;
    default:  // crosses itself everywhere
      for (int i = 0; i < kCorners; ++i) outline.push_back({radius(random), radius(random)});
  }
  return outline;
}

TEST_P(LargePolygons, AreSplitInBoundedTime) {
  const Outline outline = large_outline(GetParam());
  const Places places = placed(outline, Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY());
  const Result result = split_polygon(places);
  ASSERT_EQ(result.mesh.triangles.size(), places.size() - 2);
  const double area = signed_area(outline);
  EXPECT_NEAR(area_vector(result.mesh).z(), area, 1e-9 * std::max(1.0, std::abs(area)));
  const bool is_cut_off = GetParam() == 1;  // the needles take too many steps: the rest becomes a fan
  if (GetParam() < 5 && !is_cut_off) {
    EXPECT_GT(least_share_along(result.mesh, area * Vec3::UnitZ()), 0.0);
  }
  expect_rim_of_polygon(result.mesh, places.size());
}

INSTANTIATE_TEST_SUITE_P(Triangulation, LargePolygons, testing::Range(0, 6));

}  // namespace
}  // namespace buoyancy

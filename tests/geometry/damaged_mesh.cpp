#include "tests/geometry/damaged_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "geometry/shapes.h"
#include "tests/geometry/sample_meshes.h"

namespace buoyancy {
namespace {

// std::mt19937_64 gives the same numbers everywhere; the standard's distributions do not.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  std::size_t below(std::size_t n) { return static_cast<std::size_t>(engine_() % n); }
  bool chance(double share) { return between(0.0, 1.0) < share; }
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11U) * 0x1p-53;
  }
  Vec3 vector(double low, double high) {
    Vec3 v;
    for (const int i : {2, 1, 0}) v[i] = between(low, high);
    return v;
  }

 private:
  std::mt19937_64 engine_;
};

using Edge = std::pair<std::int32_t, std::int32_t>;

// Star-shaped about the origin, so that a fan from any rim to the origin lies inside.
TriangleMesh star_shaped(Random& random) {
  switch (random.below(4)) {
    case 0:
      return make_shape(RockShape{1.0, static_cast<std::int32_t>(2 + random.below(5)), 0.3,
                                  static_cast<std::uint64_t>(random.below(1000))});
    case 1:
      return make_shape(BoxShape{.size = {2, 1, 0.5},
                                 .segments = {static_cast<std::int32_t>(1 + random.below(4)),
                                              static_cast<std::int32_t>(1 + random.below(3)), 2}});
    case 2:
      return make_shape(SphereShape{0.7, static_cast<std::int32_t>(6 + 2 * random.below(5))});
    default:
      return make_shape(CylinderShape{.radius = 0.5,
                                      .height = 2,
                                      .segments = static_cast<std::int32_t>(5 + random.below(12)),
                                      .stacks = static_cast<std::int32_t>(1 + random.below(3))});
  }
}

// Turns the mesh anywhere, so that its coordinates are no round numbers, or leaves it where it is.
TriangleMesh placed(TriangleMesh mesh, Random& random) {
  if (random.chance(0.3)) return mesh;
  const double z = random.between(0.1, 1);
  const Vec3 wxy = random.vector(-1, 1);
  const Eigen::Quaterniond turn(wxy[0], wxy[1], wxy[2], z);
  const Vec3 shift = random.vector(-3, 3);
  return moved_mesh(std::move(mesh), turn.normalized().toRotationMatrix(), shift);
}

std::size_t any_face(const TriangleMesh& mesh, Random& random) {
  return random.below(mesh.triangles.size());
}

// Divides one side of a face, but not of its neighbour. beside: the new vertex' distance from the side [m],
// away from the rest of the face if it is below 0.
void split_edge(TriangleMesh& mesh, Random& random, double beside) {
  const std::size_t f = any_face(mesh, random);
  const auto [a, b, c] = mesh.triangles[f];
  const Vec3 from = mesh.vertex(a);
  const Vec3 along = mesh.vertex(b) - from;
  const Vec3 on_edge = from + random.between(0.1, 0.9) * along;
  Vec3 inward = mesh.vertex(c) - on_edge;
  inward -= inward.dot(along) / along.squaredNorm() * along;
  const std::int32_t m = mesh.add_vertex(on_edge + beside * inward.normalized());
  mesh.triangles[f] = {a, m, c};
  mesh.triangles.push_back({m, b, c});
}

void turn_faces(TriangleMesh& mesh, Random& random) {
  const std::size_t most = std::max<std::size_t>(1, mesh.triangles.size() / 5);
  for (std::size_t i = 0; i < most; ++i) {
    if (!random.chance(0.5)) continue;
    Triangle& face = mesh.triangles[any_face(mesh, random)];
    std::swap(face[0], face[1]);
  }
}

void store_faces_twice(TriangleMesh& mesh, Random& random) {
  const std::size_t copies = 1 + random.below(8);
  for (std::size_t i = 0; i < copies; ++i) {
    Triangle copy = mesh.triangles[any_face(mesh, random)];
    std::rotate(copy.begin(), copy.begin() + static_cast<std::ptrdiff_t>(random.below(3)), copy.end());
    if (random.chance(0.5)) std::swap(copy[0], copy[1]);
    mesh.triangles.push_back(copy);
  }
}

// Stores every face for both sides, or all faces twice.
void store_everything_twice(TriangleMesh& mesh, Random& random) {
  const bool back = random.chance(0.5);
  const std::size_t faces = mesh.triangles.size();
  for (std::size_t f = 0; f < faces; ++f) {
    Triangle copy = mesh.triangles[f];
    if (back) std::swap(copy[0], copy[1]);
    mesh.triangles.push_back(copy);
  }
}

// Adds a deck over the rim of some connected faces, with its middle at `center`, which must see the whole rim
// from inside. Returns false if the rim touches itself.
bool add_deck(TriangleMesh& mesh, Random& random, const Vec3& center) {
  std::map<Edge, std::size_t> face_at;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    for (std::size_t side = 0; side < 3; ++side)
      face_at[{mesh.triangles[f][side], mesh.triangles[f][(side + 1) % 3]}] = f;
  }
  std::set<std::size_t> patch{any_face(mesh, random)};
  const std::size_t size = 1 + random.below(mesh.triangles.size() / 2);
  std::vector<std::size_t> front(patch.begin(), patch.end());
  for (std::size_t i = 0; i < front.size() && patch.size() < size; ++i) {
    const Triangle face = mesh.triangles[front[i]];
    for (std::size_t side = 0; side < 3; ++side) {
      const std::size_t neighbour = face_at.at({face[(side + 1) % 3], face[side]});
      if (patch.size() < size && patch.insert(neighbour).second) front.push_back(neighbour);
    }
  }
  std::map<std::int32_t, std::int32_t> next;
  for (const std::size_t f : patch) {
    for (std::size_t side = 0; side < 3; ++side) {
      const std::int32_t from = mesh.triangles[f][side];
      const std::int32_t to = mesh.triangles[f][(side + 1) % 3];
      if (patch.count(face_at.at({to, from})) > 0) continue;
      if (!next.try_emplace(from, to).second) return false;
    }
  }
  if (next.size() < 3) return false;
  std::size_t loop = 0;
  for (std::int32_t v = next.begin()->first; loop == 0 || v != next.begin()->first; v = next.at(v)) ++loop;
  if (loop != next.size()) return false;
  const std::int32_t middle = mesh.add_vertex(center);
  for (const auto& [from, to] : next) {
    mesh.triangles.push_back(random.chance(0.8) ? Triangle{from, to, middle} : Triangle{to, from, middle});
  }
  return true;
}

// Leaves a triangle open within face f. Returns its area.
double add_hole(TriangleMesh& mesh, std::size_t f, double leg) {
  const auto [a, b, c] = mesh.triangles[f];
  const Vec3 middle = (mesh.vertex(a) + mesh.vertex(b) + mesh.vertex(c)) / 3.0;
  std::array<std::int32_t, 3> inner{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 corner = mesh.vertex(mesh.triangles[f][i]);
    const double share = std::min(0.5, leg / (corner - middle).norm());
    inner[i] = mesh.add_vertex(middle + share * (corner - middle));
  }
  mesh.triangles[f] = {a, b, inner[0]};
  for (const Triangle& piece : {Triangle{b, inner[1], inner[0]},
                                {b, c, inner[1]},
                                {c, inner[2], inner[1]},
                                {c, a, inner[2]},
                                {a, inner[0], inner[2]}}) {
    mesh.triangles.push_back(piece);
  }
  const Vec3 p = mesh.vertex(inner[0]);
  return 0.5 * (mesh.vertex(inner[1]) - p).cross(mesh.vertex(inner[2]) - p).norm();
}

void add_plate(TriangleMesh& mesh, Random& random, const BoundingBox& box) {
  const Vec3 corner = box.max_B + Vec3::Constant(0.1 + random.between(0.0, 1.0));
  const double u_y = random.between(0, 1);
  const Vec3 u(random.between(0.1, 1), u_y, 0);
  const double v_z = random.between(0.1, 1);
  const Vec3 v(0, random.between(0.1, 1), v_z);
  const std::int32_t a = mesh.add_vertex(corner);
  const std::int32_t b = mesh.add_vertex(corner + u);
  const std::int32_t c = mesh.add_vertex(corner + v);
  mesh.triangles.push_back({a, b, c});
  if (random.chance(0.5)) mesh.triangles.push_back({a, c, b});
}

// Gives each face vertices of its own, up to `apart` from each other [m].
TriangleMesh with_cracks(const TriangleMesh& mesh, Random& random, double apart) {
  TriangleMesh soup = unwelded(mesh);
  for (auto* coordinates : {&soup.x, &soup.y, &soup.z}) {
    for (double& coordinate : *coordinates) coordinate += random.between(-0.25, 0.25) * apart;
  }
  return soup;
}

TriangleMesh shuffled(TriangleMesh mesh, Random& random) {
  for (std::size_t i = mesh.triangles.size(); i > 1; --i)
    std::swap(mesh.triangles[i - 1], mesh.triangles[random.below(i)]);
  return mesh;
}

}  // namespace

DamagedMesh make_damaged_mesh(std::uint64_t seed) {
  Random random(seed);
  DamagedMesh result;
  const TriangleMesh shape = star_shaped(random);
  TriangleMesh with_deck = shape;
  const bool has_deck =
      random.chance(0.3) && add_deck(with_deck, random, Vec3(0, 0, random.between(-0.02, 0.02)));
  const Random before_placement = random;
  result.clean = placed(shape, random);
  random = before_placement;
  result.damaged = placed(has_deck ? with_deck : shape, random);
  if (has_deck) result.damage += "deck; ";
  TriangleMesh& mesh = result.damaged;
  const double size = bounding_box(result.clean).diagonal();

  if (random.chance(0.15)) {
    const TriangleMesh other =
        moved_mesh(make_shape(BoxShape{.size = {1, 1, 1}}), Mat3::Identity(), Vec3(20, 0, 0));
    result.clean = joined(result.clean, other);
    mesh = joined(mesh, other);
    result.damage += "second part; ";
  }
  const double tolerance = 1e-6 * bounding_box(result.clean).diagonal();
  if (random.chance(0.3)) {
    const bool large = random.chance(0.2);
    const std::size_t holes = 1 + random.below(large ? 1 : 3);
    for (std::size_t i = 0; i < holes; ++i) {
      const double leg = large ? 0.3 * size : size * std::pow(10.0, random.between(-5.0, -3.0));
      result.missing_bulge +=
          0.376 * std::pow(add_hole(mesh, random.below(shape.triangles.size()), leg), 1.5);
    }
    result.damage += std::to_string(holes) + (large ? " large" : "") + " holes; ";
  }
  if (random.chance(0.5)) {
    const std::size_t splits = 1 + random.below(10);
    const bool beside = random.chance(0.3);
    for (std::size_t i = 0; i < splits; ++i)
      split_edge(mesh, random, beside ? random.between(-0.7, 0.7) * tolerance : 0.0);
    result.moved = result.moved || beside;
    result.damage += std::to_string(splits) + (beside ? " needles dropped; " : " edges split; ");
  }
  if (random.chance(0.15)) {
    store_everything_twice(mesh, random);
    result.damage += "stored twice; ";
  } else if (random.chance(0.3)) {
    store_faces_twice(mesh, random);
    result.damage += "duplicates; ";
  }
  if (random.chance(0.3)) {
    turn_faces(mesh, random);
    result.damage += "turned faces; ";
  }
  if (random.chance(0.2)) {
    add_plate(mesh, random, bounding_box(mesh));
    result.damage += "plate; ";
  }
  if (random.chance(0.2)) {
    mesh = with_cracks(mesh, random, 0.3e-6 * size);
    result.moved = true;
    result.damage += "cracks; ";
  } else if (random.chance(0.3)) {
    mesh = unwelded(mesh);
    result.damage += "soup; ";
  }
  mesh = shuffled(std::move(mesh), random);
  return result;
}

}  // namespace buoyancy

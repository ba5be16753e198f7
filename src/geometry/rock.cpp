// The rock: an icosphere whose radius is perturbed by gradient noise. All arithmetic is +, -, *, / and sqrt,
// in a fixed order, on doubles derived from integers, so that every machine gives the same bits.
#include <algorithm>
#include <cmath>

#include "geometry/shape_generators.h"

namespace buoyancy {
namespace {

struct Direction {
  double x, y, z;
};

Direction normalised(double x, double y, double z) {
  const double length = std::sqrt(x * x + y * y + z * z);
  return {x / length, y / length, z / length};
}

// Returns the twelve corners of the icosahedron: the cyclic permutations of (0, +-1, +-phi).
std::array<Direction, 12> icosahedron_corners() {
  const double phi = (1.0 + std::sqrt(5.0)) / 2.0;
  return {{{0, 1, phi},
           {0, -1, phi},
           {0, 1, -phi},
           {0, -1, -phi},
           {1, phi, 0},
           {-1, phi, 0},
           {1, -phi, 0},
           {-1, -phi, 0},
           {phi, 0, 1},
           {phi, 0, -1},
           {-phi, 0, 1},
           {-phi, 0, -1}}};
}

constexpr std::array<Triangle, 20> kIcosahedronFaces{
    {{0, 1, 8}, {0, 8, 4}, {0, 4, 5}, {0, 5, 10}, {0, 10, 1},  {1, 6, 8},   {8, 6, 9},
     {8, 9, 4}, {4, 9, 2}, {4, 2, 5}, {5, 2, 11}, {5, 11, 10}, {10, 11, 7}, {10, 7, 1},
     {1, 7, 6}, {3, 9, 6}, {3, 2, 9}, {3, 11, 2}, {3, 7, 11},  {3, 6, 7}}};

// A 64-bit mixing function (G. Steele et al., "Fast splittable pseudorandom number generators", OOPSLA 2014).
std::uint64_t mixed(std::uint64_t bits) {
  bits += 0x9e3779b97f4a7c15U;
  bits = (bits ^ (bits >> 30U)) * 0xbf58476d1ce4e5b9U;
  bits = (bits ^ (bits >> 27U)) * 0x94d049bb133111ebU;
  return bits ^ (bits >> 31U);
}

// Gradient noise (K. Perlin, "Improving noise", SIGGRAPH 2002); gradients come from a hash of the lattice
// point.
class GradientNoise {
 public:
  explicit GradientNoise(std::uint64_t seed) : seed_(seed) {}

  // Returns a value from -1 to 1: each of the eight terms is at most |gradient| |offset|, and their weighted
  // sum is at most sqrt(2) sqrt(3/4).
  double at(double x, double y, double z) const {
    const double x0 = std::floor(x);
    const double y0 = std::floor(y);
    const double z0 = std::floor(z);
    const std::array<double, 3> offset{x - x0, y - y0, z - z0};
    const std::array<double, 3> weight{fade(offset[0]), fade(offset[1]), fade(offset[2])};
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      const int i = corner & 1;
      const int j = (corner >> 1) & 1;
      const int k = (corner >> 2) & 1;
      const double share = (i == 1 ? weight[0] : 1.0 - weight[0]) * (j == 1 ? weight[1] : 1.0 - weight[1]) *
                           (k == 1 ? weight[2] : 1.0 - weight[2]);
      sum += share * slope(x0 + i, y0 + j, z0 + k, offset[0] - i, offset[1] - j, offset[2] - k);
    }
    return sum / std::sqrt(1.5);
  }

 private:
  // 6 t^5 - 15 t^4 + 10 t^3 rises from 0 to 1; its first two derivatives vanish at both ends.
  static double fade(double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }

  // Returns offset . gradient; the lattice point's gradient is one of the 12 permutations of (+-1, +-1, 0).
  double slope(double lattice_x, double lattice_y, double lattice_z, double dx, double dy, double dz) const {
    std::uint64_t bits = seed_;
    for (const double coordinate : {lattice_x, lattice_y, lattice_z}) {
      bits = mixed(bits ^ static_cast<std::uint64_t>(static_cast<std::int64_t>(coordinate)));
    }
    const std::uint64_t which = bits % 12;
    const double first = which < 8 ? dx : dy;
    const double second = which < 4 ? dy : dz;
    return ((which & 1U) != 0 ? -first : first) + ((which & 2U) != 0 ? -second : second);
  }

  std::uint64_t seed_;
};

// The inner vertices of the icosahedron's 30 edges, each created once.
class EdgeVertices {
 public:
  explicit EdgeVertices(std::int32_t frequency) : inner_(frequency - 1) {}

  std::int32_t& first(std::int32_t from, std::int32_t to) {
    return first_[static_cast<std::size_t>(std::min(from, to))][static_cast<std::size_t>(std::max(from, to))];
  }
  // Returns vertex number `step` (1 .. frequency - 1) on the edge from one corner to the other.
  std::int32_t at(std::int32_t from, std::int32_t to, std::int32_t step) {
    return first(from, to) + (from < to ? step - 1 : inner_ - step);
  }

 private:
  std::int32_t inner_;
  std::array<std::array<std::int32_t, 12>, 12> first_{};  // indexed by lower and higher corner
};

}  // namespace

Vec3 rock_surface_point(const RockShape& rock, const Vec3& direction) {
  const Direction u = normalised(direction.x(), direction.y(), direction.z());
  const GradientNoise noise(rock.seed);
  double height = 0.0;
  double frequency = 1.5;
  for (const double amplitude : {4.0 / 7.0, 2.0 / 7.0, 1.0 / 7.0}) {
    height += amplitude * noise.at(frequency * u.x, frequency * u.y, frequency * u.z);
    frequency *= 2.0;
  }
  const double radius = rock.radius * (1.0 + rock.roughness * height);
  return {radius * u.x, radius * u.y, radius * u.z};
}

TriangleMesh generate(const RockShape& rock) {
  const std::int32_t n = rock.frequency;
  const std::array<Direction, 12> corners = icosahedron_corners();
  const auto corner = [&](std::int32_t i) { return corners[static_cast<std::size_t>(i)]; };

  TriangleMesh mesh;
  const auto add = [&](double x, double y, double z) {
    return mesh.add_vertex(rock_surface_point(rock, {x, y, z}));
  };
  for (const Direction& at : corners) add(at.x, at.y, at.z);

  EdgeVertices edges(n);
  for (const Triangle& face : kIcosahedronFaces) {
    for (std::size_t side = 0; side < 3; ++side) {
      const std::int32_t from = face[side];
      const std::int32_t to = face[(side + 1) % 3];
      if (from > to) continue;  // the neighbouring face has this edge from its lower corner
      edges.first(from, to) = static_cast<std::int32_t>(mesh.vertex_count());
      for (std::int32_t step = 1; step < n; ++step) {
        const double there = step;
        const double here = n - step;
        add(here * corner(from).x + there * corner(to).x, here * corner(from).y + there * corner(to).y,
            here * corner(from).z + there * corner(to).z);
      }
    }
  }

  std::vector<std::vector<std::int32_t>> rows(static_cast<std::size_t>(n) + 1);
  for (const auto& [a, b, c] : kIcosahedronFaces) {
    // Row i holds i + 1 vertices, from edge ab to edge ac.
    for (std::int32_t i = 0; i <= n; ++i) {
      std::vector<std::int32_t>& row = rows[static_cast<std::size_t>(i)];
      row.clear();
      for (std::int32_t j = 0; j <= i; ++j) {
        if (i == 0) {
          row.push_back(a);
        } else if (j == 0) {
          row.push_back(i == n ? b : edges.at(a, b, i));
        } else if (j == i) {
          row.push_back(i == n ? c : edges.at(a, c, i));
        } else if (i == n) {
          row.push_back(edges.at(b, c, j));
        } else {
          const double of_a = n - i;
          const double of_b = i - j;
          const double of_c = j;
          row.push_back(add(of_a * corner(a).x + of_b * corner(b).x + of_c * corner(c).x,
                            of_a * corner(a).y + of_b * corner(b).y + of_c * corner(c).y,
                            of_a * corner(a).z + of_b * corner(b).z + of_c * corner(c).z));
        }
      }
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        mesh.triangles.push_back({rows[i][j], rows[i + 1][j], rows[i + 1][j + 1]});
        if (j < i) mesh.triangles.push_back({rows[i][j], rows[i + 1][j + 1], rows[i][j + 1]});
      }
    }
  }
  return mesh;
}

}  // namespace buoyancy

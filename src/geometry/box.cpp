#include "geometry/shape_generators.h"

namespace buoyancy {
namespace {

// Numbers the surface vertices of an a x b x c lattice: full layers at bottom and top, rims in between.
class SurfaceLattice {
 public:
  SurfaceLattice(std::int32_t a, std::int32_t b, std::int32_t c) : a_(a), b_(b), c_(c) {}

  std::int32_t index(std::int32_t i, std::int32_t j, std::int32_t k) const {
    const std::int32_t layer = (a_ + 1) * (b_ + 1);
    const std::int32_t rim = 2 * (a_ + b_);
    if (k == 0) return in_layer(i, j);
    if (k == c_) return layer + (c_ - 1) * rim + in_layer(i, j);
    return layer + (k - 1) * rim + on_rim(i, j);
  }

 private:
  std::int32_t in_layer(std::int32_t i, std::int32_t j) const { return j * (a_ + 1) + i; }
  // Counts in the order in which vertices are added: the full first and last rows, both ends of the others.
  std::int32_t on_rim(std::int32_t i, std::int32_t j) const {
    if (j == 0) return i;
    if (j == b_) return (a_ + 1) + 2 * (b_ - 1) + i;
    return (a_ + 1) + 2 * (j - 1) + (i == 0 ? 0 : 1);
  }

  std::int32_t a_, b_, c_;
};

// Returns coordinate i of n + 1 from -size/2 to size/2; the coordinates of i and n - i are exact opposites.
double coordinate(double size, std::int32_t i, std::int32_t n) {
  return size * (2 * i - n) / (2.0 * n);
}

}  // namespace

TriangleMesh generate(const BoxShape& box) {
  const auto [a, b, c] = box.segments;
  TriangleMesh mesh;
  for (std::int32_t k = 0; k <= c; ++k) {
    for (std::int32_t j = 0; j <= b; ++j) {
      const bool full_row = k == 0 || k == c || j == 0 || j == b;
      for (std::int32_t i = 0; i <= a; i += full_row ? 1 : a) {
        mesh.add_vertex(
            {coordinate(box.size[0], i, a), coordinate(box.size[1], j, b), coordinate(box.size[2], k, c)});
      }
    }
  }

  // The two faces normal to axis w are grids along u and v, where u x v = w.
  const SurfaceLattice lattice(a, b, c);
  for (std::size_t w = 0; w < 3; ++w) {
    const std::size_t u = (w + 1) % 3;
    const std::size_t v = (w + 2) % 3;
    for (const bool positive : {false, true}) {
      const auto at = [&](std::int32_t along_u, std::int32_t along_v) {
        std::array<std::int32_t, 3> index{};
        index[w] = positive ? box.segments[w] : 0;
        index[u] = along_u;
        index[v] = along_v;
        return lattice.index(index[0], index[1], index[2]);
      };
      for (std::int32_t i = 0; i < box.segments[u]; ++i) {
        for (std::int32_t j = 0; j < box.segments[v]; ++j) {
          const std::int32_t p00 = at(i, j);
          const std::int32_t p10 = at(i + 1, j);
          const std::int32_t p11 = at(i + 1, j + 1);
          const std::int32_t p01 = at(i, j + 1);
          if (positive) {
            mesh.triangles.push_back({p00, p10, p11});
            mesh.triangles.push_back({p00, p11, p01});
          } else {
            mesh.triangles.push_back({p00, p11, p10});
            mesh.triangles.push_back({p00, p01, p11});
          }
        }
      }
    }
  }
  return mesh;
}

}  // namespace buoyancy

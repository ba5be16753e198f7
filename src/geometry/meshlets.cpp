#include "geometry/meshlets.h"

#include <algorithm>
#include <utility>

namespace buoyancy {
namespace {

// Inserts two zero bits between any two of the lowest 21 bits (G. M. Morton, 1966).
std::uint64_t spread_bits(std::uint64_t bits) {
  bits = (bits | bits << 32U) & 0x001f00000000ffffU;
  bits = (bits | bits << 16U) & 0x001f0000ff0000ffU;
  bits = (bits | bits << 8U) & 0x100f00f00f00f00fU;
  bits = (bits | bits << 4U) & 0x10c30c30c30c30c3U;
  return (bits | bits << 2U) & 0x1249249249249249U;
}

// Returns the triangles' indices along a Morton curve, which scaling by a power of two does not change.
std::vector<std::uint32_t> spatial_order(const TriangleMesh& mesh) {
  const BoundingBox box = bounding_box(mesh);
  const double extent = (box.max_B - box.min_B).maxCoeff();
  std::vector<std::pair<std::uint64_t, std::uint32_t>> coded;
  coded.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    std::uint64_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double center = (mesh.vertex(a)[axis] - box.min_B[axis]) / 3.0 +
                            (mesh.vertex(b)[axis] - box.min_B[axis]) / 3.0 +
                            (mesh.vertex(c)[axis] - box.min_B[axis]) / 3.0;
      const double share = center / extent;  // NaN if the extent is 0 or infinite
      constexpr double kMax = 2'097'151.0;   // 21 bits
      const auto cell = share > 0.0 ? static_cast<std::uint64_t>(std::min(share, 1.0) * kMax) : 0;
      code |= spread_bits(cell) << static_cast<unsigned>(axis);
    }
    coded.emplace_back(code, static_cast<std::uint32_t>(coded.size()));
  }
  std::sort(coded.begin(), coded.end());
  std::vector<std::uint32_t> order;
  order.reserve(coded.size());
  for (const auto& [code, triangle] : coded) order.push_back(triangle);
  return order;
}

// Fills one meshlet after another.
class Builder {
 public:
  explicit Builder(const TriangleMesh& mesh) : mesh_(mesh), places_(mesh.vertex_count()) {}

  void add(const Triangle& triangle) {
    const auto is_new = [&](std::int32_t vertex) { return place(vertex).meshlet != current_; };
    const auto new_vertices =
        static_cast<std::size_t>(std::count_if(triangle.begin(), triangle.end(), is_new));
    if (vertices_.size() + new_vertices > Meshlets::kMaxVertices ||
        triangles_.size() == kGroupTriangles * Meshlets::kMaxGroups) {
      close();
    }
    std::array<std::uint8_t, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      Place& at = place(triangle[i]);
      if (at.meshlet != current_) {
        at = {current_, static_cast<std::uint8_t>(4 * vertices_.size())};
        vertices_.push_back(triangle[i]);
      }
      corners[i] = at.corner;
    }
    triangles_.push_back(corners);
  }

  Meshlets finish() {
    if (!triangles_.empty()) close();
    for (std::vector<double>* coordinate : {&result_.x, &result_.y, &result_.z}) coordinate->shrink_to_fit();
    result_.groups.shrink_to_fit();
    result_.meshlets.shrink_to_fit();
    return std::move(result_);
  }

 private:
  struct Place {
    std::uint32_t meshlet = 0;  // the last one that got the vertex, plus 1
    std::uint8_t corner = 0;    // as in CornerGroup
  };

  Place& place(std::int32_t vertex) { return places_[static_cast<std::size_t>(vertex)]; }

  void close() {
    while (vertices_.size() % 4 != 0) vertices_.push_back(vertices_.back());
    while (triangles_.size() % kGroupTriangles != 0) triangles_.push_back({0, 0, 0});
    result_.meshlets.push_back({.first_vertex = static_cast<std::uint32_t>(result_.x.size()),
                                .first_group = static_cast<std::uint32_t>(result_.groups.size()),
                                .vertices = static_cast<std::uint32_t>(vertices_.size()),
                                .groups = static_cast<std::uint32_t>(triangles_.size() / kGroupTriangles)});
    for (const std::int32_t vertex : vertices_) {
      const Vec3 point = mesh_.vertex(vertex);
      result_.x.push_back(point.x());
      result_.y.push_back(point.y());
      result_.z.push_back(point.z());
    }
    for (std::size_t first = 0; first < triangles_.size(); first += kGroupTriangles) {
      CornerGroup group;
      for (std::size_t i = 0; i < kGroupTriangles; ++i) {
        group.a[i] = triangles_[first + i][0];
        group.b[i] = triangles_[first + i][1];
        group.c[i] = triangles_[first + i][2];
        for (const std::uint8_t corner : triangles_[first + i])
          group.vertices |= std::uint64_t{1} << (corner / 4U);
      }
      result_.groups.push_back(group);
    }
    vertices_.clear();
    triangles_.clear();
    ++current_;
  }

  const TriangleMesh& mesh_;
  std::vector<Place> places_;  // per vertex of the mesh
  std::uint32_t current_ = 1;
  std::vector<std::int32_t> vertices_;                  // of the current meshlet
  std::vector<std::array<std::uint8_t, 3>> triangles_;  // of the current meshlet
  Meshlets result_;
};

}  // namespace

std::size_t Meshlets::bytes() const {
  return 3 * x.size() * sizeof(double) + groups.size() * sizeof(CornerGroup) +
         meshlets.size() * sizeof(Meshlet);
}

Meshlets build_meshlets(const TriangleMesh& mesh) {
  Builder builder(mesh);
  for (const std::uint32_t i : spatial_order(mesh)) builder.add(mesh.triangles[i]);
  return builder.finish();
}

}  // namespace buoyancy

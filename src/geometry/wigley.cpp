#include "geometry/shape_generators.h"

namespace buoyancy {
namespace {

// The vertex grid of the hull: stations from stern to stem, levels from the keel (0) to the waterplane and
// the deck. At both ends and at the keel the beam is 0 and both sides share a vertex on the centre plane.
class HullGrid {
 public:
  HullGrid(const WigleyShape& hull, TriangleMesh& mesh)
      : stations_(hull.segments + 1), levels_(hull.levels + 2) {
    for (std::int32_t level = 0; level < levels_; ++level) {
      const bool deck = level == levels_ - 1;
      const double zeta = deck ? 0.0 : static_cast<double>(level - hull.levels) / hull.levels;
      const double z = deck ? hull.freeboard : hull.draft * zeta;
      for (std::int32_t station = 0; station < stations_; ++station) {
        const double xi = static_cast<double>(2 * station - hull.segments) / hull.segments;
        const double x = 0.5 * hull.length * xi;
        const double y = 0.5 * hull.beam * (1.0 - xi * xi) * (1.0 - zeta * zeta);
        const bool on_center_plane = level == 0 || station == 0 || station == stations_ - 1;
        const std::int32_t port = mesh.add_vertex({x, on_center_plane ? 0.0 : y, z});
        port_.push_back(port);
        starboard_.push_back(on_center_plane ? port : mesh.add_vertex({x, -y, z}));
      }
    }
  }

  std::int32_t port(std::int32_t station, std::int32_t level) const { return port_[index(station, level)]; }
  std::int32_t starboard(std::int32_t station, std::int32_t level) const {
    return starboard_[index(station, level)];
  }
  std::int32_t deck() const { return levels_ - 1; }

 private:
  std::size_t index(std::int32_t station, std::int32_t level) const {
    return static_cast<std::size_t>(level) * static_cast<std::size_t>(stations_) +
           static_cast<std::size_t>(station);
  }

  std::int32_t stations_, levels_;
  std::vector<std::int32_t> port_, starboard_;
};

}  // namespace

TriangleMesh generate(const WigleyShape& hull) {
  TriangleMesh mesh;
  const HullGrid grid(hull, mesh);

  for (std::int32_t level = 0; level < grid.deck(); ++level) {
    for (std::int32_t station = 0; station < hull.segments; ++station) {
      // Every diagonal leans away from the nearer end. Where the keel meets the ends, three of a cell's four
      // vertices lie on the centre plane; the other diagonal would make them a triangle of both sides.
      const bool aft = 2 * station < hull.segments;
      const auto add_cell = [&](std::int32_t p00, std::int32_t p10, std::int32_t p11, std::int32_t p01) {
        if (aft) {
          mesh.triangles.push_back({p00, p10, p11});
          mesh.triangles.push_back({p00, p11, p01});
        } else {
          mesh.triangles.push_back({p00, p10, p01});
          mesh.triangles.push_back({p10, p11, p01});
        }
      };
      add_cell(grid.starboard(station, level), grid.starboard(station + 1, level),
               grid.starboard(station + 1, level + 1), grid.starboard(station, level + 1));
    }
  }
  // The port side is the starboard side's mirror image.
  const std::size_t starboard_triangles = mesh.triangles.size();
  std::vector<std::int32_t> mirror(mesh.vertex_count());
  for (std::int32_t level = 0; level <= grid.deck(); ++level) {
    for (std::int32_t station = 0; station <= hull.segments; ++station) {
      mirror[static_cast<std::size_t>(grid.starboard(station, level))] = grid.port(station, level);
    }
  }
  for (std::size_t t = 0; t < starboard_triangles; ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    mesh.triangles.push_back({mirror[static_cast<std::size_t>(a)], mirror[static_cast<std::size_t>(c)],
                              mirror[static_cast<std::size_t>(b)]});
  }

  const std::int32_t deck = grid.deck();
  for (std::int32_t station = 0; station < hull.segments; ++station) {
    const std::int32_t starboard_aft = grid.starboard(station, deck);
    const std::int32_t starboard_fore = grid.starboard(station + 1, deck);
    const std::int32_t port_fore = grid.port(station + 1, deck);
    const std::int32_t port_aft = grid.port(station, deck);
    if (starboard_fore != port_fore) mesh.triangles.push_back({starboard_aft, starboard_fore, port_fore});
    if (starboard_aft != port_aft) mesh.triangles.push_back({starboard_aft, port_fore, port_aft});
  }
  return mesh;
}

}  // namespace buoyancy

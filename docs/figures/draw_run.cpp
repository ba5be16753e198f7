// Draws a scene's bodies in the water as an SVG strip, one picture for each time asked for, from the poses of
// a run that buoyancy-client --csv wrote.
//
//   draw_run [--from-ahead] SCENE RUN_CSV OUTPUT.svg SECONDS...
//
// Orthographic, seen from above the water: what is above it can hide, but never be hidden by, what is below,
// so the two are painted one after the other, each back to front. The triangles are cut at the water by the
// very clip that the solvers use. In waves, the surface is that of the run's time, shaded.
//
// --from-ahead: against the x axis instead, with the water's surface as a line, as stability is drawn: the
// run's force where it acts, the centre of mass, and the metacentre at that pose. Up has to be +z.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "hydrostatics/hydrostatics.h"
#include "hydrostatics/triangle_clip.h"
#include "scene/scene.h"
#include "waves/sea_snapshot.h"

namespace buoyancy {
namespace {

constexpr double kPanel = 300.0;   // width and height of one picture, in SVG units
constexpr double kHeight = 0.84;   // of the panel, as a share of its width
constexpr double kHorizon = 0.57;  // where the water's middle is, likewise
constexpr double kCaption = 26.0;

struct Row {
  double seconds = 0.0;
  std::int32_t body_id = 0;
  Pose pose;
  Vec3 force_W = Vec3::Zero();               // N
  Vec3 center_of_buoyancy_W = Vec3::Zero();  // m, relative to the pose's position
};

std::vector<Row> read_run(const char* path) {
  std::ifstream file(path);
  std::map<std::string, std::size_t> column;
  std::vector<Row> rows;
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream stream(line);
    std::vector<std::string> cells;
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    if (column.empty()) {
      for (std::size_t i = 0; i < cells.size(); ++i) column[cells[i]] = i;
      continue;
    }
    const auto number = [&](const char* name) {
      return std::strtod(cells.at(column.at(name)).c_str(), nullptr);
    };
    rows.push_back(Row{number("utime") * 1e-6, static_cast<std::int32_t>(number("body_id")),
                       Pose{Vec3(number("px"), number("py"), number("pz")),
                            Eigen::Quaterniond(number("qw"), number("qx"), number("qy"), number("qz"))},
                       Vec3(number("fx"), number("fy"), number("fz")),
                       Vec3(number("bx"), number("by"), number("bz"))});
  }
  return rows;
}

struct View {
  double azimuth, elevation;           // rad
  double size;                         // of the bodies, as a share of the panel
  double ambient;                      // light from everywhere, 0 to 1
  std::array<double, 3> above, below;  // colours of what is above and below the water
  bool from_ahead;
};
constexpr View kFromAbove{-0.6, 0.33, 0.56, 0.35, {1.0, 0.80, 0.16}, {0.44, 0.65, 0.62}, false};
constexpr View kFromAhead{-0.5 * std::numbers::pi, 0.0, 0.72, 0.6, {0.98, 0.90, 0.76},
                          {0.62, 0.80, 0.90},      true};

// World to picture: x to the right, y up the picture, z towards the eye.
Mat3 camera(const View& view) {
  return (Eigen::AngleAxisd(view.elevation - 0.5 * std::numbers::pi, Vec3::UnitX()) *
          Eigen::AngleAxisd(view.azimuth, Vec3::UnitZ()))
      .toRotationMatrix();
}

// The water's surface at one time.
class Surface {
 public:
  Surface(const Scene& scene, double seconds) : water_(scene.water()) {
    if (scene.sea() == nullptr) return;
    waves_.emplace(*scene.sea());
    waves_->set_time(std::llround(seconds * 1e6));
  }

  bool is_plane() const { return !waves_; }
  const Water& water() const { return water_; }
  // [m], over the level, at the place above or below p_W.
  double elevation(const Vec3& p_W) const {
    if (!waves_) return 0.0;
    const HorizontalAxes& axes = waves_->sea().axes();
    return waves_->elevation(axes.e1_W.dot(p_W), axes.e2_W.dot(p_W));
  }

 private:
  Water water_;
  std::optional<SeaSnapshot> waves_;
};

struct Facet {
  std::array<Vec3, 3> corners;  // in the picture's axes
  double light = 0.0;           // that falls on it, 0 to 1
};

// What is to be painted, in the picture's axes: facets that face the eye, and where the water's surface meets
// the bodies.
struct Layers {
  std::vector<Facet> below, above;
  std::vector<std::pair<Vec3, Vec3>> waterline;
};

void add_facet(const ClipVertex<double>& a, const ClipVertex<double>& b, const ClipVertex<double>& c,
               std::vector<Facet>& layer) {
  Facet facet{{a.y.vec3(), b.y.vec3(), c.y.vec3()}, 0.0};
  const Vec3 normal = (facet.corners[1] - facet.corners[0]).cross(facet.corners[2] - facet.corners[0]);
  if (normal.z() <= 0.0) return;  // turned away from the eye
  const Vec3 light = Vec3(-0.45, 0.65, 0.62).normalized();
  facet.light = std::max(0.0, normal.normalized().dot(light));
  layer.push_back(facet);
}

// Adds the part of a triangle that is wet by its corners' heights; all of it, some or nothing.
void add_wet_part(const std::array<ClipVertex<double>, 3>& corner, std::vector<Facet>& layer) {
  const auto wet = std::count_if(corner.begin(), corner.end(), [](const auto& c) { return c.wet(); });
  if (wet == 3) add_facet(corner[0], corner[1], corner[2], layer);
  if (wet == 0 || wet == 3) return;
  for_each_wet_triangle(corner[0], corner[1], corner[2],
                        [&](const auto& a, const auto& b, const auto& c) { add_facet(a, b, c, layer); });
}

void add_body(const Body& body, const Pose& pose, const Surface& surface, const Mat3& camera,
              Layers& layers) {
  const HydrostaticMesh& mesh = body.prepared_mesh->mesh;
  const WaterPlane plane = water_plane_in_body(pose, surface.water(), mesh.center_B);
  const Mat3 R_WB = pose.q_WB.normalized().toRotationMatrix();
  std::vector<double> heights(mesh.surface.vertex_count());
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const Vec3 y = mesh.vertex(static_cast<std::int32_t>(i));
    heights[i] = plane.height(y) - surface.elevation(pose.p_WB + R_WB * (mesh.center_B + y));
  }
  const Mat3 R = camera * R_WB;
  const Vec3 p = camera * pose.p_WB + R * mesh.center_B;
  for (const Triangle& triangle : mesh.surface.triangles) {
    std::array<ClipVertex<double>, 3> corner;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 y = mesh.vertex(triangle[i]);
      corner[i] = {Point<double>::from(R * y + p), heights[static_cast<std::size_t>(triangle[i])]};
    }
    add_wet_part(corner, layers.below);
    std::vector<Vec3> cut_points;
    for (std::size_t i = 0; i < 3; ++i) {
      const ClipVertex<double>& from = corner[i];
      const ClipVertex<double>& to = corner[(i + 1) % 3];
      if (from.wet() != to.wet())
        cut_points.push_back((from.wet() ? intersect_edge(from, to) : intersect_edge(to, from)).y.vec3());
    }
    if (cut_points.size() == 2) layers.waterline.emplace_back(cut_points[0], cut_points[1]);
    for (ClipVertex<double>& c : corner)
      c.z = -c.z;  // the part above the water is the wet part of the mirrored world
    add_wet_part(corner, layers.above);
  }
}

void sort_back_to_front(std::vector<Facet>& facets) {
  const auto depth = [](const Facet& f) { return f.corners[0].z() + f.corners[1].z() + f.corners[2].z(); };
  std::sort(facets.begin(), facets.end(),
            [&](const Facet& a, const Facet& b) { return depth(a) < depth(b); });
}

// One picture: the camera's axes scaled to the panel, in tenths of an SVG unit so that coordinates are short.
class Panel {
 public:
  Panel(std::FILE* file, double scale, const Vec3& water) : file_(file), scale_(scale), water_(water) {}

  void facets(const std::vector<Facet>& facets, const std::array<double, 3>& colour, double ambient) const {
    for (const Facet& f : facets) {
      const double shade = ambient + (1.0 - ambient) * f.light;
      std::array<int, 3> c{};
      for (std::size_t i = 0; i < 3; ++i)
        c[i] = static_cast<int>(std::lround(255.0 * std::min(1.0, colour[i] * shade)));
      const auto& [p, q, r] = f.corners;
      std::fprintf(file_, "<path color=\"#%02x%02x%02x\" d=\"M%d %dL%d %d %d %dz\"/>\n", c[0], c[1], c[2],
                   x(p), y(p), x(q), y(q), x(r), y(r));
    }
  }
  void lines(const std::vector<std::pair<Vec3, Vec3>>& lines) const {
    for (const auto& [from, to] : lines) {
      std::fprintf(file_, "<path d=\"M%d %dL%d %d\"/>\n", x(from), y(from), x(to), y(to));
    }
  }
  int x(const Vec3& point) const { return tenths(0.5 * kPanel + scale_ * (point.x() - water_.x())); }
  int y(const Vec3& point) const { return tenths(kHorizon * kPanel - scale_ * (point.y() - water_.y())); }

 private:
  static int tenths(double value) { return static_cast<int>(std::lround(10.0 * value)); }

  std::FILE* file_;
  double scale_;
  Vec3 water_;  // the point of the water that is drawn in the middle
};

// A thin stroke in the facet's own colour closes the seams that anti-aliasing leaves between neighbours.
const char* const kFacets =
    "<g fill=\"currentColor\" stroke=\"currentColor\" stroke-width=\"5\" stroke-linejoin=\"round\">\n";

// The state of every body at the last row not later than `seconds`.
std::map<std::int32_t, Row> rows_at(const std::vector<Row>& rows, double seconds) {
  std::map<std::int32_t, Row> at;
  for (const Row& row : rows) {
    if (row.seconds <= seconds || at.count(row.body_id) == 0) at[row.body_id] = row;
  }
  return at;
}

// The water's surface: a round piece of it seen from above, or all below its line.
void draw_water(std::FILE* file, const Water& water, const View& view, const Panel& panel, double extent) {
  std::fputs("<path fill=\"#a9cfe3\" d=\"M", file);
  if (view.from_ahead) {
    const int surface = panel.y(camera(view) * (water.level * water.up_W));
    std::fprintf(file, "0 %dH%gV%gH0", surface, 10.0 * kPanel, 10.0 * kHeight * kPanel);
  } else {
    const Vec3 up = water.up_W;
    const Vec3 along = up.unitOrthogonal();
    const Vec3 across = up.cross(along);
    for (int i = 0; i < 64; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / 64;
      const Vec3 rim =
          camera(view) * (water.level * up + extent * (std::cos(angle) * along + std::sin(angle) * across));
      std::fprintf(file, "%d %d ", panel.x(rim), panel.y(rim));
    }
  }
  std::fputs("z\"/>\n", file);
}

// A round piece of the surface in waves, back to front, brighter where it faces the light.
void draw_waves(const Surface& surface, const View& view, const Panel& panel, double extent,
                std::FILE* file) {
  constexpr int kRings = 16;
  constexpr int kSectors = 48;
  const Vec3 up = surface.water().up_W;
  const Vec3 along = up.unitOrthogonal();
  const Vec3 across = up.cross(along);
  const Mat3 C = camera(view);
  const auto point = [&](int ring, int sector) -> ClipVertex<double> {
    const double angle = 2.0 * std::numbers::pi * sector / kSectors;
    const Vec3 p_W = surface.water().level * up +
                     extent * ring / kRings * (std::cos(angle) * along + std::sin(angle) * across);
    return {Point<double>::from(Vec3(C * (p_W + surface.elevation(p_W) * up))), 0.0};
  };
  std::vector<Facet> facets;
  for (int ring = 0; ring < kRings; ++ring) {
    for (int sector = 0; sector < kSectors; ++sector) {
      const auto inner = point(ring, sector);
      const auto outer = point(ring + 1, sector + 1);
      add_facet(inner, point(ring + 1, sector), outer, facets);
      if (ring > 0) add_facet(inner, outer, point(ring, sector + 1), facets);
    }
  }
  sort_back_to_front(facets);
  std::fputs(kFacets, file);
  panel.facets(facets, {0.72, 0.93, 1.08}, 0.2);
  std::fputs("</g>\n", file);
}

void draw_point(std::FILE* file, const Panel& panel, const Vec3& at, const char* colour, const char* letter) {
  std::fprintf(file,
               "<circle cx=\"%d\" cy=\"%d\" r=\"42\" fill=\"%s\" stroke=\"#fff\" stroke-width=\"12\"/>\n"
               "<text x=\"%d\" y=\"%d\" font-size=\"130\" font-weight=\"bold\" fill=\"%s\" stroke=\"#fff\" "
               "stroke-width=\"30\" paint-order=\"stroke\">%s</text>\n",
               panel.x(at), panel.y(at), colour, panel.x(at) + 75, panel.y(at) + 45, colour, letter);
}

// The force where it acts, the centre of mass and the metacentre of heeling about the length, and the line
// on which the latter lies over the centre of buoyancy.
void draw_balance(std::FILE* file, const Body& body, const Row& row, const Water& water, const View& view,
                  const Panel& panel, double metres_per_newton) {
  const auto state =
      hydrostatics(body.prepared_mesh->mesh, row.pose, water, body.reference_B, body.center_of_mass_B);
  if (!state || !body.center_of_mass_B) return;
  const Mat3 C = camera(view);
  const Vec3 buoyancy = C * (row.pose.p_WB + row.center_of_buoyancy_W);
  const Vec3 metacentre = C * (row.pose.p_WB + state->metacenters_W[0]);
  const Vec3 mass = C * (row.pose.p_WB + row.pose.q_WB.normalized() * *body.center_of_mass_B);
  const Vec3 tip = buoyancy + metres_per_newton * (C * row.force_W);
  std::fprintf(file,
               "<path d=\"M%d %dL%d %d\" stroke=\"#0072b2\" stroke-width=\"26\"/>\n"
               "<path d=\"M%d %dl-55 110h110z\" fill=\"#0072b2\"/>\n",
               panel.x(buoyancy), panel.y(buoyancy), panel.x(tip), panel.y(tip) + 90, panel.x(tip),
               panel.y(tip));
  draw_point(file, panel, buoyancy, "#0072b2", "B");
  draw_point(file, panel, mass, "#222222", "G");
  draw_point(file, panel, metacentre, "#b34700", "M");
}

void draw_panel(std::FILE* file, const Scene& scene, const std::map<std::int32_t, Row>& at, const View& view,
                const Panel& panel, double extent, double metres_per_newton) {
  const Surface surface(scene, at.empty() ? 0.0 : at.begin()->second.seconds);
  Layers layers;
  for (const auto& [id, row] : at) {
    if (const Body* body = scene.find(id)) add_body(*body, row.pose, surface, camera(view), layers);
  }
  sort_back_to_front(layers.below);
  sort_back_to_front(layers.above);

  if (surface.is_plane() || view.from_ahead) {
    draw_water(file, scene.water(), view, panel, extent);
  } else {
    draw_waves(surface, view, panel, extent, file);
  }
  std::fputs(kFacets, file);
  panel.facets(layers.below, view.below, view.ambient);
  std::fputs("</g>\n<g stroke=\"#eaf6fb\" stroke-width=\"14\" stroke-linecap=\"round\">\n", file);
  panel.lines(layers.waterline);
  std::fputs("</g>\n", file);
  std::fputs(kFacets, file);
  panel.facets(layers.above, view.above, view.ambient);
  std::fputs("</g>\n", file);
  if (!view.from_ahead) return;
  for (const auto& [id, row] : at) {
    if (const Body* body = scene.find(id))
      draw_balance(file, *body, row, scene.water(), view, panel, metres_per_newton);
  }
}

// Across the picture: of the bounding box, and seen from ahead of what turns about the x axis.
double largest_width(const Scene& scene, const View& view) {
  double largest = 0.0;
  for (const Body& body : scene.bodies()) {
    const HydrostaticMesh& mesh = body.prepared_mesh->mesh;
    if (!view.from_ahead) {
      largest = std::max(largest, mesh.diagonal);
      continue;
    }
    for (std::size_t i = 0; i < mesh.surface.vertex_count(); ++i)
      largest = std::max(largest, 2.0 * mesh.vertex(static_cast<std::int32_t>(i)).tail<2>().norm());
  }
  return largest;
}

// rad, of the y axis over the water; 0 where the body is upright.
double heel(const Pose& pose, const Water& water) {
  return std::asin(std::clamp(water.up_W.dot(pose.q_WB.normalized() * Vec3::UnitY()), -1.0, 1.0));
}

int draw(const Scene& scene, const std::vector<Row>& rows, const char* path, const std::vector<double>& times,
         const View& view) {
  const double largest = largest_width(scene, view);
  const double scale = view.size * kPanel / largest;
  double largest_force = 0.0;
  for (const double seconds : times) {
    for (const auto& [id, row] : rows_at(rows, seconds))
      largest_force = std::max(largest_force, row.force_W.norm());
  }
  const double metres_per_newton = largest_force > 0.0 ? 0.5 * largest / largest_force : 0.0;

  std::FILE* file = std::fopen(path, "w");
  if (file == nullptr) return std::perror(path), 1;
  const double width = kPanel * static_cast<double>(times.size());
  const double height = kHeight * kPanel;
  const double captions = view.from_ahead ? 2.0 * kCaption : kCaption;
  std::fprintf(
      file,
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %g %g\" width=\"%g\" height=\"%g\" "
      "font-family=\"DejaVu Sans, sans-serif\" font-size=\"13\">\n<rect width=\"100%%\" height=\"100%%\" "
      "fill=\"#fff\"/>\n",
      width, height + captions, width, height + captions);
  const Panel panel(file, scale, camera(view) * (scene.water().level * scene.water().up_W));
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double left = kPanel * static_cast<double>(i);
    const std::map<std::int32_t, Row> at = rows_at(rows, times[i]);
    std::fprintf(file, "<svg x=\"%g\" width=\"%g\" height=\"%g\" viewBox=\"0 0 %g %g\">\n", left, kPanel,
                 height, 10.0 * kPanel, 10.0 * height);
    draw_panel(file, scene, at, view, panel, 0.85 * largest, metres_per_newton);
    std::fprintf(file, "</svg>\n<text x=\"%g\" y=\"%g\" text-anchor=\"middle\" fill=\"#444\">%g s",
                 left + 0.5 * kPanel, height + 0.6 * kCaption, times[i]);
    if (view.from_ahead && !at.empty())
      std::fprintf(file, ", heel %.1f°",
                   heel(at.begin()->second.pose, scene.water()) * 180.0 / std::numbers::pi);
    std::fputs("</text>\n", file);
  }
  if (view.from_ahead) {
    std::fprintf(
        file,
        "<text x=\"%g\" y=\"%g\" text-anchor=\"middle\" fill=\"#444\">B: centre of buoyancy, with the force; "
        "G: centre of mass; M: metacentre</text>\n",
        0.5 * width, height + 1.5 * kCaption);
  }
  std::fputs("</svg>\n", file);
  if (std::fclose(file) != 0) return std::perror(path), 1;
  return 0;
}

}  // namespace
}  // namespace buoyancy

int main(int argc, char** argv) {
  const bool from_ahead = argc > 1 && std::string(argv[1]) == "--from-ahead";
  const std::vector<std::string> arguments(argv + (from_ahead ? 2 : 1), argv + argc);
  if (arguments.size() < 4)
    return std::fputs("usage: draw_run [--from-ahead] SCENE RUN_CSV OUTPUT.svg SECONDS...\n", stderr), 2;
  const auto scene = buoyancy::Scene::load(arguments[0]);
  if (!scene) return std::fprintf(stderr, "draw_run: %s\n", scene.error().message().c_str()), 2;
  const auto rows = buoyancy::read_run(arguments[1].c_str());
  if (rows.empty()) return std::fprintf(stderr, "draw_run: %s: no rows\n", arguments[1].c_str()), 2;
  std::vector<double> times;
  for (std::size_t i = 3; i < arguments.size(); ++i)
    times.push_back(std::strtod(arguments[i].c_str(), nullptr));
  return buoyancy::draw(*scene, rows, arguments[2].c_str(), times,
                        from_ahead ? buoyancy::kFromAhead : buoyancy::kFromAbove);
}

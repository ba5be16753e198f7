#include "flotation/hydrostatic_table.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/angles.h"
#include "base/format.h"
#include "flotation/displaced_sum.h"
#include "hydrostatics/density_steps.h"
#include "hydrostatics/triangle_clip.h"

namespace buoyancy {
namespace {

double ratio(double value, double by) {
  return by != 0.0 ? value / by : kNaN;
}

}  // namespace

Expected<HydrostaticTable> HydrostaticTable::make(const FloatingBody& body, const Water& water,
                                                  const HydrostaticTableOptions& options) {
  HydrostaticTable table(body, water);
  table.axes_ = options.axes;
  table.knows_mass_ = options.knows_mass;
  const ShipAxes& axes = options.axes;
  const auto end_along = [&](const Vec3& direction) {
    return lowest_along(body, direction) + direction.dot(body.center_B());
  };
  table.keel_ = options.keel ? *options.keel : end_along(axes.up_B);
  const double aft = options.aft_perpendicular ? *options.aft_perpendicular : end_along(axes.forward_B);
  const double forward =
      options.forward_perpendicular ? *options.forward_perpendicular : -end_along(-axes.forward_B);
  table.midship_ = 0.5 * (aft + forward);
  table.lpp_ = forward - aft;
  for (const FloatingBody::SignedVolume& volume : body.volumes()) {
    table.waterplane_tolerance_ += 64.0 * std::numeric_limits<double>::epsilon() * volume.placed.mesh->area;
  }
  if (!std::isfinite(table.keel_) || !std::isfinite(table.lpp_) || !(table.lpp_ > 0.0)) {
    return make_error({.subject = "hydrostatic table",
                       .actual = "aft perpendicular " + format_shortest(aft) + " m, forward perpendicular " +
                                 format_shortest(forward) + " m, keel " + format_shortest(table.keel_) + " m",
                       .expected = "finite numbers, the aft perpendicular aft of the forward one",
                       .cause = "perpendiculars in the wrong order, or a forward axis that points aft",
                       .hint = "Exchange the perpendiculars or name another forward axis"});
  }
  table.cut_midship_section();
  return table;
}

void HydrostaticTable::cut_midship_section() {
  const Vec3& forward = axes_.forward_B;
  const Vec3 port = axes_.port_B();
  for (const FloatingBody::SignedVolume& volume : body_->volumes()) {
    const HydrostaticMesh& mesh = *volume.placed.mesh;
    const Vec3 center_B = body_->center_B() + volume.offset_B;
    const auto corner = [&](std::int32_t i) {
      const Vec3 x_B = center_B + volume.R_B * mesh.vertex(i);
      return ClipVertex<double>{Point<double>::from(Vec3(port.dot(x_B), axes_.up_B.dot(x_B), 0.0)),
                                forward.dot(x_B) - midship_};
    };
    for (const Triangle& triangle : mesh.surface.triangles) {
      const std::array<ClipVertex<double>, 3> corners{corner(triangle[0]), corner(triangle[1]),
                                                      corner(triangle[2])};
      unsigned aft = 0;
      for (unsigned i = 0; i < 3; ++i) aft |= corners[i].wet() ? 1U << i : 0U;
      if (aft == 0U || aft == 7U) continue;
      const std::size_t first = kOddOneOut[aft];
      const ClipVertex<double>& p = corners[first];
      const auto cut = [&](const ClipVertex<double>& other) {
        const ClipVertex<double> point = p.wet() ? intersect_edge(p, other) : intersect_edge(other, p);
        return Eigen::Vector2d(point.y.x, point.y.y);
      };
      SectionEdge edge{cut(corners[(first + 1) % 3]), cut(corners[(first + 2) % 3]),
                       volume.placed.signed_permeability};
      // The part aft of midship is counter-clockwise seen from outside; the section lies on its other side.
      if (p.wet()) std::swap(edge.from, edge.to);
      section_.push_back(edge);
    }
  }
}

// By Green's theorem, the area under water is the integral of the depth over the horizontal, along the wet
// edges.
double HydrostaticTable::immersed_section(double draft) const {
  const double level = keel_ + draft;
  double area = 0.0;
  for (const SectionEdge& edge : section_) {
    Eigen::Vector2d from = edge.from;
    Eigen::Vector2d to = edge.to;
    if (from.y() >= level && to.y() >= level) continue;
    const auto at_level = [&] {
      const double share = (level - from.y()) / (to.y() - from.y());
      return Eigen::Vector2d(from.x() + share * (to.x() - from.x()), level);
    };
    if (from.y() > level) {
      from = at_level();
    } else if (to.y() > level) {
      to = at_level();
    }
    area += edge.signed_permeability * 0.5 * ((level - from.y()) + (level - to.y())) * (to.x() - from.x());
  }
  return area;
}

std::optional<HydrostaticRow> HydrostaticTable::row(double draft, double trim) const {
  // The water plane goes through the point on the water at midship.
  const Vec3 up_B = up_at(axes_, {0.0, trim});
  const Vec3 on_water_B = midship_ * axes_.forward_B + (keel_ + draft) * axes_.up_B;
  const WaterPlane plane{.up_B = up_B, .h_c = up_B.dot(on_water_B - body_->center_B())};
  if (!std::isfinite(plane.h_c) || is_boundary_wet(*body_, plane)) return std::nullopt;
  DisplacedSum displaced = displaced_sum(*body_, plane, water_);
  const Vec3 forward_in_water = up_at(axes_, {0.0, trim + 0.5 * std::numbers::pi});
  Waterline line = waterline_sum(*body_, plane, forward_in_water, water_);
  double density = water_.density;
  if (!water_.layers.empty()) {
    const Water unlayered{.up_W = water_.up_W, .level = water_.level, .density = water_.density};
    const double volume = displaced_sum(*body_, plane, unlayered).volume;
    const double mean = mean_step(water_, displaced.volume, volume);
    density *= mean;
    displaced = {.volume = volume, .moment = displaced.moment / mean};
    for (double* integral : {&line.area, &line.u, &line.v, &line.uu, &line.uv, &line.vv}) *integral /= mean;
  }

  HydrostaticRow row;
  row.draft = draft;
  row.trim = trim;
  row.volume = displaced.volume;
  row.mass = density * row.volume;
  const bool displaces = row.volume > body_->volume_tolerance();
  const Vec3 center_B =
      displaces ? Vec3(body_->center_B() + displaced.moment / row.volume) : Vec3::Constant(kNaN);
  const Vec3 center = axes_.components(center_B);
  row.lcb = center.x() - midship_;
  row.tcb = center.y();
  row.kb = center.z() - keel_;

  const bool has_waterplane = line.area > waterplane_tolerance_;
  row.waterplane_area = has_waterplane ? line.area : 0.0;
  if (has_waterplane) {
    const Vec3 from_center = (line.u * forward_in_water + line.v * up_B.cross(forward_in_water)) / line.area;
    const Vec3 centroid_B = body_->center_B() + from_center + plane.h_c * up_B;
    row.lcf = axes_.forward_B.dot(centroid_B) - midship_;
    row.lwl = line.max_u - line.min_u;
    row.bwl = line.max_v - line.min_v;
  } else {
    row.lcf = kNaN;
  }
  const double about_length = has_waterplane ? line.vv - line.v * line.v / line.area : 0.0;
  const double about_beam = has_waterplane ? line.uu - line.u * line.u / line.area : 0.0;
  row.bm_t = displaces ? about_length / row.volume : kNaN;
  row.bm_l = displaces ? about_beam / row.volume : kNaN;
  row.km_t = row.kb + row.bm_t * std::cos(trim);
  row.km_l = row.kb + row.bm_l * std::cos(trim);
  const LiquidSum liquids = liquid_sum(*body_, plane.up_B, FreeSurfaces::kYes);
  const double kg = !knows_mass_ ? kNaN : axes_.up_B.dot(total_center_of_mass_B(*body_, liquids)) - keel_;
  // The virtual rise of the centre of mass by a free surface, times the displaced mass.
  const auto rise = [&](const Vec3& across) { return across.dot(liquids.free_surface * across); };
  row.mass_per_cm = 0.01 * density * row.waterplane_area;
  row.moment_per_cm = (row.mass * (row.km_l - kg) - rise(forward_in_water)) / (100.0 * lpp_);
  row.moment_per_degree =
      (row.mass * (row.km_t - kg) - rise(up_B.cross(forward_in_water))) * std::sin(kRadiansPerDegree);

  row.wetted_area = wetted_area_sum(*body_, plane);
  row.midship_area = immersed_section(draft);
  row.midship = ratio(row.midship_area, row.bwl * draft);
  const auto coefficients_on = [&](double length) {
    return FormCoefficients{.length = length,
                            .block = ratio(row.volume, length * row.bwl * draft),
                            .prismatic = ratio(row.volume, length * row.midship_area),
                            .waterplane = ratio(row.waterplane_area, length * row.bwl)};
  };
  row.on_lpp = coefficients_on(lpp_);
  row.on_lwl = coefficients_on(row.lwl);
  if (!std::isfinite(row.volume) || !std::isfinite(row.wetted_area)) return std::nullopt;
  return row;
}

}  // namespace buoyancy

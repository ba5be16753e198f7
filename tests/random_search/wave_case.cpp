#include "tests/random_search/wave_case.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>
#include <variant>

#include <Eigen/Geometry>

#include "base/format.h"
#include "geometry/shapes.h"
#include "tests/geometry/sample_meshes.h"
#include "waves/sea_snapshot.h"
#include "waves/wave_spectrum.h"

namespace buoyancy {
namespace {

constexpr double kPi = std::numbers::pi;

bool chance(RandomPoses& random, double probability) {
  return random.uniform(0.0, 1.0) < probability;
}

// Draws in a fixed order, which that of a product's factors is not.
double signed_log_uniform(RandomPoses& random, double low, double high) {
  const double magnitude = random.log_uniform(low, high);
  return random.pick(2) == 0 ? magnitude : -magnitude;
}
Vec3 random_offset(RandomPoses& random, double shortest, double longest) {
  const double length = random.log_uniform(shortest, longest);
  return length * random.direction();
}

std::int32_t rounded(double count, std::int32_t min) {
  return std::max(min, static_cast<std::int32_t>(std::lround(count)));
}

struct NamedMesh {
  const char* name;
  TriangleMesh mesh;
};

// Of about this many triangles.
NamedMesh random_shape(RandomPoses& random, double triangles) {
  switch (random.pick(9)) {
    case 0:
      return {"box",
              make_shape(BoxShape{{random.uniform(0.3, 1.0), random.uniform(0.3, 1.0), 1.0}, {1, 1, 1}})};
    case 1: {
      const std::int32_t n = rounded(std::sqrt(triangles / 12.0), 1);
      return {"fine box", make_shape(BoxShape{{1.0, random.uniform(0.3, 1.0), 1.0}, {n, n, n}})};
    }
    case 2:
      return {"sphere", make_shape(SphereShape{0.5, rounded(std::sqrt(triangles / 2.0), 3)})};
    case 3:
    case 4:
      return {"rock", make_shape(RockShape{0.5, rounded(std::sqrt(triangles / 20.0), 1),
                                           random.uniform(0.0, 0.6), random.pick(1U << 30U)})};
    case 5: {
      const std::int32_t radial = rounded(std::sqrt(triangles / 28.0), 3);
      return {"torus knot", make_shape(TorusKnotShape{.radius = 0.5,
                                                      .tube = random.uniform(0.03, 0.1),
                                                      .tubular = rounded(triangles / (2.0 * radial), 16),
                                                      .radial = radial})};
    }
    case 6: {
      const std::int32_t levels = rounded(std::sqrt(triangles / 16.0), 2);
      return {"Wigley hull", make_shape(WigleyShape{1.0, random.uniform(0.1, 0.3), random.uniform(0.05, 0.2),
                                                    random.uniform(0.02, 0.1), 4 * levels, levels})};
    }
    case 7: {
      const std::int32_t segments = rounded(std::sqrt(triangles / 2.0), 4);
      return {"cylinder", make_shape(CylinderShape{random.uniform(0.1, 0.5), 1.0, segments,
                                                   rounded(triangles / (2.0 * segments) - 1.0, 1)})};
    }
    default: {
      const std::int32_t segments = rounded(std::sqrt(triangles / 2.0), 4);
      return {"cone", make_shape(ConeShape{random.uniform(0.1, 0.5), 1.0, segments,
                                           rounded(triangles / (2.0 * segments), 1)})};
    }
  }
}

double wave_number_of(const WaveComponent& wave, double gravity) {
  return wave.angular_frequency * wave.angular_frequency / gravity;
}

// 4 standard deviations of the slope, or the sum over the components if that is less.
double steepness_of(const WaveComponents& waves, double gravity) {
  double sum = 0.0;
  double squares = 0.0;
  for (const WaveComponent& wave : waves) {
    const double slope = wave.amplitude * wave_number_of(wave, gravity);
    sum += slope;
    squares += 0.5 * slope * slope;
  }
  return std::min(sum, 4.0 * std::sqrt(squares));
}

// Frequencies are those of deep water until set_depth().
WaveComponents random_components(RandomPoses& random, std::size_t count, double shortest, double longest,
                                 double steepness, double gravity) {
  WaveComponents waves;
  for (std::size_t i = 0; i < count; ++i) {
    const double k = 2.0 * kPi / random.log_uniform(shortest, longest);
    waves.push_back({random.uniform(0.2, 1.0) / k, std::sqrt(gravity * k), random.uniform(-360.0, 360.0),
                     random.uniform(-360.0, 360.0)});
  }
  const double scale = steepness / steepness_of(waves, gravity);
  for (WaveComponent& wave : waves) wave.amplitude = std::min(scale * wave.amplitude, 4e3);
  return waves;
}

IrregularWaves random_irregular(RandomPoses& random, double length, double steepness, double gravity) {
  const double k = 2.0 * kPi / length;
  IrregularWaves waves;
  waves.peak_period = 2.0 * kPi / std::sqrt(gravity * k);
  // Close to what steepness_of() gives for the components.
  waves.significant_wave_height = std::min(0.7 * steepness / k, 4e3);
  if (random.pick(2) == 0) waves.gamma = random.uniform(1.0, 7.0);
  waves.direction = random.uniform(-180.0, 180.0);
  waves.spreading = random.log_uniform(1.0, 50.0);
  waves.directions = 5;
  waves.frequencies = 40;
  waves.cutoff = random.uniform(2.0, 4.0);
  waves.seed = random.pick(1U << 30U);
  return waves;
}

double sum_of_amplitudes(const WaveSystem& system) {
  double sum = 0.0;
  const auto add = [&sum](const WaveComponents& waves) {
    for (const WaveComponent& wave : waves) sum += wave.amplitude;
  };
  if (const auto* components = std::get_if<WaveComponents>(&system)) add(*components);
  if (const auto* irregular = std::get_if<IrregularWaves>(&system)) {
    // Equal amplitudes whose energy is that of the significant wave height.
    const double count = *irregular->frequencies * irregular->directions;
    sum += irregular->significant_wave_height / 4.0 * std::sqrt(2.0 * count);
  }
  return sum;
}

// Keeps the lengths of components in water of this depth. Irregular waves keep their periods, and get
// shorter.
void set_depth(SeaDescription& description, double depth, double gravity) {
  description.depth = depth;
  for (WaveSystem& system : description.systems) {
    if (auto* components = std::get_if<WaveComponents>(&system)) {
      for (WaveComponent& wave : *components) {
        const double k = wave_number_of(wave, gravity);
        wave.angular_frequency = std::sqrt(gravity * k * std::tanh(k * depth));
      }
    }
  }
}

void draw_sea(WaveRequest& request, double size, RandomPoses& random) {
  const double gravity = request.water.gravity;
  const double steepness = random.log_uniform(3e-3, 0.3);
  switch (random.pick(12)) {
    case 0:
    case 1:
    case 2:
      request.kind = SeaKind::kRegular;
      request.description.systems = {random_components(random, 1, size, 30.0 * size, steepness, gravity)};
      break;
    case 3:
    case 4:
    case 5:
      request.kind = SeaKind::kSeveral;
      request.description.systems = {
          random_components(random, 2 + random.pick(15), size, 40.0 * size, steepness, gravity)};
      break;
    case 6:
    case 7:
      request.kind = SeaKind::kIrregular;
      request.description.systems = {
          random_irregular(random, random.log_uniform(size, 30.0 * size), steepness, gravity)};
      break;
    case 8:
      request.kind = SeaKind::kShort;
      if (random.pick(4) == 0) {
        request.description.systems = {
            random_irregular(random, random.log_uniform(0.5 * size, size), steepness, gravity)};
      } else {
        const double shortest = random.log_uniform(size / 30.0, 0.8 * size);
        request.description.systems = {
            random_components(random, 1 + random.pick(4), shortest, size, steepness, gravity)};
      }
      break;
    case 9:
    case 10: {
      request.kind = SeaKind::kSteep;
      const double steepest = random.pick(5) == 0 ? 1.4 : 0.9;
      const double steep = random.uniform(0.3, steepest);
      request.description.systems = {
          random_components(random, 1 + random.pick(8), 0.5 * size, 20.0 * size, steep, gravity)};
      break;
    }
    default:
      request.kind = SeaKind::kLong;
      request.description.systems = {
          random_components(random, 1 + random.pick(4), 30.0 * size, 3000.0 * size, steepness, gravity)};
      break;
  }
  if (random.pick(4) == 0) {
    const double trough = sum_of_amplitudes(request.description.systems[0]);
    const double above_trough = random.log_uniform(1e-3, 2.0) * size;
    set_depth(request.description, trough * random.uniform(1.01, 1.5) + above_trough, gravity);
    if (random.pick(8) == 0) {
      // Some troughs reach the bed, where that is not refused.
      SeaDescription shallow = request.description;
      set_depth(shallow, trough * random.uniform(0.2, 1.0), gravity);
      if (Sea::make(shallow, request.water)) request.description = shallow;
    }
  }
  if (random.pick(4) == 0) request.description.pressure = WavePressure::kHydrostatic;
}

void draw_time(WaveRequest& request, RandomPoses& random) {
  switch (random.pick(4)) {
    case 0:
      request.utime = static_cast<std::int64_t>(random.uniform(-1e9, 1e9));
      break;
    case 1:
      request.utime = 0;
      break;
    default:
      request.utime = 1'790'000'000'000'000 + static_cast<std::int64_t>(random.uniform(0.0, 1e14));
  }
  if (random.pick(3) == 0) {
    request.description.time_origin = request.utime + static_cast<std::int64_t>(random.uniform(-1e10, 1e10));
  }
  if (random.pick(2) == 0) request.lead_time = random.uniform(-0.01, 0.1);
  if (random.pick(10) == 0) {
    // Somewhere on the ramp, at times before or after it.
    request.description.ramp = random.log_uniform(1.0, 1e4);
    const double t = random.uniform(-0.1, 1.2) * request.description.ramp;
    request.description.time_origin = request.utime - static_cast<std::int64_t>(1e6 * t);
  }
}

Eigen::Quaterniond random_orientation(RandomPoses& random) {
  if (random.pick(4) > 0) return random.rotation();
  Eigen::Quaterniond q = random.quarter_turns();
  if (random.pick(2) == 0) {
    const double tilt = random.log_uniform(1e-9, 1e-2);
    q = q * Eigen::Quaterniond(1.0, tilt, -tilt, 0.5 * tilt);
  }
  return q;
}

void draw_place(WaveRequest& request, const WaveSearchBody& body, RandomPoses& random) {
  const Water& water = request.water;
  const double size = body.mesh.diagonal;
  const Sea sea = Sea::make(request.description, water).value();
  SeaSnapshot snapshot(sea);
  snapshot.set_time(request.utime, request.lead_time);
  const HorizontalAxes& axes = sea.axes();
  const double farthest = random.pick(5) < 2 ? 1e6 : 100.0;
  double x1 = random.uniform(-farthest, farthest);
  double x2 = random.uniform(-farthest, farthest);
  if (random.pick(5) == 0) x1 = x2 = 0.0;

  request.pose.q_WB = random_orientation(random);
  const Mat3 R_WB = request.pose.q_WB.normalized().toRotationMatrix();
  const Vec3 up_B = R_WB.transpose() * water.up_W;
  // The lowest and the highest vertex, about c.
  Vec3 lowest = Vec3::Zero();
  Vec3 highest = Vec3::Zero();
  for (std::size_t i = 0; i < body.mesh.surface.vertex_count(); ++i) {
    const Vec3 y = body.mesh.surface.vertex(static_cast<std::int32_t>(i));
    if (up_B.dot(y - lowest) < 0.0) lowest = y;
    if (up_B.dot(y - highest) > 0.0) highest = y;
  }
  const auto elevation_at = [&](const Vec3& y) {
    const Vec3 y_W = R_WB * y;
    return snapshot.elevation(x1 + axes.e1_W.dot(y_W), x2 + axes.e2_W.dot(y_W));
  };
  double zeta = 0.0;  // of c
  switch (random.pick(12)) {
    case 0: {
      request.placement = "touching, dry but for a tip";
      const double depth = size * signed_log_uniform(random, 1e-9, 0.03);
      zeta = elevation_at(lowest) - up_B.dot(lowest) - depth;
      break;
    }
    case 1: {
      request.placement = "touching, wet but for a tip";
      const double above = size * signed_log_uniform(random, 1e-9, 0.03);
      zeta = elevation_at(highest) - up_B.dot(highest) + above;
      break;
    }
    case 2:
      request.placement = "dry";
      zeta = snapshot.elevation(x1, x2) + random.log_uniform(0.5, 3.0) * size;
      break;
    case 3:
      request.placement = "deep";
      zeta = -random.log_uniform(0.7, 30.0) * size;
      zeta -= random.uniform(0.0, 1.0) * sea.max_elevation();
      break;
    case 4:
      request.placement = "just below";
      zeta = snapshot.elevation(x1, x2) - random.uniform(0.4, 1.5) * size;
      break;
    default:
      request.placement = "piercing";
      zeta = snapshot.elevation(x1, x2) + random.uniform(-0.6, 0.6) * up_B.dot(highest - lowest);
  }
  if (!std::isinf(sea.depth())) {
    const double below = up_B.dot(lowest);
    const double above = up_B.dot(highest);
    switch (random.pick(4)) {
      case 0:
        request.placement += ", across the bed";
        zeta = -sea.depth() - below - random.uniform(0.0, 1.0) * (above - below);
        break;
      case 1:
        request.placement += ", below the bed";
        zeta = -sea.depth() - above - random.log_uniform(1e-6, 5.0) * size;
        break;
      default:
        zeta = std::max(zeta, -sea.depth() - below + 1e-6 * size);
    }
  }
  const Vec3 c_W = x1 * axes.e1_W + x2 * axes.e2_W + (water.level + zeta) * water.up_W;
  request.pose.p_WB = c_W - R_WB * body.mesh.center_B;
}

}  // namespace

WaveSearchBody random_wave_mesh(RandomPoses& random) {
  const double triangles = random.log_uniform(12.0, 30e3);
  auto [name, source] = random_shape(random, triangles);
  Vec3 factors = Vec3::Ones();
  const bool stretched = chance(random, 0.15);
  if (stretched) {
    for (double& factor : factors) factor = random.log_uniform(0.05, 1.0);
  }
  const double scale = random.log_uniform(0.1, 30.0) / bounding_box(source).diagonal();
  const Eigen::Quaterniond turn = random.pick(2) == 0 ? Eigen::Quaterniond::Identity() : random.rotation();
  Vec3 offset = Vec3::Zero();
  if (random.pick(2) == 0) offset = scale * random_offset(random, 0.1, 1e3);
  source = mapped(std::move(source), [&](const Vec3& vertex) {
    return Vec3(scale * (turn * factors.cwiseProduct(vertex)) + offset);
  });
  WaveSearchBody body;
  body.mesh = make_hydrostatic_mesh(ValidatedMesh{source, {}}, WithTree::kNo);
  body.tree = build_patch_tree(body.mesh.surface);
  char text[160];
  std::snprintf(text, sizeof text, "%s%s of %zu triangles, diagonal %.3g m, %.3g m from its origin", name,
                stretched ? ", stretched," : "", source.triangles.size(), body.mesh.diagonal, offset.norm());
  body.kind = text;
  body.source_B = std::move(source);
  return body;
}

WaveRequest random_wave_request(const WaveSearchBody& mesh, RandomPoses& random) {
  WaveRequest request;
  const double size = mesh.mesh.diagonal;
  if (random.pick(10) == 0) request.water.gravity = random.uniform(1.0, 25.0);
  if (random.pick(3) == 0) request.water.level = signed_log_uniform(random, 0.1, 1e3);
  switch (random.pick(8)) {
    case 0: {
      const std::size_t axis = random.pick(6);
      request.water.up_W = (axis < 3 ? 1.0 : -1.0) * Vec3::Unit(static_cast<int>(axis % 3));
      break;
    }
    case 1:
      request.water.up_W = random.direction();
      break;
    default:
      break;
  }
  request.tolerance = random.log_uniform(1e-5, 1e-2);
  draw_sea(request, size, random);
  draw_time(request, random);
  draw_place(request, mesh, random);
  request.reference_B = mesh.mesh.center_B;
  if (random.pick(2) == 0) request.reference_B += size * random_offset(random, 0.01, 3.0);
  if (random.pick(8) == 0) request.reference_B = Vec3::Zero();
  return request;
}

std::string_view to_string(SeaKind kind) {
  switch (kind) {
    case SeaKind::kRegular:
      return "regular";
    case SeaKind::kSeveral:
      return "2 to 16 components";
    case SeaKind::kIrregular:
      return "irregular, 200 components";
    case SeaKind::kShort:
      return "short";
    case SeaKind::kSteep:
      return "steep";
    case SeaKind::kLong:
      return "very long";
  }
  return "";
}

std::string describe(const WaveRequest& request) {
  const SeaDescription& sea = request.description;
  const std::size_t components = number_of_components(sea.systems.front());
  return "  " + std::string(to_string(request.kind)) + ", " + request.placement + ", pressure " +
         std::string(to_string(sea.pressure)) + ", depth " + format_shortest(sea.depth) + ", " +
         std::to_string(components) + " components, tolerance " + format_shortest(request.tolerance) +
         "\n  at " + format_vector(request.pose.p_WB, 17) + ", up " + format_vector(request.water.up_W, 17) +
         "\n";
}

}  // namespace buoyancy

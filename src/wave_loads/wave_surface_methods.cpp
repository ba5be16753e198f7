#include "wave_loads/wave_surface_methods.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <vector>

#include <Eigen/Geometry>

#include "base/thread_workspace.h"
#include "geometry/pairwise_sum.h"
#include "hydrostatics/point.h"

#define HWY_BROKEN_EMU128 1
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "wave_loads/wave_surface_methods.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "wave_loads/direct_sea.h"
#include "wave_loads/wave_lanes-inl.h"

#ifndef BUOYANCY_WAVE_SURFACE_QUERY
#define BUOYANCY_WAVE_SURFACE_QUERY
namespace buoyancy {

enum class SurfaceMethod { kFast, kExact };

// In wave axes: along the horizontal axes e1 and e2 and up, from the mesh's centre c.
struct SurfaceQuery {
  SurfaceMethod method = SurfaceMethod::kExact;
  const HydrostaticMesh* mesh = nullptr;
  Point<double> e1_B{1, 0, 0}, e2_B{0, 1, 0}, up_B{0, 0, 1};
  Point<double> reference{0, 0, 0};  // [m]
  double zeta = 0.0;                 // [m], height of c over the level
  bool hydrostatic = false;
};

struct SurfaceSum {
  Point<double> force{0, 0, 0};   // [m^3]
  Point<double> torque{0, 0, 0};  // [m^4]
  Point<double> moment{0, 0, 0};  // [m^4]
  double volume = 0.0;            // [m^3]

  SurfaceSum& operator+=(const SurfaceSum& other) {
    force += other.force;
    torque += other.torque;
    moment += other.moment;
    volume += other.volume;
    return *this;
  }
};

}  // namespace buoyancy
#endif  // BUOYANCY_WAVE_SURFACE_QUERY

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {
namespace direct {

// Elevation and wave pressure at many points by sums over all components: lanes are points.

// Points that are evaluated together; as many as are summed up before sums are added pairwise.
inline constexpr std::size_t kPointBlock = 256;

template <typename Number>
struct SeaPoints {
  // [m]: from the body's centre along the horizontal axes, and the height over the level.
  alignas(64) std::array<Number, kPointBlock> x1, x2, zeta;
  alignas(64) std::array<Number, kPointBlock> eta;  // [m], result
  alignas(64) std::array<Number, kPointBlock> f;    // [m], result: sum of a E(z') cos(theta), at z' = 0 above
};

// Per group of components, the sums of a cos(theta) at as many points as there are lanes.
template <typename Number>
struct alignas(64) GroupSum {
  std::array<Number, kLanes<Number>> lanes;
};

// The terms of the Taylor series that are below the rounding error of Number in the range that is used.
template <typename Number>
inline constexpr std::size_t kSineTerms = sizeof(Number) == sizeof(float) ? 6 : 11;
template <typename Number>
inline constexpr std::size_t kPowerTerms = sizeof(Number) == sizeof(float) ? 8 : 14;

// Of sin(2 pi y) / y in powers of y^2.
template <typename Number>
inline constexpr auto kSineSeries = [] {
  constexpr double kTurn = 6.283185307179586;
  std::array<Number, kSineTerms<Number>> series{};
  double term = kTurn;
  for (std::size_t i = 0; i < series.size(); ++i) {
    series[i] = static_cast<Number>(term);
    const auto n = static_cast<double>(2 * i + 2);
    term *= -kTurn * kTurn / (n * (n + 1.0));
  }
  return series;
}();
// Of 2^x in powers of x.
template <typename Number>
inline constexpr auto kPowerSeries = [] {
  constexpr double kLog2 = 0.6931471805599453;
  std::array<Number, kPowerTerms<Number>> series{};
  double term = 1.0;
  for (std::size_t i = 0; i < series.size(); ++i) {
    series[i] = static_cast<Number>(term);
    term *= kLog2 / static_cast<double>(i + 1);
  }
  return series;
}();

template <typename Number, std::size_t kTerms>
HWY_INLINE VectorOf<Number> horner(const std::array<Number, kTerms>& series, const VectorOf<Number>& x) {
  const LanesOf<Number> d;
  auto sum = hn::Set(d, series[kTerms - 1]);
#pragma GCC unroll 16
  for (std::size_t i = 2; i <= kTerms; ++i) sum = hn::MulAdd(sum, x, hn::Set(d, series[kTerms - i]));
  return sum;
}

template <typename Number>
inline constexpr int kMantissaBits = std::numeric_limits<Number>::digits - 1;
// Added to a number of fewer than kMantissaBits - 1 bits before the point, it rounds it to a whole number,
// which are then the lowest bits of the sum.
template <typename Number>
inline constexpr double kRounder = 1.5 * static_cast<double>(std::uint64_t{1} << kMantissaBits<Number>);

// amplitude cos(turns), turns in turns, added to `sum`.
template <typename Number>
HWY_INLINE VectorOf<Number> add_cosine(const VectorOf<Number>& amplitude, const VectorOf<Number>& turns,
                                       const VectorOf<Number>& sum) {
  const auto rounder = set<Number>(kRounder<Number>);
  const auto rest = turns - ((turns + rounder) - rounder);
  const auto y = set<Number>(0.25) - hn::Abs(rest);  // cos(rest) = sin(y), |y| <= 1/4
  return hn::MulAdd(horner<Number>(kSineSeries<Number>, y * y), amplitude * y, sum);
}

// 2^x; x below the exponents of Number's numbers gives about 0.
template <typename Number>
HWY_INLINE VectorOf<Number> power_of_two(const VectorOf<Number>& x) {
  const LanesOf<Number> d;
  const hn::RebindToUnsigned<LanesOf<Number>> bits;
  constexpr double kLimit = std::numeric_limits<Number>::max_exponent - 2;
  const auto rounder = set<Number>(kRounder<Number>);
  const auto within = hn::Min(hn::Max(x, set<Number>(-kLimit)), set<Number>(kLimit));
  const auto shifted = within + rounder;
  const auto rest = within - (shifted - rounder);
  const auto one = hn::BitCast(bits, set<Number>(1.0));
  const auto scale = hn::BitCast(d, hn::ShiftLeft<kMantissaBits<Number>>(hn::BitCast(bits, shifted)) + one);
  return horner<Number>(kPowerSeries<Number>, rest) * scale;
}

// Sets eta, and f unless `group_sums` is null, of the first `count` points. Reads points up to the next
// multiple of the number of lanes.
template <typename Number>
HWY_NOINLINE void evaluate_sea(const DirectSea<Number>& sea, std::size_t count, SeaPoints<Number>& points,
                               GroupSum<Number>* group_sums) {
  using Group = typename DirectSea<Number>::Group;
  if (sea.surface != nullptr) {
    for (std::size_t i = 0; i < count; ++i) {
      const ElevationDerivatives there = sea.surface->at(sea.x1 + static_cast<double>(points.x1[i]),
                                                         sea.x2 + static_cast<double>(points.x2[i]));
      points.eta[i] = static_cast<Number>(there.eta);
    }
    return;
  }
  constexpr std::size_t kTogether = DirectSea<Number>::kMaxGroup;  // groups, as with components
  const LanesOf<Number> d;
  const auto zero = hn::Zero(d);
  const auto* const components = sea.components.data();
  const Group* const groups = sea.groups.data();
  const std::size_t number = sea.groups.size();
  for (std::size_t first = 0; first < count; first += kLanes<Number>) {
    const auto x1 = hn::Load(d, points.x1.data() + first);
    const auto x2 = hn::Load(d, points.x2.data() + first);
    auto eta = zero;
    std::size_t i = 0;
    for (std::size_t begin = 0; begin < number; begin += kTogether) {
      auto of_groups = zero;
      for (std::size_t g = begin; g < std::min(number, begin + kTogether); ++g) {
        auto sum = zero;
        for (; i < groups[g].end; ++i) {
          const auto& c = components[i];
          const auto turns =
              hn::MulAdd(hn::Set(d, c.k1), x1, hn::MulAdd(hn::Set(d, c.k2), x2, hn::Set(d, c.phase)));
          sum = add_cosine<Number>(hn::Set(d, c.amplitude), turns, sum);
        }
        of_groups = of_groups + sum;
        if (group_sums != nullptr) hn::Store(sum, d, group_sums[g].lanes.data());
      }
      eta = eta + of_groups;
    }
    hn::Store(eta, d, points.eta.data() + first);
    if (group_sums == nullptr) continue;

    const auto one = set<Number>(1.0);
    const auto s = hn::Min(hn::Load(d, points.zeta.data() + first) - eta, zero);
    const auto column = hn::MulAdd(eta, hn::Set(d, sea.per_depth), one);
    const auto bed = hn::Set(d, sea.bed);
    const auto z = hn::IfThenElse(hn::Gt(column, zero), hn::Max(s / column, bed), bed);
    auto f = zero;
    for (std::size_t begin = 0; begin < number; begin += kTogether) {
      auto of_groups = zero;
      for (std::size_t g = begin; g < std::min(number, begin + kTogether); ++g) {
        const Group& group = groups[g];
        const auto exponent = hn::Set(d, group.rate) * z;
        auto decay = power_of_two<Number>(exponent);
        if (group.bed_matters) {
          decay = decay + power_of_two<Number>(hn::Neg(exponent) - hn::Set(d, group.twice_depth));
        }
        const auto sum = hn::Load(d, group_sums[g].lanes.data());
        of_groups = hn::MulAdd(decay, hn::Set(d, group.scale) * sum, of_groups);
      }
      f = f + of_groups;
    }
    hn::Store(f, d, points.f.data() + first);
  }
}

struct SeaVertex {
  Point<double> x;  // [m]
  double s;         // [m], height over the surface
};

template <typename Number>
struct SurfaceWorkspace {
  std::vector<SeaVertex> vertices;
  std::vector<GroupSum<Number>> group_sums;
  SeaPoints<Number> points;
  // Of the points [m]: their places, and the parts of the surface that they stand for [m^2].
  alignas(64) std::array<double, kPointBlock> x1, x2, x3, n1, n2, n3;
};

using Doubles = hn::CappedTag<double, 8>;
static_assert(kPointBlock % hn::MaxLanes(Doubles()) == 0);

// Reads numbers as doubles.
template <typename Number>
HWY_INLINE hn::Vec<Doubles> load_doubles(const Number* numbers) {
  if constexpr (std::is_same_v<Number, float>) {
    return hn::PromoteTo(Doubles(), hn::LoadU(hn::Rebind<float, Doubles>(), numbers));
  } else {
    return hn::LoadU(Doubles(), numbers);
  }
}

template <typename Number>
class SurfaceIntegral {
 public:
  SurfaceIntegral(const SurfaceQuery& query, const DirectSea<Number>& sea, SurfaceWorkspace<Number>& work)
      : query_(query), sea_(sea), work_(work) {
    work_.vertices.resize(query.mesh->surface.vertex_count());
    work_.group_sums.resize(sea.groups.size());
  }

  SurfaceSum run() {
    place_vertices();
    const std::vector<SeaVertex>& vertices = work_.vertices;
    const auto at = [&vertices](std::int32_t i) -> const SeaVertex& {
      return vertices[static_cast<std::size_t>(i)];
    };
    if (query_.method == SurfaceMethod::kFast) {
      for (const Triangle& t : query_.mesh->surface.triangles) {
        add_centroid(at(t[0]).x, at(t[1]).x, at(t[2]).x);
      }
    } else {
      for (const Triangle& t : query_.mesh->surface.triangles) add_wet_part(at(t[0]), at(t[1]), at(t[2]));
    }
    close_block();
    return sum_.total();
  }

 private:
  void place_vertices() {
    const TriangleMesh& mesh = query_.mesh->surface;
    for (std::size_t begin = 0; begin < work_.vertices.size(); begin += kPointBlock) {
      const std::size_t count = std::min(kPointBlock, work_.vertices.size() - begin);
      for (std::size_t i = 0; i < count; ++i) {
        const Point<double> y{mesh.x[begin + i], mesh.y[begin + i], mesh.z[begin + i]};
        SeaVertex& vertex = work_.vertices[begin + i];
        vertex.x = {dot(query_.e1_B, y), dot(query_.e2_B, y), dot(query_.up_B, y)};
        place_in_sea(i, vertex.x);
      }
      if (query_.method == SurfaceMethod::kFast) continue;
      repeat_last(count);
      evaluate_sea<Number>(sea_, count, work_.points, nullptr);
      for (std::size_t i = 0; i < count; ++i) {
        SeaVertex& vertex = work_.vertices[begin + i];
        vertex.s = query_.zeta + vertex.x.z - static_cast<double>(work_.points.eta[i]);
      }
    }
  }

  void place_in_sea(std::size_t i, const Point<double>& x) {
    work_.points.x1[i] = static_cast<Number>(x.x);
    work_.points.x2[i] = static_cast<Number>(x.y);
    work_.points.zeta[i] = static_cast<Number>(query_.zeta + x.z);
  }
  // So that whole vectors of places can be read.
  void repeat_last(std::size_t count) {
    constexpr std::size_t kMaxLanes = std::max(kLanes<Number>, hn::MaxLanes(Doubles()));
    const std::size_t end = (count + kMaxLanes - 1) / kMaxLanes * kMaxLanes;
    for (auto* row : {&work_.points.x1, &work_.points.x2, &work_.points.zeta}) {
      std::fill(row->data() + count, row->data() + end, (*row)[count - 1]);
    }
  }

  void add_centroid(const Point<double>& a, const Point<double>& b, const Point<double>& c) {
    add_point((1.0 / 3.0) * (a + b + c), 0.5 * cross(b - a, c - a));
  }

  void add_wet_part(const SeaVertex& a, const SeaVertex& b, const SeaVertex& c) {
    const int wet = static_cast<int>(a.s < 0.0) + static_cast<int>(b.s < 0.0) + static_cast<int>(c.s < 0.0);
    if (wet == 0) return;
    const Point<double> area = 0.5 * cross(b.x - a.x, c.x - a.x);
    if (wet == 3) return add_piece(a.x, b.x, c.x, area);
    // The first vertex is the one that differs from the two others.
    const auto differs = [wet](const SeaVertex& v) { return (v.s < 0.0) == (wet == 1); };
    if (differs(a)) {
      add_cut(a, b, c, area);
    } else if (differs(b)) {
      add_cut(b, c, a, area);
    } else {
      add_cut(c, a, b, area);
    }
  }

  // Of the edge from `lone` the share that is on its side of the surface.
  static double share(const SeaVertex& lone, const SeaVertex& other) { return lone.s / (lone.s - other.s); }

  void add_cut(const SeaVertex& lone, const SeaVertex& second, const SeaVertex& third,
               const Point<double>& area) {
    const double to_second = share(lone, second);
    const double to_third = share(lone, third);
    const Point<double> on_second = lone.x + to_second * (second.x - lone.x);
    const Point<double> on_third = lone.x + to_third * (third.x - lone.x);
    if (lone.s < 0.0) return add_piece(lone.x, on_second, on_third, to_second * to_third * area);
    add_piece(on_second, second.x, third.x, (1.0 - to_second) * area);
    add_piece(on_second, third.x, on_third, to_second * (1.0 - to_third) * area);
  }

  void add_piece(const Point<double>& p, const Point<double>& q, const Point<double>& r,
                 const Point<double>& area) {
    const Point<double> sixth = (1.0 / 6.0) * (p + q + r);
    const Point<double> third = (1.0 / 3.0) * area;
    add_point(sixth + 0.5 * p, third);
    add_point(sixth + 0.5 * q, third);
    add_point(sixth + 0.5 * r, third);
  }

  void add_point(const Point<double>& x, const Point<double>& area) {
    place_in_sea(count_, x);
    work_.x1[count_] = x.x;
    work_.x2[count_] = x.y;
    work_.x3[count_] = x.z;
    work_.n1[count_] = area.x;
    work_.n2[count_] = area.y;
    work_.n3[count_] = area.z;
    if (++count_ == kPointBlock) close_block();
  }

  HWY_NOINLINE void close_block() {
    if (count_ == 0) return;
    repeat_last(count_);
    evaluate_sea<Number>(sea_, count_, work_.points, query_.hydrostatic ? nullptr : work_.group_sums.data());
    const Doubles d;
    constexpr std::size_t kStep = hn::MaxLanes(Doubles());
    const std::size_t end = (count_ + kStep - 1) / kStep * kStep;
    for (auto* row : {&work_.x1, &work_.x2, &work_.x3, &work_.n1, &work_.n2, &work_.n3}) {
      std::fill(row->data() + count_, row->data() + end, 0.0);
    }
    const auto zero = hn::Zero(d);
    const auto half = hn::Set(d, 0.5);
    const auto zeta_c = hn::Set(d, query_.zeta);
    auto fx = zero, fy = zero, fz = zero, tx = zero, ty = zero, tz = zero, mx = zero, my = zero, mz = zero,
         v = zero;
    for (std::size_t i = 0; i < end; i += kStep) {
      const auto x1 = hn::Load(d, work_.x1.data() + i);
      const auto x2 = hn::Load(d, work_.x2.data() + i);
      const auto x3 = hn::Load(d, work_.x3.data() + i);
      const auto n1 = hn::Load(d, work_.n1.data() + i);
      const auto n2 = hn::Load(d, work_.n2.data() + i);
      const auto n3 = hn::Load(d, work_.n3.data() + i);
      const auto zeta = zeta_c + x3;
      const auto s = hn::Min(zeta - load_doubles(work_.points.eta.data() + i), zero);
      // Minus the pressure.
      const auto p = query_.hydrostatic
                         ? s
                         : hn::IfThenElseZero(s < zero, zeta - load_doubles(work_.points.f.data() + i));
      const auto f1 = p * n1;
      const auto f2 = p * n2;
      const auto f3 = p * n3;
      const auto l1 = x1 - hn::Set(d, query_.reference.x);
      const auto l2 = x2 - hn::Set(d, query_.reference.y);
      const auto l3 = x3 - hn::Set(d, query_.reference.z);
      fx = fx + f1;
      fy = fy + f2;
      fz = fz + f3;
      tx = tx + (l2 * f3 - l3 * f2);
      ty = ty + (l3 * f1 - l1 * f3);
      tz = tz + (l1 * f2 - l2 * f1);
      // The fields (0, 0, s), x s and (zeta^2 - eta^2) / 2 = s (zeta - s / 2), about c.
      const auto column = s * n3;
      v = v + column;
      mx = mx + x1 * column;
      my = my + x2 * column;
      mz = mz + (x3 - half * s) * column;
    }
    const auto sum = [](const auto& lanes) { return sum_of_lanes(lanes); };
    sum_.add_block(
        {{sum(fx), sum(fy), sum(fz)}, {sum(tx), sum(ty), sum(tz)}, {sum(mx), sum(my), sum(mz)}, sum(v)});
    count_ = 0;
  }

  const SurfaceQuery& query_;
  const DirectSea<Number>& sea_;
  SurfaceWorkspace<Number>& work_;
  std::size_t count_ = 0;
  PairwiseSum<SurfaceSum> sum_;
};

template <typename Number>
SurfaceSum integrate(const SurfaceQuery& query, const DirectSea<Number>& sea) {
  return SurfaceIntegral<Number>(query, sea, thread_workspace<SurfaceWorkspace<Number>>()).run();
}

}  // namespace direct

SurfaceSum integrate_single(const SurfaceQuery& query, const DirectSea<float>& sea) {
  return direct::integrate(query, sea);
}
SurfaceSum integrate_double(const SurfaceQuery& query, const DirectSea<double>& sea) {
  return direct::integrate(query, sea);
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace buoyancy {

HWY_EXPORT(integrate_single);
HWY_EXPORT(integrate_double);

namespace {

enum class Precision { kAsNeeded, kDouble };

WaveLoad surface_load(SurfaceMethod method, Precision precision, const HydrostaticMesh& mesh,
                      const SeaSnapshot& snapshot, const Pose& pose, const Vec3& reference_B) {
  const Sea& sea = snapshot.sea();
  const Water& water = sea.water();
  const Mat3 R_WB = pose.q_WB.normalized().toRotationMatrix();
  const Vec3 c_W = pose.p_WB + R_WB * mesh.center_B;
  const Vec3 e1_B = R_WB.transpose() * sea.axes().e1_W;
  const Vec3 e2_B = R_WB.transpose() * sea.axes().e2_W;
  const Vec3 up_B = R_WB.transpose() * water.up_W;

  SurfaceQuery query;
  query.method = method;
  query.mesh = &mesh;
  query.e1_B = Point<double>::from(e1_B);
  query.e2_B = Point<double>::from(e2_B);
  query.up_B = Point<double>::from(up_B);
  const Vec3 reference = reference_B - mesh.center_B;
  query.reference = {e1_B.dot(reference), e2_B.dot(reference), up_B.dot(reference)};
  query.zeta = water.up_W.dot(c_W) - water.level;
  query.hydrostatic = sea.pressure() == WavePressure::kHydrostatic;

  const Vec3 extent = (mesh.box_max - mesh.box_min) * 0.5;
  const double height = query.zeta + up_B.dot(0.5 * (mesh.box_max + mesh.box_min));
  const double reach = extent.dot(up_B.cwiseAbs());
  const double crest = snapshot.amplitude_factor() * sea.max_elevation();
  if (height - reach > crest) return {};

  const double x1 = sea.axes().e1_W.dot(c_W);
  const double x2 = sea.axes().e2_W.dot(c_W);
  // The error of float32 sums is a fraction of the waves' height over the whole surface.
  constexpr double kHeightPerEdge = 10.0;
  const bool single = precision == Precision::kAsNeeded && snapshot.surface().count == 0 &&
                      snapshot.amplitude_factor() * sea.significant_wave_height() * mesh.area <
                          kHeightPerEdge * std::abs(mesh.volume);
  thread_local std::vector<double> phases;
  SurfaceSum sum;
  if (single) {
    auto& direct = thread_workspace<DirectSea<float>>();
    direct.prepare(snapshot, x1, x2, phases);
    sum = HWY_DYNAMIC_DISPATCH(integrate_single)(query, direct);
  } else {
    auto& direct = thread_workspace<DirectSea<double>>();
    direct.prepare(snapshot, x1, x2, phases);
    sum = HWY_DYNAMIC_DISPATCH(integrate_double)(query, direct);
  }

  const auto in_body = [&](const Point<double>& v) { return Vec3(v.x * e1_B + v.y * e2_B + v.z * up_B); };
  WaveLoad load;
  load.force = in_body(sum.force);
  load.torque = in_body(sum.torque);
  load.volume = sum.volume;
  load.moment = in_body(sum.moment);
  load.force_bound = load.torque_bound = load.volume_bound = std::numeric_limits<double>::infinity();
  return load;
}

}  // namespace

WaveLoad fast_surface_in_waves(const HydrostaticMesh& mesh, const SeaSnapshot& sea, const Pose& pose,
                               const Vec3& reference_B) {
  return surface_load(SurfaceMethod::kFast, Precision::kAsNeeded, mesh, sea, pose, reference_B);
}

WaveLoad exact_surface_in_waves(const HydrostaticMesh& mesh, const SeaSnapshot& sea, const Pose& pose,
                                const Vec3& reference_B) {
  return surface_load(SurfaceMethod::kExact, Precision::kAsNeeded, mesh, sea, pose, reference_B);
}

WaveLoad exact_surface_in_double(const HydrostaticMesh& mesh, const SeaSnapshot& sea, const Pose& pose,
                                 const Vec3& reference_B) {
  return surface_load(SurfaceMethod::kExact, Precision::kDouble, mesh, sea, pose, reference_B);
}

}  // namespace buoyancy
#endif  // HWY_ONCE

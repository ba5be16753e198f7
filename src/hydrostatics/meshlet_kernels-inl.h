// The SIMD kernels of the paper's methods: they sum over a meshlet's triangles, four at a time, and clip
// those that the water cuts. Included once per instruction set (wetted_surface.cpp), after highway.h.
//
// Every instruction set adds the same terms in the same order, in four interleaved sums, without fused
// multiply-add: the results are the same bits everywhere.
#if defined(BUOYANCY_MESHLET_KERNELS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_MESHLET_KERNELS_INL_H
#undef BUOYANCY_MESHLET_KERNELS_INL_H
#else
#define BUOYANCY_MESHLET_KERNELS_INL_H
#endif

#include <hwy/highway.h>

#include "base/simd-inl.h"
#include "geometry/meshlets.h"
#include "hydrostatics/triangle_clip.h"
#include "hydrostatics/wetted_surface.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// A group of triangles takes kParts vectors of kLanes numbers.
using Lanes = hn::CappedTag<double, kGroupTriangles>;
using Lane = hn::Vec<Lanes>;
using LaneMask = hn::Mask<Lanes>;
constexpr std::size_t kLanes = hn::MaxLanes(Lanes());
constexpr std::size_t kParts = kGroupTriangles / kLanes;

HWY_INLINE Lane lane(double value) {
  return hn::Set(Lanes(), value);
}
HWY_INLINE LaneMask is_wet(Lane height) {
  return hn::Lt(height, hn::Zero(Lanes()));
}
HWY_INLINE std::uint64_t lane_bits(LaneMask mask) {
  return mask_bits(Lanes(), mask);
}

struct LanePoint {
  Lane x, y, z;
};

HWY_INLINE LanePoint operator+(LanePoint a, LanePoint b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HWY_INLINE LanePoint operator-(LanePoint a, LanePoint b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE LanePoint operator*(Lane s, LanePoint a) {
  return {s * a.x, s * a.y, s * a.z};
}
HWY_INLINE Lane dot(LanePoint a, LanePoint b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
HWY_INLINE LanePoint cross(LanePoint a, LanePoint b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
HWY_INLINE LanePoint if_then_else(LaneMask mask, LanePoint a, LanePoint b) {
  return {hn::IfThenElse(mask, a.x, b.x), hn::IfThenElse(mask, a.y, b.y), hn::IfThenElse(mask, a.z, b.z)};
}
HWY_INLINE LanePoint lane_point(const Vec3& v) {
  return {lane(v.x()), lane(v.y()), lane(v.z())};
}

// Points of the surface about the mesh's centre, and their signed heights over the water.
struct LaneVertex {
  LanePoint y;
  Lane z;
};

HWY_INLINE LaneVertex if_then_else(LaneMask mask, const LaneVertex& a, const LaneVertex& b) {
  return {if_then_else(mask, a.y, b.y), hn::IfThenElse(mask, a.z, b.z)};
}

// Reads one vertex per lane: row(i) points to its x, y, z and height, aligned as a vector of four.
template <typename Row>
HWY_INLINE LaneVertex load_vertices(const Row& row) {
#if HWY_TARGET == HWY_SCALAR
  const double* const at = row(0);
  return {{lane(at[0]), lane(at[1]), lane(at[2])}, lane(at[3])};
#else
  const Lanes d;
  if constexpr (kLanes == 2) {
    const Lane xy_0 = hn::Load(d, row(0));
    const Lane xy_1 = hn::Load(d, row(1));
    const Lane zh_0 = hn::Load(d, row(0) + 2);
    const Lane zh_1 = hn::Load(d, row(1) + 2);
    return {{hn::InterleaveLower(d, xy_0, xy_1), hn::InterleaveUpper(d, xy_0, xy_1),
             hn::InterleaveLower(d, zh_0, zh_1)},
            hn::InterleaveUpper(d, zh_0, zh_1)};
  } else {
    const Lane v_0 = hn::Load(d, row(0));
    const Lane v_1 = hn::Load(d, row(1));
    const Lane v_2 = hn::Load(d, row(2));
    const Lane v_3 = hn::Load(d, row(3));
    // Within each half of a vector: x and z, or y and height, of two vertices.
    const Lane xz_01 = hn::InterleaveLower(d, v_0, v_1);
    const Lane yh_01 = hn::InterleaveUpper(d, v_0, v_1);
    const Lane xz_23 = hn::InterleaveLower(d, v_2, v_3);
    const Lane yh_23 = hn::InterleaveUpper(d, v_2, v_3);
    return {{hn::ConcatLowerLower(d, xz_23, xz_01), hn::ConcatLowerLower(d, yh_23, yh_01),
             hn::ConcatUpperUpper(d, xz_23, xz_01)},
            hn::ConcatUpperUpper(d, yh_23, yh_01)};
  }
#endif
}

// Computes the heights of a meshlet's vertices. Returns a bit for each that is wet.
class HeightKernel {
 public:
  HWY_INLINE explicit HeightKernel(const WaterPlane& plane)
      : up_(lane_point(plane.up_B)), h_c_(lane(plane.h_c)) {}

  HWY_INLINE std::uint64_t find(const Meshlets& meshlets, const Meshlet& meshlet, double* heights) const {
    const Lanes d;
    const std::size_t first = meshlet.first_vertex;
    std::uint64_t wet = 0;
    for (std::size_t i = 0; i < meshlet.vertices; i += kLanes) {
      const LanePoint y{hn::LoadU(d, meshlets.x.data() + first + i),
                        hn::LoadU(d, meshlets.y.data() + first + i),
                        hn::LoadU(d, meshlets.z.data() + first + i)};
      const Lane height = dot(up_, y) - h_c_;
      hn::Store(height, d, heights + i);
      wet |= lane_bits(is_wet(height)) << i;
    }
    return wet;
  }

 private:
  LanePoint up_;
  Lane h_c_;
};

HWY_INLINE bool is_fully_submerged(const Meshlet& meshlet, std::uint64_t wet) {
  return wet == ~std::uint64_t{0} >> (64 - meshlet.vertices);
}

// A meshlet's vertices in rows of x, y, z and height.
struct VertexRows {
  HWY_ALIGN std::array<double, 4 * Meshlets::kMaxVertices> values;

  HWY_INLINE void fill(const Meshlets& meshlets, const Meshlet& meshlet, const double* heights) {
    const Lanes d;
    const std::size_t first = meshlet.first_vertex;
    for (std::size_t i = 0; i < meshlet.vertices; i += kLanes) {
      hn::StoreInterleaved4(
          hn::LoadU(d, meshlets.x.data() + first + i), hn::LoadU(d, meshlets.y.data() + first + i),
          hn::LoadU(d, meshlets.z.data() + first + i), hn::Load(d, heights + i), d, values.data() + 4 * i);
    }
  }

  // Vertices of the triangles of one part of a group.
  HWY_INLINE LaneVertex corners(const std::array<std::uint8_t, kGroupTriangles>& corner,
                                std::size_t part) const {
    return load_vertices([&](std::size_t i) { return values.data() + corner[kLanes * part + i]; });
  }
};

// Adds up the lanes of all parts, in the same order for every number of lanes.
HWY_INLINE double sum_of_lanes(const std::array<Lane, kParts>& parts) {
  HWY_ALIGN std::array<double, kGroupTriangles> values;
  for (std::size_t part = 0; part < kParts; ++part)
    hn::Store(parts[part], Lanes(), values.data() + kLanes * part);
  return (values[0] + values[1]) + (values[2] + values[3]);
}

// Sums one number per triangle.
class LaneSum {
 public:
  HWY_INLINE LaneSum() { clear(); }
  HWY_INLINE void add(std::size_t part, Lane value) { parts_[part] = parts_[part] + value; }

  // Returns what was added since the last call.
  HWY_INLINE double take() {
    const double total = sum_of_lanes(parts_);
    clear();
    return total;
  }

 private:
  HWY_INLINE void clear() {
    for (Lane& part : parts_) part = lane(0.0);
  }

  std::array<Lane, kParts> parts_;
};

// Sums one vector per triangle.
class LanePointSum {
 public:
  // An implicit constructor would not be compiled for the instruction set.
  HWY_INLINE LanePointSum() {}  // NOLINT(modernize-use-equals-default)
  HWY_INLINE void add(std::size_t part, LanePoint value) {
    x_.add(part, value.x);
    y_.add(part, value.y);
    z_.add(part, value.z);
  }
  HWY_INLINE Point<double> take() { return {x_.take(), y_.take(), z_.take()}; }

 private:
  LaneSum x_, y_, z_;
};

// The triangles that a sum includes: all, or those of a mask.
struct IncludeAll {
  HWY_INLINE Lane operator()(Lane value) const { return value; }
};
struct IncludeSome {
  LaneMask mask;
  HWY_INLINE Lane operator()(Lane value) const { return hn::IfThenElseZero(mask, value); }
};

// Volume elements about an apex (volume_elements.h).
class VolumeLanes {
 public:
  using Total = VolumeElementSum;

  HWY_INLINE explicit VolumeLanes(const Vec3& apex) : apex_(lane_point(apex)) {}

  template <typename Include>
  HWY_INLINE void add(std::size_t part, const LaneVertex& a, const LaneVertex& b, const LaneVertex& c,
                      const Include& include) {
    const Lane v6 = include(six_volumes(a.y, b.y, c.y));
    volume6_.add(part, v6);
    moment6_.add(part, v6 * (a.y + b.y + c.y));
  }

  // A part of a tetrahedron is smaller than the tetrahedron.
  HWY_INLINE void add_bound(std::size_t part, const LaneVertex& a, const LaneVertex& b, const LaneVertex& c,
                            const IncludeSome& include) {
    bound_.add(part, include(hn::Abs(six_volumes(a.y, b.y, c.y))));
  }

  // Returns what was added since the last call.
  HWY_INLINE Total take() { return {{volume6_.take(), moment6_.take()}, bound_.take()}; }

 private:
  HWY_INLINE Lane six_volumes(LanePoint a, LanePoint b, LanePoint c) const {
    return dot(a - apex_, cross(b - a, c - a));
  }

  LanePoint apex_;
  LaneSum volume6_, bound_;
  LanePointSum moment6_;
};

// Pressure on the wetted surface (pressure_elements.h).
class PressureLanes {
 public:
  using Total = PressureElementSum;

  HWY_INLINE explicit PressureLanes(const Vec3& up) : up_(lane_point(up)) {}

  template <typename Include>
  HWY_INLINE void add(std::size_t part, const LaneVertex& a, const LaneVertex& b, const LaneVertex& c,
                      const Include& include) {
    const LanePoint twice_area = cross(b.y - a.y, c.y - a.y);
    const Lane a_z = include(a.z);
    const Lane b_z = include(b.z);
    const Lane c_z = include(c.z);
    const Lane z_sum = a_z + b_z + c_z;
    const LanePoint zy = (z_sum + a_z) * a.y + (z_sum + b_z) * b.y + (z_sum + c_z) * c.y;
    const Lane zz = a_z * a_z + b_z * b_z + c_z * c_z + a_z * b_z + b_z * c_z + c_z * a_z;
    force6_.add(part, z_sum * twice_area);
    torque24_.add(part, cross(zy, twice_area));
    z_squared12_.add(part, zz * dot(up_, twice_area));
  }

  // The integral of a convex function is at most that of the plane through its corner values:
  // int |min(z, 0)| dA <= A/3 sum |min(z_i, 0)|.
  HWY_INLINE void add_bound(std::size_t part, const LaneVertex& a, const LaneVertex& b, const LaneVertex& c,
                            const IncludeSome& include) {
    const LanePoint twice_area = cross(b.y - a.y, c.y - a.y);
    const Lane depths = depth(a.z) + depth(b.z) + depth(c.z);
    bound_.add(part, include(depths * hn::Sqrt(dot(twice_area, twice_area))));
  }

  // Returns what was added since the last call.
  HWY_INLINE Total take() { return {{force6_.take(), torque24_.take(), z_squared12_.take()}, bound_.take()}; }

 private:
  HWY_INLINE static Lane depth(Lane height) { return hn::IfThenElseZero(is_wet(height), lane(0.0) - height); }

  LanePoint up_;
  LanePointSum force6_, torque24_;
  LaneSum z_squared12_, bound_;
};

// Adds all triangles of a fully submerged meshlet.
template <typename Elements>
HWY_INLINE void add_submerged(const CornerGroup* groups, std::size_t count, const VertexRows& rows,
                              Elements& elements) {
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t part = 0; part < kParts; ++part) {
      elements.add(part, rows.corners(groups[i].a, part), rows.corners(groups[i].b, part),
                   rows.corners(groups[i].c, part), IncludeAll());
    }
  }
}

// One bit per triangle of a meshlet.
using TriangleBits = std::array<std::uint64_t, kGroupTriangles * Meshlets::kMaxGroups / 64>;

// Adds the fully submerged triangles of a meshlet that the water crosses. Triangles that it cuts are added to
// the bound, or returned for clipping. wet: one bit per vertex.
template <CutTriangles kCut, typename Elements>
HWY_INLINE TriangleBits add_crossing(const CornerGroup* groups, std::size_t count, const VertexRows& rows,
                                     std::uint64_t wet, Elements& elements) {
  // Which groups are dry cannot be predicted, so they are sorted out before anything is computed.
  std::array<std::uint8_t, Meshlets::kMaxGroups> with_wet_vertex;
  std::size_t num_with_wet_vertex = 0;
  for (std::size_t i = 0; i < count; ++i) {
    with_wet_vertex[num_with_wet_vertex] = static_cast<std::uint8_t>(i);
    num_with_wet_vertex += static_cast<std::size_t>((groups[i].vertices & wet) != 0);
  }
  TriangleBits cut_triangles{};
  for (std::size_t n = 0; n < num_with_wet_vertex; ++n) {
    const std::size_t i = with_wet_vertex[n];
    for (std::size_t part = 0; part < kParts; ++part) {
      const LaneVertex a = rows.corners(groups[i].a, part);
      const LaneVertex b = rows.corners(groups[i].b, part);
      const LaneVertex c = rows.corners(groups[i].c, part);
      const LaneMask a_wet = is_wet(a.z);
      const LaneMask b_wet = is_wet(b.z);
      const LaneMask c_wet = is_wet(c.z);
      const LaneMask all_wet = hn::And(hn::And(a_wet, b_wet), c_wet);
      const LaneMask cut = hn::AndNot(all_wet, hn::Or(hn::Or(a_wet, b_wet), c_wet));
      elements.add(part, a, b, c, IncludeSome{all_wet});
      if constexpr (kCut == CutTriangles::kBound) {
        elements.add_bound(part, a, b, c, IncludeSome{cut});
      } else {
        const std::size_t triangle = kGroupTriangles * i + kLanes * part;
        cut_triangles[triangle / 64] |= lane_bits(cut) << (triangle % 64);
      }
    }
  }
  return cut_triangles;
}

// Collects the triangles that the water cuts, from many meshlets, so that they are clipped in long runs.
class CutBatch {
 public:
  // Copies the vertices of the chosen triangles, with the corner first that is alone on its side.
  // wet: one bit per vertex of the meshlet.
  HWY_INLINE void add(const CornerGroup* groups, const TriangleBits& chosen, const VertexRows& rows,
                      std::uint64_t wet) {
    for (std::size_t word = 0; word < chosen.size(); ++word) {
      for (std::uint64_t bits = chosen[word]; bits != 0; bits &= bits - 1) {
        const std::size_t triangle = 64 * word + static_cast<std::size_t>(__builtin_ctzll(bits));
        const CornerGroup& group = groups[triangle / kGroupTriangles];
        const std::size_t i = triangle % kGroupTriangles;
        const std::array<std::uint8_t, 5> corner{group.a[i], group.b[i], group.c[i], group.a[i], group.b[i]};
        const auto wet_bit = [&](std::size_t n) { return wet >> (corner[n] / 4U) & 1U; };
        const std::size_t first = kOddOneOut[wet_bit(0) + 2 * wet_bit(1) + 4 * wet_bit(2)];
        for (std::size_t n = 0; n < 3; ++n)
          std::copy_n(rows.values.data() + corner[first + n], 4, vertices_[size_][n].data());
        ++size_;
      }
    }
  }

  HWY_INLINE bool is_full() const { return size_ > kEnough; }
  HWY_INLINE bool is_empty() const { return size_ == 0; }

  // Adds the wet parts of all triangles to `elements` and removes the triangles. Returns the sum of the
  // squares of their longest edges.
  template <typename Elements>
  HWY_INLINE double drain(Elements& elements) {
    LaneSum edges_squared;
    const std::size_t size = std::exchange(size_, 0);
    // Missing triangles of the last group repeat a valid one.
    for (std::size_t i = size; i % kGroupTriangles != 0; ++i) vertices_[i] = vertices_[0];
    for (std::size_t group = 0; group < size; group += kGroupTriangles) {
      for (std::size_t part = 0; part < kParts; ++part) {
        const std::size_t first = group + kLanes * part;
        const LaneMask present = hn::FirstN(Lanes(), size - std::min(size, first));
        const LaneVertex p = vertices(first, 0);
        const LaneVertex q = vertices(first, 1);
        const LaneVertex r = vertices(first, 2);
        clip(part, p, q, r, present, elements);
        const Lane longest =
            hn::Max(hn::Max(squared_distance(p, q), squared_distance(q, r)), squared_distance(r, p));
        edges_squared.add(part, hn::IfThenElseZero(present, longest));
      }
    }
    return edges_squared.take();
  }

 private:
  static constexpr std::size_t kEnough = 64;

  HWY_INLINE LaneVertex vertices(std::size_t first, std::size_t corner) const {
    return load_vertices([&](std::size_t i) { return vertices_[first + i][corner].data(); });
  }

  HWY_INLINE static Lane squared_distance(const LaneVertex& a, const LaneVertex& b) {
    const LanePoint edge = b.y - a.y;
    return dot(edge, edge);
  }

  // Returns the point where the edge between a wet and a dry corner meets the water, interpolated from the
  // wet corner to the dry one as in triangle_clip.h.
  HWY_INLINE static LaneVertex intersect_edge(LaneMask first_is_wet, const LaneVertex& first,
                                              const LaneVertex& second) {
    const LaneVertex wet = if_then_else(first_is_wet, first, second);
    const LaneVertex dry = if_then_else(first_is_wet, second, first);
    const Lane share = wet.z / (wet.z - dry.z);
    return {wet.y + share * (dry.y - wet.y), lane(0.0)};
  }

  // p is alone on its side: the wet part is the triangle at p, or the quadrilateral at q and r.
  template <typename Elements>
  HWY_INLINE static void clip(std::size_t part, const LaneVertex& p, const LaneVertex& q, const LaneVertex& r,
                              LaneMask present, Elements& elements) {
    const LaneMask p_wet = is_wet(p.z);
    const LaneVertex on_pq = intersect_edge(p_wet, p, q);
    const LaneVertex on_rp = intersect_edge(p_wet, p, r);
    elements.add(part, if_then_else(p_wet, p, on_pq), if_then_else(p_wet, on_pq, q),
                 if_then_else(p_wet, on_rp, r), IncludeSome{present});
    elements.add(part, on_pq, r, on_rp, IncludeSome{hn::AndNot(p_wet, present)});
  }

  using Triangle = std::array<std::array<double, 4>, 3>;  // x, y, z and height of p, q and r
  HWY_ALIGN std::array<Triangle, kEnough + kGroupTriangles * Meshlets::kMaxGroups> vertices_;
  std::size_t size_ = 0;
};

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_MESHLET_KERNELS_INL_H

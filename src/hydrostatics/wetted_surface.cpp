#include "hydrostatics/wetted_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "geometry/pairwise_sum.h"

// As in wetted_tree_sum.cpp, the target without SIMD is Highway's scalar one.
#define HWY_BROKEN_EMU128 1

// This file is compiled once per instruction set; the name is how it includes itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "hydrostatics/wetted_surface.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "hydrostatics/meshlet_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// Sums over all meshlets. Each meshlet's sum, and each batch of clipped triangles, is a block of the pairwise
// sum.
template <CutTriangles kCut, typename Elements>
HWY_INLINE typename Elements::Total sum_elements(const Meshlets& meshlets, const WaterPlane& plane,
                                                 Elements elements) {
  const HeightKernel kernel(plane);
  HWY_ALIGN std::array<double, Meshlets::kMaxVertices> heights;
  VertexRows rows;
  CutBatch batch;
  double edges_squared = 0.0;
  PairwiseSum<typename Elements::Total> total;
  for (const Meshlet& meshlet : meshlets.meshlets) {
    const std::uint64_t wet = kernel.find(meshlets, meshlet, heights.data());
    if (wet == 0) continue;
    rows.fill(meshlets, meshlet, heights.data());
    const CornerGroup* const groups = meshlets.groups.data() + meshlet.first_group;
    if (is_fully_submerged(meshlet, wet)) {
      add_submerged(groups, meshlet.groups, rows, elements);
    } else {
      const TriangleBits cut = add_crossing<kCut>(groups, meshlet.groups, rows, wet, elements);
      if constexpr (kCut == CutTriangles::kClip) batch.add(groups, cut, rows, wet);
    }
    total.add_block(elements.take());
    if (batch.is_full()) {
      edges_squared += batch.drain(elements);
      total.add_block(elements.take());
    }
  }
  if (!batch.is_empty()) {
    edges_squared += batch.drain(elements);
    total.add_block(elements.take());
  }
  typename Elements::Total result = total.total();
  result.cut_edges_squared = edges_squared;
  return result;
}

void sum_volumes(const Meshlets& meshlets, const WaterPlane& plane, const Vec3& apex, CutTriangles cut,
                 VolumeElementSum& sum) {
  sum = cut == CutTriangles::kClip ? sum_elements<CutTriangles::kClip>(meshlets, plane, VolumeLanes(apex))
                                   : sum_elements<CutTriangles::kBound>(meshlets, plane, VolumeLanes(apex));
}

void sum_pressures(const Meshlets& meshlets, const WaterPlane& plane, CutTriangles cut,
                   PressureElementSum& sum) {
  sum = cut == CutTriangles::kClip
            ? sum_elements<CutTriangles::kClip>(meshlets, plane, PressureLanes(plane.up_B))
            : sum_elements<CutTriangles::kBound>(meshlets, plane, PressureLanes(plane.up_B));
}

// Sums table elements, with each component of an element in a lane of its own, in four interleaved sums.
class TableLanes {
 public:
  HWY_INLINE TableLanes() { clear(); }

  HWY_INLINE void add(std::size_t sum, const TableElement& element) {
    for (std::size_t part = 0; part < kParts; ++part)
      sums_[sum][part] = sums_[sum][part] + hn::LoadU(Lanes(), element.data() + kLanes * part);
  }

  HWY_INLINE TableElement take() {
    TableElement total;
    for (std::size_t part = 0; part < kParts; ++part) {
      hn::StoreU((sums_[0][part] + sums_[1][part]) + (sums_[2][part] + sums_[3][part]), Lanes(),
                 total.data() + kLanes * part);
    }
    clear();
    return total;
  }

 private:
  HWY_INLINE void clear() {
    for (auto& parts : sums_) {
      for (Lane& part : parts) part = lane(0.0);
    }
  }

  std::array<std::array<Lane, kParts>, kGroupTriangles> sums_;
};

void sum_elements_of_table(const Meshlets& meshlets, const WaterPlane& plane,
                           const std::vector<TableElement>& elements, TableSum& sum) {
  const HeightKernel kernel(plane);
  HWY_ALIGN std::array<double, Meshlets::kMaxVertices> heights;
  TableLanes lanes;
  PairwiseSum<TableSum> total;
  for (const Meshlet& meshlet : meshlets.meshlets) {
    const std::uint64_t wet = kernel.find(meshlets, meshlet, heights.data());
    TableSum block;
    block.fully_submerged = is_fully_submerged(meshlet, wet);
    if (wet != 0) {
      for (std::size_t i = 0; i < meshlet.groups; ++i) {
        const std::size_t group = meshlet.first_group + i;
        const TableElement* const element = elements.data() + kGroupTriangles * group;
        if (block.fully_submerged) {
          for (std::size_t n = 0; n < kGroupTriangles; ++n) lanes.add(n, element[n]);
          continue;
        }
        const CornerGroup& corners = meshlets.groups[group];
        for (std::size_t n = 0; n < kGroupTriangles; ++n) {
          const auto wet_bit = [&](std::uint8_t corner) { return wet >> (corner / 4U) & 1U; };
          const std::uint64_t count = wet_bit(corners.a[n]) + wet_bit(corners.b[n]) + wet_bit(corners.c[n]);
          if (count == 3) lanes.add(n, element[n]);
          if (count == 1 || count == 2) block.cut_bound += std::abs(element[n][0]);
        }
      }
      block.wet = lanes.take();
    }
    total.add_block(block);
  }
  sum = total.total();
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace buoyancy {

HWY_EXPORT(sum_volumes);
HWY_EXPORT(sum_pressures);
HWY_EXPORT(sum_elements_of_table);

VolumeElementSum sum_volume_elements(const Meshlets& meshlets, const WaterPlane& plane, const Vec3& apex,
                                     CutTriangles cut) {
  VolumeElementSum sum;
  HWY_DYNAMIC_DISPATCH(sum_volumes)(meshlets, plane, apex, cut, sum);
  return sum;
}

PressureElementSum sum_pressure_elements(const Meshlets& meshlets, const WaterPlane& plane,
                                         CutTriangles cut) {
  PressureElementSum sum;
  HWY_DYNAMIC_DISPATCH(sum_pressures)(meshlets, plane, cut, sum);
  return sum;
}

TableSum sum_table(const Meshlets& meshlets, const WaterPlane& plane,
                   const std::vector<TableElement>& elements) {
  TableSum sum;
  HWY_DYNAMIC_DISPATCH(sum_elements_of_table)(meshlets, plane, elements, sum);
  return sum;
}

double rounding_of_cut_faces(const HydrostaticMesh& mesh, double cut_edges_squared) {
  if (mesh.meets_volume_tolerance()) return 0.0;
  return std::numeric_limits<double>::epsilon() * mesh.diagonal * cut_edges_squared;
}

}  // namespace buoyancy
#endif  // HWY_ONCE

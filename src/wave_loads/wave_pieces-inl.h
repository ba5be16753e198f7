// Pieces of large triangles, with SIMD. Included once per instruction set.
#if defined(BUOYANCY_WAVE_PIECES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_PIECES_INL_H
#undef BUOYANCY_WAVE_PIECES_INL_H
#else
#define BUOYANCY_WAVE_PIECES_INL_H
#endif

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <hwy/highway.h>

#include "wave_loads/wave_integrals-inl.h"
#include "wave_loads/wave_results-inl.h"
#include "wave_loads/wave_triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// Triangles of a vector of units, relative to their centroids.
template <typename Number>
struct PieceLanes {
  std::array<Vectors3<Number>, 3> corners;
  Vectors3<Number> center;
  VectorOf<Number> radius;
};

// A bound on the norm of the mean of y_i y_j y_l over a triangle. mid: its centroid, which is 0 up to
// rounding; mean2: the mean of |y|^2. About the centroid the mean is the symmetric part of the product of the
// corners over 10. The square of that part's norm is the permanent of the corners' Gram matrix over 6, which
// is at least the product of its diagonal.
template <typename Number>
HWY_INLINE VectorOf<Number> norm_of_mean_cubes(const std::array<Vectors3<Number>, 3>& corners,
                                               const Vectors3<Number>& mid, const VectorOf<Number>& mean2) {
  using V = VectorOf<Number>;
  const V aa = dot<Number>(corners[0], corners[0]);
  const V bb = dot<Number>(corners[1], corners[1]);
  const V cc = dot<Number>(corners[2], corners[2]);
  const V ab = dot<Number>(corners[0], corners[1]);
  const V bc = dot<Number>(corners[1], corners[2]);
  const V ca = dot<Number>(corners[2], corners[0]);
  const V permanent =
      aa * hn::MulAdd(bb, cc, bc * bc) + bb * ca * ca + cc * ab * ab + set<Number>(2.0) * ab * bc * ca;
  const V about_mid = hn::Sqrt(hn::Max(permanent, set<Number>(0.0)) * set<Number>(1.00001 / 600.0));
  return hn::MulAdd(set<Number>(3.00001) * hn::Sqrt(dot<Number>(mid, mid)), mean2, about_mid);
}

// The mean of |y|^2 over triangles about their centroids, from the corners, rounded up.
template <typename Number>
HWY_INLINE VectorOf<Number> mean_square(const std::array<Vectors3<Number>, 3>& corners) {
  const VectorOf<Number> sum = dot<Number>(corners[0], corners[0]) + dot<Number>(corners[1], corners[1]) +
                               dot<Number>(corners[2], corners[2]);
  return sum * set<Number>(1.000001 / 12.0);
}

// The root mean square of the distance from the centroid, over the largest.
template <typename Number>
HWY_INLINE VectorOf<Number> spread_of(const PieceLanes<Number>& piece) {
  return hn::Min(hn::Sqrt(mean_square<Number>(piece.corners)) / piece.radius, set<Number>(1.0));
}

// The integrals over pieces, and the bounds on their errors.
template <typename Number>
HWY_INLINE PatchIntegrals<Number> integrate(const PatchQuery<Number>& query, const PieceLanes<Number>& piece,
                                            const PatchModel<Number>& model) {
  using V = VectorOf<Number>;
  TriangleLanes<Number> t;
  t.corners = piece.corners;
  t.phi = model.phi;
  t.s = model.s;
  t.curvature = model.curvature;
  t.whole = model.whole;
  t.none = model.dry;
  const Vectors3<Number> lever = piece.center - axis_of<Number>(query.reference);
  PatchIntegrals<Number> result =
      to_patch<Number>(integrate<Number>(query, t), lever, piece.center, piece.radius, model.s_per_phi);
  const Vectors3<Number> normal = cross<Number>(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]);
  const V area = set<Number>(0.500001) * hn::Sqrt(dot<Number>(normal, normal));
  V fourth = set<Number>(0.0);
  for (const Vectors3<Number>& corner : t.corners) {
    const V squared = dot<Number>(corner, corner);
    fourth = hn::MulAdd(squared, squared, fourth);
  }
  // The means of |y|^2 and |y|^4 over a triangle, about its centroid.
  const V mean2 = mean_square<Number>(t.corners);
  const V mean4 = fourth * set<Number>(1.000001 / 30.0);
  const V mean3 = hn::Sqrt(mean2 * mean4);
  const Vectors3<Number> mid =
      scaled<Number>(set<Number>(1.0 / 3.0), t.corners[0] + t.corners[1] + t.corners[2]);
  const DistanceMoments<Number> distances{area * mean3, area * mean4,
                                          area * norm_of_mean_cubes<Number>(t.corners, mid, mean2)};
  const V cubic = cubic_remainder<Number>(distances, model.third, model.cubic, model.wet);
  const V remainder = hn::MulAdd(area, model.mean_delta, cubic);
  const V local =
      hn::MulAdd(area * model.delta, hn::Sqrt(mean2), set<Number>(1.0 / 6.0) * model.third * distances.mu4);
  // Of a whole triangle, the norm of its third moments bounds what the offsets leave out.
  const V of_offset = set<Number>(0.70710678) * model.curvature * distances.nu3;
  result.torque_error =
      hn::IfThenElse(model.wet, hn::Min(of_offset, result.torque_error), result.torque_error);
  const V quarter = set<Number>(0.25);
  result.force_error = result.force_error + remainder;
  const V of_clipping = quarter * quarter * (result.force_error - remainder);
  // The order of the operands matters where the first is not a number.
  result.expected = hn::Min(expected_remainder<Number>(distances, model) +
                                hn::MulAdd(quarter * model.delta_of_parts, area, of_clipping),
                            quarter * result.force_error);
  result.torque_error =
      result.torque_error + hn::MulAdd(hn::Sqrt(dot<Number>(lever, lever)), remainder, local);
  result.volume_error = hn::MulAdd(model.s_per_phi, remainder, result.volume_error) +
                        volume_remainder<Number>(area, distances, model);
  return result;
}

// Triangles of the mesh that are too large for one model, and parts of them. Four lie side by side, as in the
// tree.
template <typename Number>
class Pieces {
 public:
  void clear() {
    blocks_.clear();
    count_ = 0;
    taken_ = 0;
  }

  // Adds the triangles of a leaf, cut until their radii are at most `largest` [m].
  void add_triangles(const PatchTree& tree, const PatchBlock& block, std::size_t lane, double largest) {
    for (std::uint32_t b = 0; b < block.triangle_blocks[lane]; ++b) {
      const TriangleBlock& triangles = tree.triangles[block.child[lane] + b];
      for (std::size_t i = 0; i < kSiblings; ++i) {
        Piece piece;
        bool point = true;
        for (std::size_t row = 0; row < kRows; ++row) {
          const float from_center = triangles.corners[row][i];
          point &= from_center == triangles.corners[row % 3][i];
          piece[row] = static_cast<Number>(block.center[row % 3][lane]) + static_cast<Number>(from_center);
        }
        if (!point) cut(shaped(piece), static_cast<Number>(largest * largest));
      }
    }
    fill_unit();
  }

  // Adds the four quarters of a piece: it and its halves are bisected across their longest edges. They are
  // neighbours, so that they fill a unit. unit: of pieces.
  void quarter(const Unit& unit, std::size_t lane) {
    bisect(shaped(read(unit.block, lane)), [this](const ShapedPiece& half) {
      bisect(half, [this](const ShapedPiece& quarter) { add(quarter.corners); });
    });
    fill_unit();
  }

  std::size_t new_count() const { return count_ - taken_; }  // added since the last call of take_new()

  // Calls take(unit) for the units of the pieces that were added since the last call.
  template <typename Take>
  void take_new(const Take& take) {
    for (; taken_ < count_; taken_ += kUnit<Number>) {
      Unit unit;
      unit.block = static_cast<std::uint32_t>(taken_ / kSiblings);
      unit.first = static_cast<std::uint32_t>(taken_ % kSiblings);
      unit.of_pieces = true;
      take(unit);
    }
  }

  PieceLanes<Number> lanes(const UnitsOfVector<Number>& units) const {
    const auto row = [&](std::size_t r) HWY_ATTR {
      return gather_units<Number>(
          [&](std::size_t n) { return blocks_[units[n].block].rows[r].data() + units[n].first; });
    };
    PieceLanes<Number> piece;
#pragma GCC unroll 3
    for (std::size_t i = 0; i < 3; ++i) piece.corners[i] = {row(3 * i), row(3 * i + 1), row(3 * i + 2)};
    piece.center =
        scaled<Number>(set<Number>(1.0 / 3.0), piece.corners[0] + piece.corners[1] + piece.corners[2]);
    VectorOf<Number> far = set<Number>(0.0);
    for (Vectors3<Number>& corner : piece.corners) {
      corner = corner - piece.center;
      far = hn::Max(far, dot<Number>(corner, corner));
    }
    piece.radius = hn::Sqrt(far) * set<Number>(1.000001);
    return piece;
  }

 private:
  // Corner by corner, along the axes; relative to c.
  static constexpr std::size_t kRows = 9;
  using Piece = std::array<Number, kRows>;
  struct Block {
    alignas(16) std::array<std::array<Number, kSiblings>, kRows> rows;
  };

  void add(const Piece& piece) {
    if (count_ % kSiblings == 0) blocks_.emplace_back();
    for (std::size_t row = 0; row < kRows; ++row) blocks_.back().rows[row][count_ % kSiblings] = piece[row];
    ++count_;
  }
  Piece read(std::uint32_t block, std::size_t lane) const {
    Piece piece;
    for (std::size_t row = 0; row < kRows; ++row) piece[row] = blocks_[block].rows[row][lane];
    return piece;
  }

  // Fills the last unit with points: nothing is integrated over them.
  void fill_unit() {
    if (count_ % kUnit<Number> == 0) return;
    Piece point = read(static_cast<std::uint32_t>((count_ - 1) / kSiblings), (count_ - 1) % kSiblings);
    for (std::size_t row = 3; row < kRows; ++row) point[row] = point[row % 3];
    while (count_ % kUnit<Number> != 0) add(point);
  }

  // With the squares of its edges' lengths: edge i leads from corner i to the next. Those of parts follow
  // from them, so that nothing else is computed of a part that is cut on.
  struct ShapedPiece {
    Piece corners;
    std::array<Number, 3> squares;

    // From the centroid to the farthest corner, which is opposite the shortest edge.
    Number squared_radius() const {
      const Number shortest = std::min(squares[0], std::min(squares[1], squares[2]));
      return (2 * (squares[0] + squares[1] + squares[2]) - 3 * shortest) / 9;
    }
  };

  static ShapedPiece shaped(const Piece& corners) {
    ShapedPiece piece{corners, {}};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Number difference = corners[3 * ((i + 1) % 3) + axis] - corners[3 * i + axis];
        piece.squares[i] += difference * difference;
      }
    }
    return piece;
  }

  // Adds the parts of a piece in an order in which neighbours follow each other.
  void cut(const ShapedPiece& piece, Number largest_squared) {
    // A needle of a small area may be longer than any number of pieces.
    if (piece.squared_radius() <= largest_squared || new_count() > kMaxUnits) {
      add(piece.corners);
    } else {
      bisect(piece, [&](const ShapedPiece& half) { cut(half, largest_squared); });
    }
  }

  // Calls take() for the halves on both sides of the median of the longest edge.
  template <typename Take>
  static HWY_INLINE void bisect(const ShapedPiece& piece, const Take& take) {
    const auto& squares = piece.squares;
    std::size_t longest = squares[1] > squares[0] ? 1 : 0;
    if (squares[2] > squares[longest]) longest = 2;
    const std::size_t next = (longest + 1) % 3;
    const std::size_t last = (longest + 2) % 3;
    ShapedPiece first = piece;
    ShapedPiece second = piece;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Number middle =
          Number{0.5} * (piece.corners[3 * longest + axis] + piece.corners[3 * next + axis]);
      first.corners[3 * next + axis] = middle;
      second.corners[3 * longest + axis] = middle;
    }
    first.squares[longest] = second.squares[longest] = squares[longest] / 4;
    first.squares[next] = second.squares[last] =
        std::max((2 * (squares[next] + squares[last]) - squares[longest]) / 4, Number{0});
    take(first);
    take(second);
  }

  std::vector<Block> blocks_;
  std::size_t count_ = 0;
  std::size_t taken_ = 0;
};

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_PIECES_INL_H

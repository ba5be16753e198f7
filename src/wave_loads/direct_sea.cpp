#include "wave_loads/direct_sea.h"

#include <cmath>
#include <limits>

namespace buoyancy {

template <typename Number>
void DirectSea<Number>::prepare(const SeaSnapshot& snapshot, double center_x1, double center_x2,
                                std::vector<double>& scratch) {
  constexpr double kPerTurn = 0.15915494309189535;     // 1 / (2 pi)
  constexpr double kPerDoubling = 1.4426950408889634;  // 1 / ln 2
  const PreparedComponents& waves = snapshot.sea().prepared();
  const double depth = snapshot.sea().depth();
  const bool deep = std::isinf(depth);
  surface = snapshot.surface().count > 0 ? &snapshot.surface() : nullptr;
  x1 = center_x1;
  x2 = center_x2;
  snapshot.phases_at(x1, x2, scratch);
  per_depth = static_cast<Number>(deep ? 0.0 : 1.0 / depth);
  bed = deep ? std::numeric_limits<Number>::lowest() : static_cast<Number>(-depth);
  components.clear();
  groups.clear();
  for (std::size_t i = 0; i < waves.size(); ++i) {
    const double k = waves.wave_number[i];
    if (i == 0 || k != waves.wave_number[i - 1] || components.size() % kMaxGroup == 0) {
      // The second term is at most exp(-k h), at the bed.
      constexpr double kNegligible = 40.0;
      groups.push_back({0, k * depth < kNegligible, static_cast<Number>(k * kPerDoubling),
                        static_cast<Number>(deep ? 0.0 : 2.0 * k * depth * kPerDoubling),
                        static_cast<Number>(deep ? 1.0 : 1.0 / (1.0 + std::exp(-2.0 * k * depth)))});
    }
    components.push_back({static_cast<Number>(waves.k1[i] * kPerTurn),
                          static_cast<Number>(waves.k2[i] * kPerTurn),
                          static_cast<Number>(scratch[i] * kPerTurn),
                          static_cast<Number>(snapshot.amplitude_factor() * waves.amplitude[i])});
    groups.back().end = static_cast<std::uint32_t>(components.size());
  }
}

template struct DirectSea<float>;
template struct DirectSea<double>;

}  // namespace buoyancy

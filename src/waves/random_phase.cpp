#include "waves/random_phase.h"

#include <numeric>
#include <utility>

namespace buoyancy {
namespace {

std::array<std::uint32_t, 2> key_of(std::uint64_t seed) {
  return {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U)};
}

// The third word of the counter keeps the random numbers of phases and of orders apart.
constexpr std::uint32_t kPhases = 0;
constexpr std::uint32_t kOrders = 1;

}  // namespace

std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) {
  constexpr int kRounds = 10;
  constexpr std::uint64_t kMultiplier0 = 0xD2511F53;
  constexpr std::uint64_t kMultiplier1 = 0xCD9E8D57;
  constexpr std::uint32_t kWeyl0 = 0x9E3779B9;
  constexpr std::uint32_t kWeyl1 = 0xBB67AE85;
  const auto high = [](std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32U); };
  const auto low = [](std::uint64_t x) { return static_cast<std::uint32_t>(x); };
  for (int round = 0; round < kRounds; ++round) {
    const std::uint64_t product0 = kMultiplier0 * counter[0];
    const std::uint64_t product1 = kMultiplier1 * counter[2];
    counter = {high(product1) ^ counter[1] ^ key[0], low(product1), high(product0) ^ counter[3] ^ key[1],
               low(product0)};
    key[0] += kWeyl0;
    key[1] += kWeyl1;
  }
  return counter;
}

double random_phase(std::uint64_t seed, std::uint32_t system, std::uint32_t component) {
  const auto [first, second, third, fourth] = philox({component, system, kPhases, 0}, key_of(seed));
  const std::uint64_t bits = (std::uint64_t{first} << 32U | second) >> 11U;  // 53
  return 360.0 * (static_cast<double>(bits) * 0x1p-53);
}

std::vector<std::size_t> random_order(std::uint64_t seed, std::uint32_t system, std::uint32_t group,
                                      std::size_t count) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  // The shuffle of R. A. Fisher and F. Yates: from the last place on, each gets one of the numbers left.
  for (std::size_t left = count; left > 1; --left) {
    const std::uint64_t random =
        philox({group, system, kOrders, static_cast<std::uint32_t>(left)}, key_of(seed))[0];
    std::swap(order[left - 1], order[random * left >> 32U]);
  }
  return order;
}

}  // namespace buoyancy

// Random phases and orders of wave components. The generator is counter-based, so that a phase depends on
// nothing but the seed and the component's place.
//
// Source: J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw, "Parallel random numbers: as easy as 1, 2, 3",
// SC11: Philox4x32-10.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace buoyancy {

// Philox4x32-10.
std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key);

// Returns a phase [deg], uniform in [0, 360) and the same on every machine.
double random_phase(std::uint64_t seed, std::uint32_t system, std::uint32_t component);

// Returns the numbers from 0 to count - 1 in an order that depends on the seed, the system and the group, and
// is the same on every machine. count: below 2^32.
std::vector<std::size_t> random_order(std::uint64_t seed, std::uint32_t system, std::uint32_t group,
                                      std::size_t count);

}  // namespace buoyancy

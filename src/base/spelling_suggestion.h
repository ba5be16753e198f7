// Finds the word that a mistyped one was most likely meant to be.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace buoyancy {

// How many letters must be inserted, deleted, replaced or swapped with their neighbour to make one word the
// other (optimal string alignment). O(|a| |b|).
std::size_t edit_distance(std::string_view a, std::string_view b);

// The candidate at the least edit distance, the first of equals; candidates: at least one.
std::string_view nearest_word(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace buoyancy

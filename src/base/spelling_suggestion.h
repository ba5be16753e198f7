// Suggests the known word that a misspelt word most likely stands for.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace buoyancy {

// Returns the number of insertions, deletions, replacements and swaps of neighbouring letters that turn one
// word into the other (optimal string alignment). Complexity: O(|a| |b|).
std::size_t edit_distance(std::string_view a, std::string_view b);

// Returns the candidate at the smallest edit distance, the first one of a tie. Requires a candidate.
std::string_view nearest_word(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace buoyancy

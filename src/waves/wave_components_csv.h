// Reads wave components from CSV. The first line is exactly the header
//   amplitude,angular_frequency,direction,phase
// in m, rad/s, degrees and degrees (sea_description.h). Each further line is a component. Spaces around
// fields and blank lines are ignored. Numbers that were written with 17 digits are read as the same doubles.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/error.h"
#include "waves/sea_description.h"

namespace buoyancy {

// Errors: no such file, not a regular file, not readable, too large; those of parse_wave_components().
Expected<WaveComponents> read_wave_components(const std::filesystem::path& path);

// name: identifies the text in errors. Errors name line and column: another header, a number of fields other
// than four, a field that is no number in its range, more than kMaxWaveComponents components.
Expected<WaveComponents> parse_wave_components(std::string_view text, const std::string& name);

}  // namespace buoyancy

// Loads as CSV: one row per body that has this output, numbers as in wrench_csv.h. status is the number in
// the message, 0 for OK.
#pragma once

#include <string>

#include "messages/loads.h"

namespace buoyancy::service {

// The header line: utime, body_id, status, immersion; force and torque of buoyancy, drag and added mass; the
// water's velocity; the matrices row by row, added_mass_11 to added_mass_66 and damping_11 to damping_66.
const std::string& loads_csv_header();

// Sets row to one line including its newline.
void format_loads_row(std::int64_t utime, const BodyLoads& loads, std::string& row);

}  // namespace buoyancy::service

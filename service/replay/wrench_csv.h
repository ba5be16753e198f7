// Wrenches as CSV: a row per body, numbers with 17 significant digits, which is what it takes to read the
// same double back. status is the number that the message carries, 0 for OK.
#pragma once

#include <string>
#include <string_view>

#include "messages/request.h"

namespace buoyancy {

inline constexpr std::string_view kWrenchCsvHeader =
    "utime,body_id,status,fx,fy,fz,tx,ty,tz,volume,bx,by,bz,force_error_bound,torque_error_bound\n";

// Replaces row by one line with its newline. bx, by, bz: the centre of buoyancy, relative to the body's
// position.
void format_wrench_row(std::int64_t utime, const BodyWrench& wrench, std::string& row);

}  // namespace buoyancy

// Wrenches as CSV: one row per body, numbers with 17 significant digits, so that reading them back gives the
// same double. status is the number in the message, 0 for OK.
#pragma once

#include <string>
#include <string_view>

#include "messages/request.h"

namespace buoyancy::service {

inline constexpr std::string_view kWrenchCsvHeader =
    "utime,body_id,status,fx,fy,fz,tx,ty,tz,volume,bx,by,bz,force_error_bound,torque_error_bound\n";

// Sets row to one line including its newline. bx, by, bz: the centre of buoyancy relative to the body's
// position [m].
void format_wrench_row(std::int64_t utime, const BodyWrench& wrench, std::string& row);

}  // namespace buoyancy::service

// The state of BusMonitor as the JSON texts that the live page reads. Numbers that are NaN or infinite are
// null; numbers of bodies have float precision, except positions; 64-bit ids are strings, since JavaScript
// represents integers exactly only up to 2^53.
#pragma once

#include <cstdint>
#include <string>

#include "view/live/bus_monitor.h"

namespace buoyancy::view {

// One line, without a line break:
//
//   number         of this snapshot
//   time           [s since 1970]
//   listening      [s since the start]
//   bodies         those with a pose, each
//                    id
//                    status       a BodyStatus as a number
//                    p, q         [3], [w, x, y, z]
//                    f, t         [3]
//                    b            [3], the centre of buoyancy
//                    m, gm        [[3], [3]], the metacentres, and [2], the metacentric heights
//                    volume, force_bound, torque_bound
//                    loads        only where loads were received for the body: "immersion", 0 to 1;
//                                 "buoyancy", "drag" and "added_mass": [6], a force [N] and a torque [N m];
//                                 "water_velocity": [3] [m/s]. Absent as long as the latest loads have a
//                                 status other than OK or numbers that are not finite, or are overdue like a
//                                 response
//                    condition    only of a body with compartments or tanks, and only if a condition was
//                                 received for any: "flooded": [0 to 1], "liquid_volumes": [m^3], at the time
//                                 of the latest request; null: unknown
//                    age          [s] since the latest request for the body
//                  b and m are relative to p in W's axes. From f to torque_bound, null means: no response
//                  yet, or none since BusMonitor::kResponseTimeout; status, b, volume and the bounds are also
//                  null if the response was a six_axis_force_torque_t
//   service        to_string(ServiceState)
//   services       the instance ids seen within BusMonitor::kStatusTimeout
//   status         the latest service_status_t, or null
//   status_age, response_age, request_age   [s], or null
//   second         the last complete second, same as in history_json, or null
//   latency        p50, p99, p999, max [s] since the start
//   sea_time       [s], in waves only: the time t of the sea at the latest request; null if there is no
//                  request, or no sea has been received that holds at its time
//   counts         BusMonitor::Counts and RequestTracker::Counts; "conditions_rejected" only if the scene has
//                  compartments or tanks
std::string snapshot_json(const BusMonitor& monitor, std::int64_t number, double time, double listening,
                          double now);

// The last minute: an array, the latest second last, of {"number", "requests", "responses", "unanswered",
// "p50", "p99", "max"}; the last three are null for a second without responses.
std::string history_json(const BusMonitor& monitor);

}  // namespace buoyancy::view

// What BusMonitor knows, as the JSON texts that the live page reads. Numbers that are NaN or infinite are
// null; numbers of bodies have float's precision, which is more than a screen shows; ids of 64 bits are
// strings, since JavaScript's numbers end at 2^53.
#pragma once

#include <cstdint>
#include <string>

#include "view/live/bus_monitor.h"

namespace buoyancy {

// One line, without a line break:
//
//   number         of this snapshot
//   time           s since 1970
//   listening      s since the start
//   bodies         those whose pose was heard, each
//                    id
//                    status       a BodyStatus as a number
//                    p, q         [3], [w, x, y, z]
//                    f, t         [3]
//                    b            [3], the centre of buoyancy
//                    m, gm        [[3], [3]], the metacentres, and [2], their heights
//                    volume, force_bound, torque_bound
//                    age          s since the body was asked about
//                  b and m relative to p in W's axes. null: from f to torque_bound what was not answered, not
//                  yet or not since BusMonitor::kResponseTimeout; status, b, volume and the bounds too where
//                  a six_axis_force_torque_t answered
//   service        as to_string(ServiceState)
//   services       the instance ids heard within 3 s
//   status         the newest service_status_t, or null
//   status_age, answer_age, question_age   s, or null
//   second         the last whole second, as in history_json, or null
//   latency        p50, p99, p999, max: s, since the start
//   counts         as BusMonitor counts
std::string snapshot_json(const BusMonitor& watch, std::int64_t number, double time, double listening,
                          double now);

// The last minute: an array, the newest last, of {"number", "requests", "answers", "unanswered", "p50",
// "p99", "max"}; the last three null where nothing was answered.
std::string history_json(const BusMonitor& watch);

}  // namespace buoyancy

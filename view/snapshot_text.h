// What BusWatch knows, as the JSON texts that the live page reads. Numbers that are NaN or infinite are null;
// numbers of bodies have float's precision, which is more than a screen shows; ids of 64 bits are strings,
// since JavaScript's numbers end at 2^53.
#pragma once

#include <cstdint>
#include <string>

#include "view/bus_watch.h"

namespace buoyancy {

// One line, without a line break:
//   "number"             of this snapshot, "time": s since 1970, "listening": s since the start
//   "bodies"             those whose pose was heard, each {"id", "status": BodyStatus as a number or null
//   before the first
//                        answer, "p": [3], "q": [w, x, y, z], "f": [3] | null, "t": [3] | null,
//                        "b": [3] | null, "m": [[3], [3]] | null, "gm": [2] | null, "volume", "force_bound",
//                        "torque_bound", "age": s since the body was asked about}. b: centre of buoyancy, m:
//                        metacentres, relative to p in W's axes
//   "service"            as name(ServiceState); "services": the instance ids heard within 3 s
//   "status"             the newest service_status_t | null; "status_age", "answer_age", "question_age": s |
//   null "second"             the last whole second, as in history_json | null "latency"            {"p50",
//   "p99", "p999", "max"} s, since the start "counts"             as BusWatch counts
std::string snapshot_json(const BusWatch& watch, std::int64_t number, double time, double listening,
                          double now);

// The last minute: an array, the newest last, of {"number", "questions", "answers", "unanswered", "p50",
// "p99", "max"}; the last three null where nothing was answered.
std::string history_json(const BusWatch& watch);

}  // namespace buoyancy

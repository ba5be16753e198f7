// buoyancy.read_log: recorded poses and wrenches as arrays.

#include <cstdint>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <pybind11/stl.h>

#include "base/csv_field.h"
#include "messages/body_csv.h"
#include "messages/wire.h"
#include "messages/wire_views.h"
#include "python/call_arguments.h"
#include "python/module.h"
#include "python/result_array.h"
#include "recording/event_log.h"
#include "recording/sequence_gaps.h"
#include "recording/state_csv.h"

namespace buoyancy::python {
namespace {

// A column per field, a row per body of every message.
struct Columns {
  std::vector<std::int64_t> timestamp, utime, session_id, seq;
  std::vector<std::int32_t> body_id, status;
  std::vector<double> lead_time, position, quaternion, linear_velocity, angular_velocity;
  std::vector<double> force, torque, volume, center_of_buoyancy, force_error_bound, torque_error_bound;

  void add(std::int64_t at, const RequestId& id, std::int32_t body) {
    timestamp.push_back(at);
    utime.push_back(id.utime);
    session_id.push_back(id.session_id);
    seq.push_back(id.seq);
    body_id.push_back(body);
  }
};

template <std::size_t kCount>
void append(const std::array<double, kCount>& values, std::vector<double>& column) {
  column.insert(column.end(), values.begin(), values.end());
}

struct Log {
  Columns states, wrenches;
  std::vector<std::string> corrupt_sections;
  SequenceGaps requests, responses;
  std::int64_t rejected = 0;  // messages on the channels that are none of the expected type
};

// The part of a log that holds states or wrenches; keeps the log alive.
struct StatesView {
  py::object log;
};
struct WrenchesView {
  py::object log;
};

void add_request(std::int64_t timestamp, Bytes bytes, Log& log) {
  const auto request = RequestView::of(bytes);
  if (!request) {
    ++log.rejected;
    return;
  }
  log.requests.add(request->id().session_id, request->id().seq);
  for (std::size_t i = 0; i < request->size(); ++i) {
    const BodyState state = request->body(i);
    log.states.add(timestamp, request->id(), state.body_id);
    log.states.lead_time.push_back(request->lead_time());
    append(state.position, log.states.position);
    append(state.quaternion_wxyz, log.states.quaternion);
    append(state.linear_velocity, log.states.linear_velocity);
    append(state.angular_velocity, log.states.angular_velocity);
  }
}

void add_wrench(std::int64_t timestamp, const RequestId& id, const BodyWrench& wrench, Columns& columns) {
  columns.add(timestamp, id, wrench.body_id);
  columns.status.push_back(static_cast<std::int32_t>(wrench.status));
  append(wrench.force, columns.force);
  append(wrench.torque, columns.torque);
  columns.volume.push_back(wrench.submerged_volume);
  append(wrench.center_of_buoyancy, columns.center_of_buoyancy);
  columns.force_error_bound.push_back(wrench.force_error_bound);
  columns.torque_error_bound.push_back(wrench.torque_error_bound);
}

// Reads all items of a log or a CSV file, and what could not be read.
template <typename Reader, typename OnEvent>
void read_items(Reader& reader, Log& log, OnEvent on_event) {
  while (true) {
    LogItem item = reader.next();
    if (std::holds_alternative<EndOfLog>(item)) return;
    if (auto* const corrupt = std::get_if<CorruptSection>(&item)) {
      log.corrupt_sections.push_back(std::move(corrupt->description));
    } else if (const auto* const event = std::get_if<RecordedEvent>(&item)) {
      on_event(*event);
    }
  }
}

void read_event_log(const std::string& path, const std::string& states_channel,
                    const std::string& wrenches_channel, Log& log) {
  EventLogReader reader = value_or_throw(EventLogReader::open(path, [&](std::string_view channel) {
    return channel == states_channel || channel == wrenches_channel;
  }));
  WrenchResponse response;
  read_items(reader, log, [&](const RecordedEvent& event) {
    if (event.channel == states_channel) return add_request(event.timestamp, event.bytes, log);
    if (decode(event.bytes, response)) {
      ++log.rejected;
      return;
    }
    log.responses.add(response.id.session_id, response.id.seq);
    for (const BodyWrench& wrench : response.bodies)
      add_wrench(event.timestamp, response.id, wrench, log.wrenches);
  });
  if (const std::optional<Error>& error = reader.file().read_error()) throw InputException(*error);
}

// False for another number of fields than the header has, or a field that is no number.
bool parse_wrench_row(std::string_view line, std::int64_t& utime, BodyWrench& wrench) {
  CsvFields fields(line);
  bool good = true;
  const auto read = [&fields, &good](auto& number) {
    const std::optional<std::string_view> field = fields.next();
    good = good && field && parse_number(*field, number);
  };
  read(utime);
  visit_numbers(wrench, kAllFields, [&read]<typename Number>(Number& number) {
    if constexpr (std::is_enum_v<Number>) {
      std::int32_t value = 0;
      read(value);
      number = static_cast<Number>(value);
    } else {
      read(number);
    }
  });
  return good && !fields.next();
}

void read_wrench_csv(std::ifstream& file, Log& log) {
  std::string line;
  for (std::int64_t number = 2; std::getline(file, line); ++number) {
    if (trim(line).empty()) continue;
    std::int64_t utime = 0;
    BodyWrench wrench;
    if (parse_wrench_row(line, utime, wrench)) {
      add_wrench(utime, {utime, kCsvSession, 0}, wrench, log.wrenches);
    } else {
      log.corrupt_sections.push_back("line " + std::to_string(number) +
                                     ": expected the numbers of the header, found " + quote(line));
    }
  }
}

void read_csv(const std::string& path, Log& log) {
  std::ifstream file(path);
  std::string header;
  if (std::getline(file, header)) {
    std::string_view text = header;
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    if (trim(text) == csv_header<BodyWrench>()) return read_wrench_csv(file, log);
  }
  StateCsvReader reader = value_or_throw(StateCsvReader::open(path));
  read_items(reader, log,
             [&](const RecordedEvent& event) { add_request(event.timestamp, event.bytes, log); });
  if (const std::optional<Error>& error = reader.file().read_error()) throw InputException(*error);
}

std::unique_ptr<Log> read_log(const py::object& file, const std::string& states_channel,
                              const std::string& wrenches_channel) {
  const std::string path = to_path(file);
  auto log = std::make_unique<Log>();
  const WithoutGil released;
  if (path.ends_with(".csv")) {
    read_csv(path, *log);
  } else if (path.ends_with(".lcmlog")) {
    read_event_log(path, states_channel, wrenches_channel, *log);
  } else {
    throw InputException(
        {path, "an unknown type of file", "a name that ends in .lcmlog or .csv", "", "Rename it"});
  }
  return log;
}

// Adds a property (rows, width), or (rows,) for a width of 1.
template <typename View, typename Number>
void add_column(py::class_<View>& type, const char* name, Columns Log::*table,
                std::vector<Number> Columns::*column, Py_ssize_t width, const char* doc) {
  type.def_property_readonly(
      name,
      [=](py::handle self) {
        const py::object& owner = instance_of<View>(self).log;
        std::vector<Number>& values = instance_of<Log>(owner).*table.*column;
        std::vector<Py_ssize_t> shape{static_cast<Py_ssize_t>(values.size()) / width};
        if (width > 1) shape.push_back(width);
        return make_array(std::move(shape), values.data(), owner);
      },
      doc);
}

template <typename View>
void add_common_columns(py::class_<View>& type, Columns Log::*table) {
  type.def("__len__", [=](py::handle self) {
    return (instance_of<Log>(instance_of<View>(self).log).*table).utime.size();
  });
  add_column(type, "timestamp", table, &Columns::timestamp, 1,
             "(N,) int64, us: when it was recorded; of a CSV the utime.");
  add_column(type, "utime", table, &Columns::utime, 1, "(N,) int64, us: of the message.");
  add_column(type, "session_id", table, &Columns::session_id, 1, "(N,) int64.");
  add_column(type, "seq", table, &Columns::seq, 1, "(N,) int64: equal for the bodies of one message.");
  add_column(type, "body_id", table, &Columns::body_id, 1, "(N,) int32.");
}

py::dict to_dict(const SequenceGaps& gaps) {
  py::dict sessions;
  for (const SequenceGaps::Session& session : gaps.incomplete_sessions()) {
    py::list ranges;
    for (const SequenceGaps::Gap& gap : session.gaps) ranges.append(py::make_tuple(gap.first, gap.last));
    sessions[py::int_(session.session_id)] = ranges;
  }
  return sessions;
}

constexpr const char* kReadLogDoc =
    "read_log(path, *, states_channel='BUOYANCY_STATES', wrenches_channel='BUOYANCY_WRENCHES')\n--\n\n"
    "The poses and wrenches that a file holds: a Log.\n\n"
    "path: an .lcmlog of lcm-logger or buoyancy-replay, or a .csv of buoyancy-replay, poses or wrenches. "
    "What is corrupt\n"
    "is skipped and listed in Log.corrupt_sections. Raises InputError for a file that cannot be read, and "
    "for a\n"
    "CSV file with another header.";

}  // namespace

void define_log(py::module_& module) {
  py::class_<StatesView> states(
      module, "RecordedStates",
      "The states of a Log: one row per body of every request, in the order of the file.");
  add_common_columns(states, &Log::states);
  add_column(states, "lead_time", &Log::states, &Columns::lead_time, 1, "(N,), s.");
  add_column(states, "position", &Log::states, &Columns::position, 3, "(N, 3), m, world frame.");
  add_column(states, "quaternion", &Log::states, &Columns::quaternion, 4, "(N, 4), (w, x, y, z).");
  add_column(states, "linear_velocity", &Log::states, &Columns::linear_velocity, 3, "(N, 3), m/s.");
  add_column(states, "angular_velocity", &Log::states, &Columns::angular_velocity, 3, "(N, 3), rad/s.");
  py::class_<WrenchesView> wrenches(
      module, "RecordedWrenches",
      "The wrenches of a Log: one row per body of every response, in the order of the file.");
  add_common_columns(wrenches, &Log::wrenches);
  add_column(wrenches, "status", &Log::wrenches, &Columns::status, 1, "(N,) int32: see Status.");
  add_column(wrenches, "force", &Log::wrenches, &Columns::force, 3, "(N, 3), N.");
  add_column(wrenches, "torque", &Log::wrenches, &Columns::torque, 3, "(N, 3), N m.");
  add_column(wrenches, "volume", &Log::wrenches, &Columns::volume, 1, "(N,), m^3.");
  add_column(wrenches, "center_of_buoyancy", &Log::wrenches, &Columns::center_of_buoyancy, 3,
             "(N, 3), m, relative to the position.");
  add_column(wrenches, "force_error_bound", &Log::wrenches, &Columns::force_error_bound, 1, "(N,), N.");
  add_column(wrenches, "torque_error_bound", &Log::wrenches, &Columns::torque_error_bound, 1, "(N,), N m.");

  py::class_<Log> log(module, "Log", "What read_log() found in a file.");
  log.def_property_readonly(
      "states",
      [](const py::object& self) {
        instance_of<Log>(self);
        return std::make_unique<StatesView>(StatesView{self});
      },
      "RecordedStates.");
  log.def_property_readonly(
      "wrenches",
      [](const py::object& self) {
        instance_of<Log>(self);
        return std::make_unique<WrenchesView>(WrenchesView{self});
      },
      "RecordedWrenches.");
  log.def_property_readonly(
      "corrupt_sections",
      [](py::handle self) { return py::tuple(py::cast(instance_of<Log>(self).corrupt_sections)); },
      "tuple of str: what could not be read, and where.");
  log.def_property_readonly(
      "missing_requests", [](py::handle self) { return to_dict(instance_of<Log>(self).requests); },
      "dict: for each session that lacks requests between its first and last one, a list of (first, last) "
      "seq.");
  log.def_property_readonly(
      "missing_responses", [](py::handle self) { return to_dict(instance_of<Log>(self).responses); },
      "dict: likewise.");
  log.def_property_readonly(
      "rejected", [](py::handle self) { return instance_of<Log>(self).rejected; },
      "int: messages on the two channels that are of another type, or damaged.");
  log.def("__repr__", [](py::handle self) {
    const Log& read = instance_of<Log>(self);
    return "<buoyancy.Log: " + std::to_string(read.states.utime.size()) + " states, " +
           std::to_string(read.wrenches.utime.size()) + " wrenches, " +
           std::to_string(read.corrupt_sections.size()) + " corrupt sections>";
  });
  module.def("read_log", &read_log, py::arg("path"), py::kw_only(),
             py::arg("states_channel") = std::string(kStatesChannel),
             py::arg("wrenches_channel") = std::string(kWrenchesChannel), kReadLogDoc);
}

}  // namespace buoyancy::python

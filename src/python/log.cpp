// buoyancy.read_log: recorded poses and wrenches as arrays.

#include <cstdint>
#include <fstream>
#include <memory>
#include <optional>
#include <span>
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
#include "python/arrays.h"
#include "python/call_arguments.h"
#include "python/module.h"
#include "recording/event_log.h"
#include "recording/sequence_gaps.h"
#include "recording/state_csv.h"

namespace buoyancy::python {
namespace {

// The tables of a log have a row per body of every message.
struct Origin : RequestId {
  std::int64_t timestamp = 0;  // [us]
};
struct StateRow : Origin, BodyState {
  double lead_time = 0.0;  // [s]
};
struct WrenchRow : Origin, BodyWrench {};

struct Log {
  std::vector<StateRow> states;
  std::vector<WrenchRow> wrenches;
  std::vector<std::string> corrupt_sections;
  SequenceGaps requests, responses;
  std::int64_t rejected = 0;  // messages on the channels that are none of the expected type
};

// The part of a log that holds states or wrenches; keeps the log alive.
template <auto kRows>
struct TableView {
  py::object log;

  auto rows() const { return std::span(instance_of<Log>(log).*kRows); }
};
using StatesView = TableView<&Log::states>;
using WrenchesView = TableView<&Log::wrenches>;

void add_request(std::int64_t timestamp, Bytes bytes, Log& log) {
  const auto request = RequestView::of(bytes);
  if (!request) {
    ++log.rejected;
    return;
  }
  log.requests.add(request->id().session_id, request->id().seq);
  for (std::size_t i = 0; i < request->size(); ++i) {
    log.states.push_back({{request->id(), timestamp}, request->body(i), request->lead_time()});
  }
}

// Passes all events of a log or a CSV file to on_event, and records what could not be read.
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
    for (const BodyWrench& wrench : response.bodies) {
      log.wrenches.push_back({{response.id, event.timestamp}, wrench});
    }
  });
  if (const std::optional<Error>& error = reader.file().read_error()) throw InputException(*error);
}

// Returns false for another number of fields than the header has, or a field that is no number.
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
      log.wrenches.push_back({{{utime, kCsvSession, 0}, utime}, wrench});
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

// Adds an array of one member of all rows.
template <typename View, typename Member>
void add_column(py::class_<View>& type, const char* name, Member member, const char* doc) {
  add_property(
      type, name, [member](const View& view) { return record_field(view.rows(), false, view.log, member); },
      doc);
}

template <typename View>
void add_common_columns(py::class_<View>& type) {
  type.def("__len__", [](py::handle self) { return instance_of<View>(self).rows().size(); });
  add_column(type, "timestamp", &Origin::timestamp,
             "(N,) int64, us: when it was recorded; of a CSV the utime.");
  add_column(type, "utime", &RequestId::utime, "(N,) int64, us: of the message.");
  add_column(type, "session_id", &RequestId::session_id, "(N,) int64.");
  add_column(type, "seq", &RequestId::seq, "(N,) int64: equal for the bodies of one message.");
}

template <typename View>
std::unique_ptr<View> view_of(const py::object& log) {
  instance_of<Log>(log);
  return std::make_unique<View>(View{log});
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
    R"(read_log(path, *, states_channel='BUOYANCY_STATES', wrenches_channel='BUOYANCY_WRENCHES')
--

The poses and wrenches that a file holds: a Log.

path: an .lcmlog of lcm-logger or buoyancy-replay, or a .csv of buoyancy-replay, poses or wrenches. What
is corrupt is skipped and listed in Log.corrupt_sections. Raises InputError for a file that cannot be
read, and for a CSV file with another header.)";

}  // namespace

void define_log(py::module_& module) {
  py::class_<StatesView> states(
      module, "RecordedStates",
      "The states of a Log: one row per body of every request, in the order of the file.");
  add_common_columns(states);
  add_column(states, "body_id", &BodyState::body_id, "(N,) int32.");
  add_column(states, "lead_time", &StateRow::lead_time, "(N,), s.");
  add_column(states, "position", &BodyState::position, "(N, 3), m, world frame.");
  add_column(states, "quaternion", &BodyState::quaternion_wxyz, "(N, 4), (w, x, y, z).");
  add_column(states, "linear_velocity", &BodyState::linear_velocity, "(N, 3), m/s.");
  add_column(states, "angular_velocity", &BodyState::angular_velocity, "(N, 3), rad/s.");
  py::class_<WrenchesView> wrenches(
      module, "RecordedWrenches",
      "The wrenches of a Log: one row per body of every response, in the order of the file.");
  add_common_columns(wrenches);
  add_column(wrenches, "body_id", &BodyWrench::body_id, "(N,) int32.");
  add_column(wrenches, "status", &BodyWrench::status, "(N,) int32: see Status.");
  add_column(wrenches, "force", &BodyWrench::force, "(N, 3), N.");
  add_column(wrenches, "torque", &BodyWrench::torque, "(N, 3), N m.");
  add_column(wrenches, "volume", &BodyWrench::submerged_volume, "(N,), m^3.");
  add_column(wrenches, "center_of_buoyancy", &BodyWrench::center_of_buoyancy,
             "(N, 3), m, relative to the position.");
  add_column(wrenches, "force_error_bound", &BodyWrench::force_error_bound, "(N,), N.");
  add_column(wrenches, "torque_error_bound", &BodyWrench::torque_error_bound, "(N,), N m.");

  py::class_<Log> log(module, "Log", "What read_log() found in a file.");
  log.def_property_readonly("states", &view_of<StatesView>, "RecordedStates.");
  log.def_property_readonly("wrenches", &view_of<WrenchesView>, "RecordedWrenches.");
  add_property(
      log, "corrupt_sections", [](const Log& read) { return py::tuple(py::cast(read.corrupt_sections)); },
      "tuple of str: what could not be read, and where.");
  add_property(
      log, "missing_requests", [](const Log& read) { return to_dict(read.requests); },
      "dict: for each session that lacks requests between its first and last one, a list of (first, last) "
      "seq.");
  add_property(
      log, "missing_responses", [](const Log& read) { return to_dict(read.responses); }, "dict: likewise.");
  add_property(log, "rejected", &Log::rejected,
               "int: messages on the two channels that are of another type, or damaged.");
  log.def("__repr__", [](py::handle self) {
    const Log& read = instance_of<Log>(self);
    return "<buoyancy.Log: " + std::to_string(read.states.size()) + " states, " +
           std::to_string(read.wrenches.size()) + " wrenches, " +
           std::to_string(read.corrupt_sections.size()) + " corrupt sections>";
  });
  module.def("read_log", &read_log, py::arg("path"), py::kw_only(),
             py::arg("states_channel") = std::string(kStatesChannel),
             py::arg("wrenches_channel") = std::string(kWrenchesChannel), kReadLogDoc);
}

}  // namespace buoyancy::python

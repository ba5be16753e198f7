// buoyancy.Client: requests to buoyancyd over LCM.

#include "client/client.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <pybind11/stl.h>

#include "base/format.h"
#include "messages/wire_layout.h"
#include "python/arrays.h"
#include "python/call_arguments.h"
#include "python/module.h"
#include "python/pose_input.h"
#include "python/scene_object.h"
#include "python/status.h"
#include "python/wrenches.h"
#include "scene/scene_fingerprint.h"

namespace buoyancy::python {
namespace {

// Has Python check for signals while a request waits, so that Ctrl-C ends it. It is called without the
// interpreter's lock and takes it rarely, since that costs more than a round trip.
class SignalCheck {
 public:
  void start() {
    raised_ = false;
    checked_ = Clock::now();
  }
  bool operator()() {
    if (raised_) return true;
    const Clock::time_point now = Clock::now();
    if (now - checked_ < kInterval) return false;
    checked_ = now;
    const py::gil_scoped_acquire acquired;
    raised_ = PyErr_CheckSignals() != 0;  // the exception stays set for the thread
    return raised_;
  }

 private:
  static constexpr std::chrono::milliseconds kInterval{20};
  Clock::time_point checked_;
  bool raised_ = false;
};

// A client as Python holds it. One thread at a time may use it, which is_busy guards under the interpreter's
// lock.
struct ClientObject {
  std::optional<Client> client;        // nullopt once it is closed
  std::shared_ptr<const Scene> scene;  // may be nullptr
  std::atomic<bool> closing{false};    // ends the waiting of another thread
  SignalCheck signals;
  bool has_loads = false;
  bool is_busy = false;
  bool has_warned = false;        // that the service has another scene
  std::vector<BodyState> states;  // reused
};

[[noreturn]] void fail(const std::string& actual, const std::string& expected, const std::string& hint) {
  throw ServiceException({"Client", actual, expected, "", hint});
}

// Marks the client as busy during a call that uses it without the interpreter's lock.
class BusyClient {
 public:
  explicit BusyClient(ClientObject& object) : object_(object) {
    if (!object.client) fail("is closed", "an open client", "Open another one");
    if (object.is_busy)
      fail("is in use by another thread", "one thread at a time", "Open one client per thread");
    object.is_busy = true;
  }
  ~BusyClient() {
    object_.is_busy = false;
    if (object_.closing) object_.client.reset();
  }
  BusyClient(const BusyClient&) = delete;
  BusyClient& operator=(const BusyClient&) = delete;

 private:
  ClientObject& object_;
};

std::shared_ptr<const Scene> to_scene(const py::object& scene) {
  if (scene.is_none()) return nullptr;
  if (py::isinstance<SceneObject>(scene)) return instance_of<SceneObject>(scene).scene;
  return load_scene(scene);
}

void check_seconds(const char* argument, double seconds, const char* expected) {
  if (std::isfinite(seconds) && seconds > 0.0) return;
  throw py::value_error(std::string(argument) + " = " + format_shortest(seconds) + "; expected " + expected);
}

std::unique_ptr<ClientObject> open(const std::optional<std::string>& lcm_url, const py::object& scene,
                                   double timeout, std::int64_t max_retries, std::optional<double> interval,
                                   bool loads, const std::string& states_channel,
                                   const std::string& wrenches_channel, const std::string& loads_channel,
                                   const std::string& status_channel, const std::string& points_channel,
                                   const std::string& samples_channel) {
  check_seconds("timeout", timeout, "seconds above 0");
  if (max_retries < 0)
    throw py::value_error("max_retries = " + std::to_string(max_retries) + "; expected 0 or more");
  if (interval) check_seconds("interval", *interval, "seconds above 0, or None");
  auto object = std::make_unique<ClientObject>();
  object->scene = to_scene(scene);
  object->has_loads = loads;
  ClientOptions options;
  options.channel.lcm_url = lcm_url.value_or("");
  options.channel.states_channel = states_channel;
  options.channel.wrenches_channel = wrenches_channel;
  options.channel.loads_channel = loads_channel;
  options.channel.status_channel = status_channel;
  options.channel.water_points_channel = points_channel;
  options.channel.water_samples_channel = samples_channel;
  if (object->scene != nullptr) options.channel.scene_fingerprint = scene_fingerprint(*object->scene);
  options.channel.wait_for_loads = loads;
  options.channel.cancelled = &object->closing;
  options.channel.is_interrupted = [signals = &object->signals] { return (*signals)(); };
  options.retry_policy = {timeout, max_retries};
  options.interval = interval;
  const WithoutGil released;
  object->client.emplace(value_or_throw<ServiceException>(Client::open(options)));
  return object;
}

std::int32_t to_body_id(const ClientObject& object, py::handle id) {
  if (object.scene != nullptr) return find_body(*object.scene, id).id;
  if (PyUnicode_Check(id.ptr())) {
    throw py::type_error("body_ids has the name " + std::string(py::repr(id)) +
                         "; expected an int: names need Client(scene=...)");
  }
  const auto value = to_number<std::int64_t>(id.ptr(), "body_ids");
  if (value != static_cast<std::int32_t>(value)) {
    throw py::value_error("body_ids has " + std::to_string(value) + "; expected a number of 32 bits");
  }
  return static_cast<std::int32_t>(value);
}

struct BodyIds {
  std::vector<std::int32_t> ids;
  bool single = false;
};

BodyIds to_body_ids(const ClientObject& object, PyObject* given) {
  BodyIds bodies;
  if (!is_given(given)) {
    if (object.scene == nullptr) {
      throw py::type_error("body_ids is None; expected ids: only Client(scene=...) knows all bodies");
    }
    for (const Body& body : object.scene->bodies()) bodies.ids.push_back(body.id);
    return bodies;
  }
  if (PyLong_Check(given) || PyUnicode_Check(given)) {
    bodies.single = true;
    bodies.ids.push_back(to_body_id(object, given));
    return bodies;
  }
  // Lists, tuples and arrays are read alike. An iterable without end is refused before it is read.
  if (PySequence_Check(given) == 0) {
    throw py::type_error(std::string("body_ids is a ") + Py_TYPE(given)->tp_name +
                         "; expected an id, or a list of ids");
  }
  for (const py::handle id : py::reinterpret_borrow<py::object>(given))
    bodies.ids.push_back(to_body_id(object, id));
  return bodies;
}

std::int64_t to_utime(PyObject* time, PyObject* utime) {
  if (is_given(time) && is_given(utime))
    throw py::type_error("request() got time and utime; expected one of them");
  if (is_given(utime)) return to_number<std::int64_t>(utime, "utime");
  bool many = false;
  const std::vector<std::int64_t> utimes = to_utimes(time, many);
  if (many) throw py::value_error("time is an array; expected one number: a request has one time");
  return utimes.empty() ? 0 : utimes.front();
}

void fill_states(const PoseArrays& poses, const std::vector<std::int32_t>& ids,
                 std::vector<BodyState>& states) {
  const auto copy = [](std::span<const double> from, std::size_t i, auto& to) {
    if (from.empty()) return to.fill(0.0);
    std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(i * to.size()), to.size(), to.begin());
  };
  states.resize(poses.size());
  for (std::size_t i = 0; i < states.size(); ++i) {
    states[i].body_id = ids.size() == 1 ? ids.front() : ids[i];
    copy(poses.positions, i, states[i].position);
    copy(poses.quaternions_wxyz, i, states[i].quaternion_wxyz);
    copy(poses.linear_velocities, i, states[i].linear_velocity);
    copy(poses.angular_velocities, i, states[i].angular_velocity);
  }
}

void store(const WrenchResponse& response, const BodiesLoads& loads, bool with_loads, Wrenches& wrenches) {
  wrenches.utime = response.id.utime;
  wrenches.body_ids.resize(response.bodies.size());
  wrenches.has_loads = with_loads;
  if (with_loads) wrenches.loads.assign(response.bodies.size(), BodyLoads{});
  // The message holds loads only of the bodies with this output, in the order of the response.
  auto next = loads.bodies.begin();
  for (std::size_t i = 0; i < response.bodies.size(); ++i) {
    const BodyWrench& wrench = response.bodies[i];
    wrenches.set(i, wrench);
    wrenches.body_ids[i] = wrench.body_id;
    if (with_loads && next != loads.bodies.end() && next->body_id == wrench.body_id)
      wrenches.loads[i] = *next++;
  }
}

constexpr Parameters<9> kRequestParameters{"body_ids",        "position",         "quaternion",
                                           "linear_velocity", "angular_velocity", "time",
                                           "utime",           "lead_time",        "out"};

py::object request(PyObject* self, const Arguments<9>& arguments) {
  const auto& [body_ids, position, quaternion, linear, angular, time, utime, lead_time, out] = arguments;
  auto& object = instance_of<ClientObject>(self);
  const BodyIds bodies = to_body_ids(object, body_ids);
  const PoseInput poses({position, quaternion, linear, angular, nullptr});
  const bool single = bodies.single && poses.single();
  if (bodies.ids.size() != poses.size() && !bodies.single) {
    throw py::value_error(
        "body_ids names " + pluralize(static_cast<std::int64_t>(bodies.ids.size()), "body", "bodies") +
        ", but the poses are " + std::to_string(poses.size()) + "; expected one pose per body");
  }
  const std::int64_t at = to_utime(time, utime);
  const double lead = lead_time == nullptr ? 0.0 : to_number<double>(lead_time, "lead_time");
  py::object result = wrenches_for(out, poses.size(), single);
  const BusyClient busy(object);
  fill_states(poses.arrays(), bodies.ids, object.states);
  object.signals.start();
  const auto response = [&] {
    const WithoutGil released;
    return object.client->request(at, object.states, lead);
  }();
  if (PyErr_Occurred() != nullptr) throw py::error_already_set();  // of a signal
  if (!response) {
    if (object.closing) fail("was closed while it waited", "an open client", "");
    throw ServiceException(response.error());
  }
  if (const Warning* const other = object.client->scene_warning(); other != nullptr && !object.has_warned) {
    object.has_warned = true;
    warn(*other);
  }
  static const BodiesLoads no_loads;
  store(**response, object.has_loads ? object.client->loads() : no_loads, object.has_loads,
        instance_of<Wrenches>(result));
  return result;
}

py::dict sample_water(py::handle self, py::handle points, py::handle time, py::handle utime) {
  auto& object = instance_of<ClientObject>(self);
  const Numbers<double> given = to_numbers<double>(points.ptr(), "points");
  if (given.ndim() != 2 || given.shape(1) != 3) {
    throw py::value_error("points has shape " + shape_text(given) + "; expected (n, 3)");
  }
  std::vector<WaterPoint> positions(static_cast<std::size_t>(given.shape(0)));
  for (std::size_t i = 0; i < positions.size(); ++i)
    std::copy_n(given.data() + 3 * i, 3, positions[i].position.begin());
  const std::int64_t at = to_utime(time.ptr(), utime.ptr());
  const BusyClient busy(object);
  object.signals.start();
  const auto samples = [&] {
    const WithoutGil released;
    return object.client->sample_water(at, positions);
  }();
  if (PyErr_Occurred() != nullptr) throw py::error_already_set();  // of a signal
  if (!samples) {
    if (object.closing) fail("was closed while it waited", "an open client", "");
    throw ServiceException(samples.error());
  }
  py::dict fields;
  fields["utime"] = (*samples)->id.utime;
  fields["status"] = status_object((*samples)->status);
  const auto add = [&](const char* name, auto WaterSample::*member) {
    using Member = std::remove_reference_t<decltype(std::declval<WaterSample&>().*member)>;
    constexpr std::size_t kWidth = std::is_same_v<Member, double> ? 1 : 3;
    std::vector<py::ssize_t> shape{given.shape(0)};
    if (kWidth > 1) shape.push_back(kWidth);
    py::array_t<double> array(shape);
    double* out = array.mutable_data();
    for (const WaterSample& sample : (*samples)->samples) {
      std::memcpy(out, &(sample.*member), sizeof(Member));
      out += kWidth;
    }
    fields[name] = array;
  };
  add("elevation", &WaterSample::elevation);
  add("pressure", &WaterSample::pressure);
  add("velocity", &WaterSample::velocity);
  add("density", &WaterSample::density);
  return fields;
}

void close(py::handle self) {
  auto& object = instance_of<ClientObject>(self);
  object.closing = true;
  if (!object.is_busy) object.client.reset();
}

std::optional<std::string> reserve(py::handle self, std::size_t bodies) {
  auto& object = instance_of<ClientObject>(self);
  const BusyClient busy(object);
  const auto warning = value_or_throw<ServiceException>(object.client->reserve(bodies));
  if (!warning) return std::nullopt;
  return warning->message();
}

py::dict statistics(py::handle self) {
  auto& object = instance_of<ClientObject>(self);
  const BusyClient busy(object);
  const ClientStats stats = object.client->statistics();
  const LatencyPercentiles round_trip = stats.round_trip.percentiles();
  using namespace py::literals;
  return py::dict("requests"_a = stats.requests, "retries"_a = stats.retries,
                  "unanswered"_a = stats.unanswered, "late"_a = stats.late, "max_lag"_a = stats.max_lag,
                  "malformed"_a = stats.malformed, "round_trip_p50"_a = round_trip.p50,
                  "round_trip_p99"_a = round_trip.p99, "round_trip_max"_a = round_trip.max);
}

py::dict status(py::handle self, double timeout) {
  check_seconds("timeout", timeout, "seconds above 0");
  auto& object = instance_of<ClientObject>(self);
  const BusyClient busy(object);
  object.signals.start();
  const Expected<const ServiceStatus*> newest = [&] {
    const WithoutGil released;
    return object.client->status(timeout);
  }();
  if (PyErr_Occurred() != nullptr) throw py::error_already_set();  // of a signal
  if (!newest) throw ServiceException(newest.error());
  py::dict values;
  visit_named_fields(**newest, [&values](const Field& field, const auto& value) {
    const py::str name(field.name);
    if constexpr (std::is_enum_v<std::remove_cvref_t<decltype(value)>>) {
      values[name] = static_cast<std::int32_t>(value);
    } else {
      values[name] = value;
    }
  });
  return values;
}

constexpr const char* kClientDoc =
    R"(Sends poses to buoyancyd over LCM and receives the wrenches.

Client(lcm_url=None, scene=None, *, timeout=0.1, max_retries=50, interval=None, loads=False,
       states_channel='BUOYANCY_STATES', wrenches_channel='BUOYANCY_WRENCHES',
       loads_channel='BUOYANCY_LOADS',
       status_channel='BUOYANCY_STATUS', water_points_channel='BUOYANCY_WATER_POINTS',
       water_samples_channel='BUOYANCY_WATER_SAMPLES')

lcm_url: None for LCM_DEFAULT_URL or LCM's default. scene: a Scene or the path of the service's scene
file; bodies can then be named, unknown ones are refused before they are sent, and a service with another
scene gets a UserWarning. timeout, max_retries: a request is sent again after each timeout (s), at most
max_retries times. interval: None to wait for the response to each request; else seconds between requests,
each of which returns the newest response there is. loads: receive drag and added mass too; at least one
body of each request must have the output "loads".

Use it in one thread at a time, and close it: `with buoyancy.Client() as client:`.

Raises ServiceError if LCM cannot be opened; the text says what to do.)";

constexpr const char* kRequestDoc =
    R"(request($self, body_ids, position, quaternion, *, linear_velocity=None, angular_velocity=None,
        time=0.0, utime=None, lead_time=0.0, out=None)
--

The wrenches on bodies in these states, one per body in their order: a Wrenches.

body_ids: one id or name for one pose or for K poses of that body, K of them for K poses, or None for all
bodies of the scene. position, quaternion, linear_velocity, angular_velocity, out: as Scene.query(). time:
seconds; utime: microseconds, instead of it. lead_time: s, evaluates at the poses extrapolated by this
much.

Waits without the interpreter's lock; Ctrl-C ends the wait. Raises ServiceError when no response has
arrived after all retries, for a closed client, and for one that another thread uses.)";

}  // namespace

void define_client(py::module_& module) {
  py::class_<ClientObject> type(module, "Client", kClientDoc);
  type.def(py::init(&open), py::arg("lcm_url") = py::none(), py::arg("scene") = py::none(), py::kw_only(),
           py::arg("timeout") = RetryPolicy{}.timeout, py::arg("max_retries") = RetryPolicy{}.max_retries,
           py::arg("interval") = py::none(), py::arg("loads") = false,
           py::arg("states_channel") = std::string(kStatesChannel),
           py::arg("wrenches_channel") = std::string(kWrenchesChannel),
           py::arg("loads_channel") = std::string(kLoadsChannel),
           py::arg("status_channel") = std::string(kStatusChannel),
           py::arg("water_points_channel") = std::string(kWaterPointsChannel),
           py::arg("water_samples_channel") = std::string(kWaterSamplesChannel));
  add_method<&request>(type, "request", 3, kRequestParameters, kRequestDoc);
  type.def("sample_water", &sample_water, py::arg("points"), py::kw_only(), py::arg("time") = py::none(),
           py::arg("utime") = py::none(),
           R"(sample_water($self, points, *, time=0.0, utime=None)
--

The water at n points, as the loads of the service see it: a dict.

points: (n, 3), m, world frame. time: seconds; utime: microseconds, instead of it. The dict has elevation
(n,), m over the level, of the surface above or below each point; pressure (n,), Pa over that of the air;
velocity (n, 3), m/s, of current and waves; density (n,), kg/m^3; utime; and status, a Status: all numbers are
0 unless it is OK. Above the surface, pressure and velocity are 0.

Waits as request() does, and raises the same errors.)");
  type.def("close", &close,
           R"(close($self)
--

End the connection. Every later request raises a ServiceError; a second call does nothing.)");
  add_property(
      type, "closed", [](const ClientObject& object) { return !object.client.has_value(); }, "bool.");
  type.def("reserve", &reserve, py::arg("bodies"),
           R"(reserve($self, bodies)
--

Prepare for requests about this many bodies. Returns a warning if the kernel's buffer is too small for
their responses, else None.)");
  type.def("status", &status, py::arg("timeout") = 2.0,
           R"(status($self, timeout=2.0)
--

The next status of the service, which comes once a second: a dict with the fields of service_status_t.
Waits without the interpreter's lock. Raises ServiceError if none arrives within timeout (s).)");
  type.def_property_readonly(
      "statistics", &statistics,
      "dict: requests, retries, unanswered, late, max_lag, malformed, and round_trip_p50, _p99, _max in s.");
  type.def("__enter__", [](py::object self) { return self; });
  type.def("__exit__", [](py::handle self, const py::args&) { close(self); });
}

}  // namespace buoyancy::python

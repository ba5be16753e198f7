// buoyancy.Sea: the water and its waves, and their motion at many points.

#include <array>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "python/arrays.h"
#include "python/call_arguments.h"
#include "python/pose_input.h"
#include "python/query_water.h"
#include "python/slices.h"
#include "python/wrenches.h"
#include "scene/scene_file.h"

namespace buoyancy::python {
namespace {

// Points and times of one shape, by numpy's rules of broadcasting.
struct Points {
  std::vector<std::vector<double>> columns;  // x, y and perhaps z
  std::vector<std::int64_t> utimes;          // one, or one per point
  std::vector<py::ssize_t> shape;
  std::size_t size = 0;

  std::span<const std::int64_t> times(std::size_t begin, std::size_t end) const {
    const std::span<const std::int64_t> all = utimes;
    return all.size() == 1 ? all : all.subspan(begin, end - begin);
  }
};

Points to_points(std::initializer_list<std::pair<const char*, py::handle>> coordinates) {
  const py::module_ numpy = py::module_::import("numpy");
  std::vector<Numbers<double>> arrays;
  py::tuple shape;
  for (const auto& [name, object] : coordinates) {
    arrays.push_back(to_numbers<double>(object.ptr(), name));
    const py::tuple own_shape = arrays.back().attr("shape");
    if (own_shape.equal(shape)) continue;
    try {
      shape = numpy.attr("broadcast_shapes")(shape, own_shape);
    } catch (const py::error_already_set& error) {
      if (!error.matches(PyExc_ValueError)) throw;
      throw py::value_error(std::string(name) + " has shape " + std::string(py::repr(own_shape)) +
                            ", which does not fit " + std::string(py::repr(shape)) +
                            " of the arguments before it");
    }
  }
  const auto spread = [&](const Numbers<double>& array) {
    const py::object own_shape = array.attr("shape");
    return own_shape.equal(shape) ? array : Numbers<double>(numpy.attr("broadcast_to")(array, shape));
  };
  Points points;
  // The last array holds the times. A single time is not repeated for all points, which is much faster.
  const Numbers<double> times = arrays.back();
  arrays.pop_back();
  points.utimes = to_utimes(values_of(times.size() == 1 ? times : spread(times)));
  for (const Numbers<double>& array : arrays) {
    const Numbers<double> column = spread(array);
    points.columns.emplace_back(column.data(), column.data() + column.size());
    points.shape.assign(column.shape(), column.shape() + column.ndim());
  }
  points.size = points.columns.front().size();
  return points;
}

// Returns the array that evaluate(begin, end, out) fills for points [begin, end), `width` numbers per point.
template <typename Evaluate>
py::object at_points(const Points& points, std::size_t width, const Evaluate& evaluate) {
  std::vector<py::ssize_t> shape = points.shape;
  if (width > 1) shape.push_back(static_cast<py::ssize_t>(width));
  py::array_t<double> array(shape);
  const std::span<double> values(array.mutable_data(), width * points.size);
  run_in_slices(points.size, [&](std::size_t begin, std::size_t end) {
    evaluate(begin, end, values.subspan(width * begin, width * (end - begin)));
  });
  if (shape.empty()) return py::float_(values[0]);
  return array;
}

py::object elevation(py::handle self, py::handle x, py::handle y, py::handle time, py::handle threads) {
  const DefaultFloatingPoint floating_point;
  const QuerySea& sea = instance_of<SeaObject>(self).sea;
  const unsigned count = to_threads(threads.ptr());
  const Points points = to_points({{"x", x}, {"y", y}, {"t", time}});
  const std::span<const double> x1 = points.columns[0];
  const std::span<const double> x2 = points.columns[1];
  return at_points(points, 1, [&](std::size_t begin, std::size_t end, std::span<double> out) {
    sea_elevations(sea, x1.subspan(begin, end - begin), x2.subspan(begin, end - begin),
                   points.times(begin, end), out, count);
  });
}

template <std::span<double> WaterMotionArrays::*kWanted, std::size_t kWidth>
py::object motion(py::handle self, py::handle x, py::handle y, py::handle z, py::handle time,
                  py::handle threads) {
  const DefaultFloatingPoint floating_point;
  const QuerySea& sea = instance_of<SeaObject>(self).sea;
  const unsigned count = to_threads(threads.ptr());
  const Points points = to_points({{"x", x}, {"y", y}, {"z", z}, {"t", time}});
  std::vector<double> at(3 * points.size);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < points.size; ++i) at[3 * i + axis] = points.columns[axis][i];
  }
  return at_points(points, kWidth, [&](std::size_t begin, std::size_t end, std::span<double> out) {
    WaterMotionArrays wanted;
    wanted.*kWanted = out;
    water_at_points(sea, std::span(at).subspan(3 * begin, 3 * (end - begin)), points.times(begin, end),
                    wanted, count);
  });
}

QuerySea sea_of_file(const std::filesystem::path& path) {
  const SceneDescription description = value_or_throw(read_scene_file(path));
  if (description.sea_messages != SeaMessages::kNone) {
    throw InputException({path.string(), to_string(description.sea_messages), "the wave systems themselves",
                          "no messages are received in a query", "Describe the sea by Sea(waves=...)"});
  }
  return value_or_throw(QuerySea::make(description.sea, description.water, description.current_profile));
}

std::unique_ptr<SeaObject> make_sea(const std::optional<std::filesystem::path>& path,
                                    const py::kwargs& keys) {
  const DefaultFloatingPoint floating_point;
  if (path) {
    if (!keys.empty()) throw py::type_error("Sea() got a scene file and keys; expected one of them");
    return std::make_unique<SeaObject>(SeaObject{sea_of_file(*path)});
  }
  std::string world = "[world]\n";
  std::string water = "[water]\n";
  const py::object toml_line = py::module_::import("buoyancy._toml_text").attr("line");
  for (const auto& [key, value] : keys) {
    const std::string name = py::str(key);
    (name == "gravity" || name == "up" ? world : water) += toml_line(key, value).cast<std::string>();
  }
  return std::make_unique<SeaObject>(SeaObject{value_or_throw(QuerySea::parse(world + water, "Sea()", {}))});
}

// Two numbers, or one for both.
std::array<double, 2> to_pair(py::handle object, const char* name) {
  const Numbers<double> numbers = to_numbers<double>(object.ptr(), name);
  if (numbers.ndim() == 0) return {*numbers.data(), *numbers.data()};
  if (numbers.ndim() == 1 && numbers.size() == 2) return {numbers.data()[0], numbers.data()[1]};
  throw py::value_error(std::string(name) + " has shape " + shape_text(numbers) +
                        "; expected (2,) or a number");
}

std::unique_ptr<SeaObject> sea_from_grid(py::handle elevation, py::handle origin, py::handle spacing,
                                         py::handle level, bool periodic, py::handle up, py::handle gravity,
                                         py::handle density) {
  const DefaultFloatingPoint floating_point;
  const Numbers<double> samples = to_numbers<double>(elevation.ptr(), "elevation");
  if (samples.ndim() != 2) {
    throw py::value_error("elevation has shape " + shape_text(samples) + "; expected (rows, columns)");
  }
  const ElevationGrid<double> grid{values_of(samples),
                                   static_cast<std::size_t>(samples.shape(0)),
                                   static_cast<std::size_t>(samples.shape(1)),
                                   to_pair(origin, "origin"),
                                   to_pair(spacing, "spacing"),
                                   periodic};
  const Water water = to_water({level.ptr(), density.ptr(), gravity.ptr(), up.ptr()});
  return std::make_unique<SeaObject>(SeaObject{value_or_throw(QuerySea::from_grid(grid, water))});
}

std::string to_text(const QuerySea& sea) {
  if (sea.waves() == nullptr) return "<buoyancy.Sea at rest>";
  const std::vector<TimedElevation>& surfaces = sea.waves()->surfaces();
  if (surfaces.empty()) {
    return "<buoyancy.Sea of " + std::to_string(sea.waves()->components().size()) + " wave components>";
  }
  const ElevationSpline& spline = *surfaces.front().spline;
  return "<buoyancy.Sea of a grid of " + std::to_string(spline.rows()) + " x " +
         std::to_string(spline.columns()) + " elevations>";
}

constexpr const char* kFromGridDoc =
    R"(from_grid(elevation, origin, spacing, level=0.0, periodic=False, up=(0, 0, 1), gravity=9.80665, density=1025.0)
--

The sea whose surface is the bicubic spline through samples on a grid, at rest at every time.

elevation: (rows, columns), metres over the level, 4 to 4096 of both; a column further is further along the
first of the horizontal axes (see axes; with up = z the world's x), a row along the second. origin: (2,),
metres from the world's origin along these axes, of elevation[0, 0]. spacing: (2,), metres between
neighbours along them, or one number for both. periodic: the surface repeats after columns * spacing[0] and
rows * spacing[1]; otherwise a body that leaves it gets the status OUT_OF_RANGE, and elevation() is nan
there. level, up, gravity, density: of the water.

The pressure is hydrostatic. Raises InputError for counts, spacings or elevations out of range.)";

constexpr const char* kSeaDoc =
    R"(The water and its waves.

Sea(level=0.0, density=1025.0, gravity=9.80665, up=(0, 0, 1), depth=inf, wave_pressure="wheeler",
    time_origin=0, ramp=0.0, waves=[...], current={"velocity": (0, 0, 0)}, layer=[...]) takes the keys of
    the sections [water] and [world] of a scene file, with their units, ranges and defaults
    (docs/scene_file.md).
    waves: a dict per wave system, or one dict, such as dict(type="jonswap",
    significant_wave_height=2.0, peak_period=8.0).
Sea(path) reads them from a scene file, and Sea.from_grid() takes samples of a surface.

Times are seconds: the utime of a message over 1e6, rounded to whole microseconds.

Raises InputError with the text of the scene file's errors.)";

constexpr const char* kElevationDoc =
    R"(elevation($self, x, y, t, *, threads=0)
--

Height of the surface over the level in metres.

x, y: metres from the world's origin along the horizontal axes (see axes; with up = z the world's x and
y). t: seconds. All are numbers or arrays, which are broadcast as numpy does.)";

constexpr const char* kVelocityDoc =
    R"(velocity($self, x, y, z, t, *, threads=0)
--

Velocity of the water at points in the world, of current and waves, in m/s: the shape of the arguments,
and 3.

x, y, z: metres, world frame; t: seconds; broadcast as numpy does.)";

constexpr const char* kAccelerationDoc =
    R"(acceleration($self, x, y, z, t, *, threads=0)
--

Acceleration of the water at points in the world, in m/s^2, as an observer sees it who drifts with the
current: see velocity().)";

constexpr const char* kPressureDoc =
    R"(pressure($self, x, y, z, t, *, threads=0)
--

Pressure over that of the air in Pa at points in the world, of water at rest and waves together; 0 above
the surface. Arguments: see velocity().)";

}  // namespace

void define_sea(py::module_& module) {
  py::class_<SeaObject> type(module, "Sea", kSeaDoc);
  type.def(py::init(&make_sea), py::arg("path") = py::none());
  type.def_static("from_grid", &sea_from_grid, py::arg("elevation"), py::arg("origin"), py::arg("spacing"),
                  py::arg("level") = 0.0, py::arg("periodic") = false,
                  py::arg("up") = py::make_tuple(0, 0, 1), py::arg("gravity") = kStandardGravity,
                  py::arg("density") = kSeawaterDensity, kFromGridDoc);
  type.def("elevation", &elevation, py::arg("x"), py::arg("y"), py::arg("t"), py::kw_only(),
           py::arg("threads") = 0, kElevationDoc);
  const auto add_motion = [&type](const char* name, auto function, const char* doc) {
    type.def(name, function, py::arg("x"), py::arg("y"), py::arg("z"), py::arg("t"), py::kw_only(),
             py::arg("threads") = 0, doc);
  };
  add_motion("velocity", &motion<&WaterMotionArrays::velocities, 3>, kVelocityDoc);
  add_motion("acceleration", &motion<&WaterMotionArrays::accelerations, 3>, kAccelerationDoc);
  add_motion("pressure", &motion<&WaterMotionArrays::pressures, 1>, kPressureDoc);
  add_water_properties(type, [](const SeaObject& object) { return object.sea.water(); });
  add_property(
      type, "current", [](const SeaObject& object) { return object.sea.current_W(); },
      "(3,), m/s: of the current at the level, which carries the waves, world frame.");
  add_property(
      type, "axes",
      [](const SeaObject& object) {
        const HorizontalAxes axes = object.sea.axes();
        return py::make_tuple(axes.e1_W, axes.e2_W);
      },
      "Two (3,): the horizontal axes of elevation() and of wave directions, world frame.");
  add_property(
      type, "has_waves", [](const SeaObject& object) { return object.sea.waves() != nullptr; },
      "bool: is any amplitude above 0, or the surface that of a grid?");
  type.def("__repr__", [](py::handle self) { return to_text(instance_of<SeaObject>(self).sea); });
}

}  // namespace buoyancy::python

// buoyancy.Sea: the water and its waves, and their motion at many points.

#include <memory>
#include <optional>
#include <vector>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "python/call_arguments.h"
#include "python/number_array.h"
#include "python/pose_input.h"
#include "python/query_water.h"
#include "python/result_array.h"
#include "python/slices.h"
#include "python/toml_text.h"
#include "python/wrenches.h"
#include "scene/scene_file.h"

namespace buoyancy::python {
namespace {

// Several arrays as one shape, by numpy's rules: missing dimensions come first, and those of 1 are repeated.
class Broadcast {
 public:
  void add(const NumberArray<double>& array, const char* name) {
    const auto dimensions = static_cast<std::size_t>(array.dimensions());
    if (dimensions > shape_.size()) shape_.insert(shape_.begin(), dimensions - shape_.size(), 1);
    const std::size_t first = shape_.size() - dimensions;
    for (std::size_t i = 0; i < dimensions; ++i) {
      Py_ssize_t& known = shape_[first + i];
      const Py_ssize_t extent = array.shape()[i];
      if (known == extent || extent == 1) continue;
      if (known != 1) {
        throw py::value_error(std::string(name) + " has shape " + shape_text(array.shape()) +
                              ", which does not fit " + shape_text(shape_) + " of the arguments before it");
      }
      known = extent;
    }
  }

  const std::vector<Py_ssize_t>& shape() const { return shape_; }
  std::size_t size() const {
    std::size_t product = 1;
    for (const Py_ssize_t extent : shape_) product *= static_cast<std::size_t>(extent);
    return product;
  }

  // The numbers of an array that was added, at every element of the shape.
  std::vector<double> expand(const NumberArray<double>& array) const {
    std::vector<double> values(size());
    std::vector<Py_ssize_t> strides(shape_.size(), 0);
    Py_ssize_t stride = 1;
    for (int i = array.dimensions(); i-- > 0;) {
      const std::size_t to = shape_.size() - static_cast<std::size_t>(array.dimensions() - i);
      strides[to] = array.extent(i) == 1 ? 0 : stride;
      stride *= array.extent(i);
    }
    std::vector<Py_ssize_t> index(shape_.size(), 0);
    Py_ssize_t offset = 0;
    for (double& value : values) {
      value = array.values()[static_cast<std::size_t>(offset)];
      for (std::size_t i = shape_.size(); i-- > 0;) {
        offset += strides[i];
        if (++index[i] < shape_[i]) break;
        offset -= strides[i] * shape_[i];
        index[i] = 0;
      }
    }
    return values;
  }

 private:
  std::vector<Py_ssize_t> shape_;
};

// Points and times as contiguous columns of one shape.
struct Points {
  std::vector<std::vector<double>> columns;
  std::vector<std::int64_t> utimes;  // one, or one per point
  std::vector<Py_ssize_t> shape;
  std::size_t size = 0;

  std::span<const std::int64_t> times(std::size_t begin, std::size_t end) const {
    const std::span<const std::int64_t> all = utimes;
    return all.size() == 1 ? all : all.subspan(begin, end - begin);
  }
};

Points to_points(std::initializer_list<std::pair<const char*, py::handle>> coordinates, py::handle time) {
  Broadcast broadcast;
  std::vector<std::unique_ptr<NumberArray<double>>> arrays;
  for (const auto& [name, object] : coordinates) {
    arrays.push_back(std::make_unique<NumberArray<double>>(object.ptr(), name));
    broadcast.add(*arrays.back(), name);
  }
  const NumberArray<double> times(time.ptr(), "t");
  broadcast.add(times, "t");
  Points points;
  for (const auto& array : arrays) points.columns.push_back(broadcast.expand(*array));
  bool many = false;
  if (times.values().size() == 1) {
    points.utimes = to_utimes(py::float_(times.values()[0]).ptr(), many);
  } else {
    points.utimes = to_utimes(
        make_owned_array({static_cast<Py_ssize_t>(broadcast.size())}, broadcast.expand(times)).ptr(), many);
  }
  points.shape = broadcast.shape();
  points.size = broadcast.size();
  return points;
}

py::object elevation(py::handle self, py::handle x, py::handle y, py::handle time, py::handle threads) {
  const DefaultFloatingPoint floating_point;
  const QuerySea& sea = instance_of<SeaObject>(self).sea;
  const unsigned count = to_threads(threads.ptr());
  const Points points = to_points({{"x", x}, {"y", y}}, time);
  std::vector<double> values(points.size);
  run_in_slices(points.size, [&](std::size_t begin, std::size_t end) {
    const auto part = [&](const std::vector<double>& all) {
      return std::span(all).subspan(begin, end - begin);
    };
    sea_elevations(sea, part(points.columns[0]), part(points.columns[1]), points.times(begin, end),
                   std::span(values).subspan(begin, end - begin), count);
  });
  if (points.shape.empty()) return py::float_(values[0]);
  return make_owned_array(points.shape, std::move(values));
}

// wanted: the member of WaterMotionArrays; width: numbers per point.
py::object motion(py::handle self, py::handle x, py::handle y, py::handle z, py::handle time,
                  py::handle threads, std::span<double> WaterMotionArrays::*wanted, std::size_t width) {
  const DefaultFloatingPoint floating_point;
  const QuerySea& sea = instance_of<SeaObject>(self).sea;
  const unsigned count = to_threads(threads.ptr());
  Points points = to_points({{"x", x}, {"y", y}, {"z", z}}, time);
  std::vector<double> at(3 * points.size);
  for (std::size_t i = 0; i < points.size; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) at[3 * i + axis] = points.columns[axis][i];
  }
  std::vector<double> values(width * points.size);
  run_in_slices(points.size, [&](std::size_t begin, std::size_t end) {
    WaterMotionArrays out;
    out.*wanted = std::span(values).subspan(width * begin, width * (end - begin));
    water_at_points(sea, std::span(at).subspan(3 * begin, 3 * (end - begin)), points.times(begin, end), out,
                    count);
  });
  if (width == 1 && points.shape.empty()) return py::float_(values[0]);
  if (width > 1) points.shape.push_back(static_cast<Py_ssize_t>(width));
  return make_owned_array(points.shape, std::move(values));
}

QuerySea sea_of_file(const std::filesystem::path& path) {
  const SceneDescription description = value_or_throw(read_scene_file(path));
  if (description.waves_received) {
    throw InputException({path.string(), "waves = \"received\"", "the wave systems themselves",
                          "no messages are received in a query", "Describe the sea by Sea(waves=...)"});
  }
  return value_or_throw(QuerySea::make(description.sea, description.water));
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
  for (const auto& [key, value] : keys) {
    const std::string name = py::str(key);
    (name == "gravity" || name == "up" ? world : water) += toml_line(key, value);
  }
  return std::make_unique<SeaObject>(SeaObject{value_or_throw(QuerySea::parse(world + water, "Sea()", {}))});
}

py::object vector(const Vec3& value) {
  return make_owned_array({3}, {value.x(), value.y(), value.z()});
}

constexpr const char* kSeaDoc =
    "The water and its waves.\n\nSea(level=0.0, density=1025.0, gravity=9.80665, up=(0, 0, 1), depth=inf, "
    "wave_pressure=\"wheeler\",\n    time_origin=0, ramp=0.0, waves=[...], current={\"velocity\": (0, 0, "
    "0)}) takes the keys of the sections "
    "[water] and "
    "[world] of a scene\n    file, with their units, ranges and defaults (docs/scene_file.md). waves: a dict "
    "per wave "
    "system, or one\n    dict, such as dict(type=\"jonswap\", significant_wave_height=2.0, "
    "peak_period=8.0).\nSea(path) "
    "reads them from a scene file.\n\nTimes are seconds: the utime of a message over 1e6, rounded to whole "
    "microseconds.\n\nRaises InputError with the text of the scene file's errors.";

}  // namespace

void define_sea(py::module_& module) {
  py::class_<SeaObject> type(module, "Sea", kSeaDoc);
  type.def(py::init(&make_sea), py::arg("path") = py::none());
  const auto add_method = [&type](const char* name, auto function, const char* doc) {
    type.def(name, function, py::arg("x"), py::arg("y"), py::arg("z"), py::arg("t"), py::kw_only(),
             py::arg("threads") = 0, doc);
  };
  type.def("elevation", &elevation, py::arg("x"), py::arg("y"), py::arg("t"), py::kw_only(),
           py::arg("threads") = 0,
           "elevation($self, x, y, t, *, threads=0)\n--\n\nHeight of the surface over the level in "
           "metres.\n\nx, y: "
           "metres from the world's origin along the horizontal axes (see axes; with up = z the world's x "
           "and y).\nt: "
           "seconds. All are numbers or arrays, which are broadcast as numpy does.");
  add_method(
      "velocity",
      [](py::handle self, py::handle x, py::handle y, py::handle z, py::handle time, py::handle threads) {
        return motion(self, x, y, z, time, threads, &WaterMotionArrays::velocities, 3);
      },
      "velocity($self, x, y, z, t, *, threads=0)\n--\n\nVelocity of the water at points in the world, of "
      "current and "
      "waves, in m/s: the shape of the arguments, and 3.\n\nx, y, z: metres, world frame; t: seconds; "
      "broadcast as numpy "
      "does.");
  add_method(
      "acceleration",
      [](py::handle self, py::handle x, py::handle y, py::handle z, py::handle time, py::handle threads) {
        return motion(self, x, y, z, time, threads, &WaterMotionArrays::accelerations, 3);
      },
      "acceleration($self, x, y, z, t, *, threads=0)\n--\n\nAcceleration of the water at points in the "
      "world, in "
      "m/s^2, as an observer sees it who drifts with the current: see velocity().");
  add_method(
      "pressure",
      [](py::handle self, py::handle x, py::handle y, py::handle z, py::handle time, py::handle threads) {
        return motion(self, x, y, z, time, threads, &WaterMotionArrays::pressures, 1);
      },
      "pressure($self, x, y, z, t, *, threads=0)\n--\n\nPressure over that of the air in Pa at points in "
      "the "
      "world, of water at rest and waves together; 0 above the\nsurface. Arguments: see velocity().");
  const auto water_number = [&type](const char* name, double Water::*member, const char* doc) {
    type.def_property_readonly(
        name, [member](py::handle self) { return instance_of<SeaObject>(self).sea.water().*member; }, doc);
  };
  water_number("level", &Water::level, "float, m: the surface at rest is where up . x = level.");
  water_number("density", &Water::density, "float, kg/m^3.");
  water_number("gravity", &Water::gravity, "float, m/s^2.");
  type.def_property_readonly(
      "up", [](py::handle self) { return vector(instance_of<SeaObject>(self).sea.water().up_W); },
      "(3,): unit vector, world frame.");
  type.def_property_readonly(
      "current", [](py::handle self) { return vector(instance_of<SeaObject>(self).sea.current_W()); },
      "(3,), m/s: of the current, which carries the waves, world frame.");
  type.def_property_readonly(
      "axes",
      [](py::handle self) {
        const HorizontalAxes axes = instance_of<SeaObject>(self).sea.axes();
        return py::make_tuple(vector(axes.e1_W), vector(axes.e2_W));
      },
      "Two (3,): the horizontal axes of elevation() and of wave directions, world frame.");
  type.def_property_readonly(
      "has_waves", [](py::handle self) { return instance_of<SeaObject>(self).sea.waves() != nullptr; },
      "bool: is any amplitude above 0?");
  type.def("__repr__", [](py::handle self) {
    const QuerySea& sea = instance_of<SeaObject>(self).sea;
    if (sea.waves() == nullptr) return std::string("<buoyancy.Sea at rest>");
    return "<buoyancy.Sea of " + std::to_string(sea.waves()->sea().components().size()) + " wave components>";
  });
}

}  // namespace buoyancy::python

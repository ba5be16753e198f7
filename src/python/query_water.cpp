#include "python/query_water.h"

#include <string>

#include "base/format.h"
#include "base/number_range.h"
#include "python/arrays.h"

namespace buoyancy::python {
namespace {

double in_range(PyObject* object, const char* name, const NumberRange& range, double default_value) {
  if (object == nullptr) return default_value;
  const double value = to_number<double>(object, name);
  if (range.contains(value)) return value;
  throw InputException({"the water", name + (" = " + format_shortest(value)), range.describe(), "", ""});
}

Vec3 to_up(PyObject* object) {
  const Vec3 up_W = to_vector(object, "up", "(3,), a direction");
  const double largest = up_W.cwiseAbs().maxCoeff();
  if (!up_W.allFinite() || largest == 0.0) {
    throw InputException({"the water", "up = " + format_vector(up_W),
                          "a direction: three finite numbers, not all zero", "", ""});
  }
  return (up_W / largest).normalized();  // as for a scene file
}

}  // namespace

Water to_water(const WaterObjects& objects) {
  Water water;
  water.level = in_range(objects.level, "level", NumberRange::any("m"), water.level);
  water.density = in_range(objects.density, "density", NumberRange::from_zero("kg/m^3"), water.density);
  water.gravity = in_range(objects.gravity, "gravity", NumberRange::from_zero("m/s^2"), water.gravity);
  if (objects.up != nullptr) water.up_W = to_up(objects.up);
  return water;
}

QueryWater to_query_water(const WaterObjects& objects, PyObject* sea) {
  const Water water = to_water(objects);
  if (!is_given(sea)) {
    QueryWater at_rest;
    at_rest.at_rest = water;
    return at_rest;
  }
  const QuerySea& of_sea = instance_of<SeaObject>(sea).sea;
  const Water defaults;
  const auto refuse = [](const std::string& name, const std::string& given, const std::string& of_water) {
    throw py::value_error(name + " = " + given + " but the sea's is " + of_water +
                          "; expected one of them: leave " + name + " out, or give it to the Sea");
  };
  const auto check = [&](const char* name, double Water::*member) {
    const double given = water.*member;
    const double of_water = of_sea.water().*member;
    if (given == of_water || given == defaults.*member) return;
    refuse(name, format_shortest(given), format_shortest(of_water));
  };
  check("level", &Water::level);
  check("density", &Water::density);
  check("gravity", &Water::gravity);
  if (!of_sea.has_up(water.up_W) && water.up_W != defaults.up_W) {
    refuse("up", format_vector(water.up_W), format_vector(of_sea.water().up_W));
  }
  return water_of(of_sea);
}

}  // namespace buoyancy::python

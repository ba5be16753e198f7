#include "service/hydrostatics/water_points.h"

#include "hydrostatics/hydrostatics.h"

namespace buoyancy::service {

std::vector<std::string> column_names(const WaterPoints& points) {
  std::vector<std::string> names;
  for (const DraftMark& mark : points.marks) names.push_back("draft_" + mark.name);
  for (std::size_t i = 0; i < points.freeboards_B.size(); ++i) {
    names.push_back("freeboard_" + std::to_string(i + 1));
  }
  return names;
}

std::vector<double> readings(const WaterPoints& points, const ShipAxes& axes, double keel, const Vec3& up_B,
                             double height) {
  constexpr double kMinCosine = 1e-9;
  const double cosine = up_B.dot(axes.up_B);
  std::vector<double> values;
  for (const DraftMark& mark : points.marks) {
    const Vec3 at_B = mark.forward * axes.forward_B + mark.port * axes.port_B() + keel * axes.up_B;
    values.push_back(cosine > kMinCosine ? -(height + up_B.dot(at_B)) / cosine : kNaN);
  }
  for (const Vec3& point_B : points.freeboards_B) values.push_back(height + up_B.dot(point_B));
  return values;
}

void add_readings(Json& json, const WaterPoints& points, const std::vector<double>& values) {
  auto value = values.begin();
  for (const DraftMark& mark : points.marks) json["marks"][mark.name] = *value++;
  for (; value != values.end(); ++value) json["freeboards"].push_back(*value);
}

}  // namespace buoyancy::service

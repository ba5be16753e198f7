// What is read at places of a ship that floats: drafts at marks, and freeboards at points.
#pragma once

#include <string>
#include <vector>

#include "base/json.h"
#include "flotation/ship_axes.h"

namespace buoyancy::service {

// A mark is the place of a draft scale on the base line.
struct DraftMark {
  std::string name;
  double forward = 0.0;  // [m], from B's origin along the ship's axes
  double port = 0.0;
};

struct WaterPoints {
  std::vector<DraftMark> marks;
  std::vector<Vec3> freeboards_B;  // [m]
};

// Returns the names of the values below: draft_NAME of each mark, then freeboard_1 and so on.
std::vector<std::string> column_names(const WaterPoints& points);

// Returns the draft at each mark, then the freeboard at each point [m]. keel: [m], of the base line along up
// from B's origin. up_B: the world's up; height: [m], of B's origin over the water. A draft is the depth of
// the base line under the water at the mark, along the ship's up axis; NaN where that axis does not point up.
// A freeboard is the height over the water along the vertical; below 0 under water.
std::vector<double> readings(const WaterPoints& points, const ShipAxes& axes, double keel, const Vec3& up_B,
                             double height);

// Adds "marks", an object, and "freeboards", a list, if there are such points. values: of readings().
void add_readings(Json& json, const WaterPoints& points, const std::vector<double>& values);

}  // namespace buoyancy::service

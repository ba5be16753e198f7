// Core types of a request for the water at points and of its response: the content of water_points_t and
// water_samples_t, without LCM.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "messages/request.h"

namespace buoyancy {

struct WaterPoint {
  std::array<double, 3> position{};  // [m], W frame
};

struct WaterPoints {
  RequestId id;
  std::vector<WaterPoint> points;
};

// A request whose points are stored by the caller, so that they need not be copied.
struct BorrowedWaterPoints {
  RequestId id;
  std::span<const WaterPoint> points;

  BorrowedWaterPoints(const RequestId& of, std::span<const WaterPoint> at) : id(of), points(at) {}
  // NOLINTNEXTLINE(google-explicit-constructor): a request lends its points wherever they may be borrowed
  BorrowedWaterPoints(const WaterPoints& request) : id(request.id), points(request.points) {}
};

struct WaterSample {
  double elevation = 0.0;            // [m], over the level: of the surface above or below the point
  double pressure = 0.0;             // [Pa], over that of the air; 0 above the surface
  std::array<double, 3> velocity{};  // [m/s], W frame, current and waves; 0 above the surface
  double density =
      0.0;  // [kg/m^3], of the layer at the point; above the surface, of the water at the surface
};

struct WaterSamples {
  RequestId id;
  BodyStatus status =
      BodyStatus::kOk;               // kOk, kNonFinitePose, kOutOfRange or kNoSea; samples hold 0 but for kOk
  std::vector<WaterSample> samples;  // one per point
};

}  // namespace buoyancy

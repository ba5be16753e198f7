#include "view/common/body_statuses.h"

#include "messages/request.h"

namespace buoyancy::view {
namespace {

const char* meaning(BodyStatus status) {
  switch (status) {
    case BodyStatus::kOk:
      return "";
    case BodyStatus::kUnknownBody:
      return "the scene has no body with this id";
    case BodyStatus::kNonFinitePose:
      return "position or quaternion is NaN or infinite";
    case BodyStatus::kBadQuaternion:
      return "the quaternion's norm is not 1";
    case BodyStatus::kNonFiniteTwist:
      return "a velocity is NaN or infinite";
    case BodyStatus::kBadLeadTime:
      return "the lead time is NaN or infinite";
    case BodyStatus::kOpenEdgeWet:
      return "the mesh is open and its boundary is not entirely dry";
    case BodyStatus::kOutOfRange:
      return "the result exceeds the range of double";
    case BodyStatus::kNoSea:
      return "no sea has been received that holds at the request's time";
    case BodyStatus::kBadCondition:
      return "a received condition of a compartment or tank cannot be used";
    case BodyStatus::kNotCertified:
      return "the bound on the force's error is above the weight of the body's displacement";
  }
  return "";
}

}  // namespace

Json body_statuses() {
  Json statuses = Json::array();
  for (int i = 0; i < kBodyStatusCount; ++i) {
    const auto status = static_cast<BodyStatus>(i);
    statuses.push_back(Json::array({to_string(status), meaning(status)}));
  }
  return statuses;
}

}  // namespace buoyancy::view

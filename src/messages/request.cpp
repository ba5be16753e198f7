#include "messages/request.h"

namespace buoyancy {

const char* to_string(BodyStatus status) {
  switch (status) {
    case BodyStatus::kOk:
      return "OK";
    case BodyStatus::kUnknownBody:
      return "UNKNOWN_BODY";
    case BodyStatus::kNonFinitePose:
      return "NON_FINITE_POSE";
    case BodyStatus::kBadQuaternion:
      return "BAD_QUATERNION";
    case BodyStatus::kNonFiniteTwist:
      return "NON_FINITE_TWIST";
    case BodyStatus::kBadLeadTime:
      return "BAD_LEAD_TIME";
    case BodyStatus::kOpenEdgeWet:
      return "OPEN_EDGE_WET";
    case BodyStatus::kOutOfRange:
      return "OUT_OF_RANGE";
    case BodyStatus::kNoSea:
      return "NO_SEA";
    case BodyStatus::kBadCondition:
      return "BAD_CONDITION";
    case BodyStatus::kNotCertified:
      return "NOT_CERTIFIED";
  }
  return "UNKNOWN_STATUS";
}

}  // namespace buoyancy

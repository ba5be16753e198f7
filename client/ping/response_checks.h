// Compares the replies of a running service with this program's own, and records what differs and by how
// much.
//
// A check has passed if the difference is within the sum of both published bounds
// (engine/result_comparison.h); the same version on the same kind of machine gives the same bits. The
// submerged volume has no published bound: in water at rest that of the force over rho g holds for it too,
// and in waves its own bound is computed where the volumes differ, larger by as much as the service's bound
// on the force is.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "client/ping/service_link.h"
#include "engine/field_differences.h"
#include "engine/result_comparison.h"
#include "engine/water_at_time.h"
#include "messages/wire.h"
#include "scene/scene.h"

namespace buoyancy::ping {

enum class Check { kStatus, kForce, kTorque, kVolume, kCenter, kHydrostatics, kLoads };
inline constexpr std::array kAllChecks{Check::kStatus, Check::kForce,        Check::kTorque, Check::kVolume,
                                       Check::kCenter, Check::kHydrostatics, Check::kLoads};
std::string_view to_string(Check check);  // "center of buoyancy"

// One check of one body over all replies.
struct CheckResult {
  std::int64_t compared = 0;
  std::int64_t failed = 0;
  double worst = 0.0;   // the largest ratio of a difference to its limit; above 1: failed
  std::string failure;  // the message of the worst failure; empty: none
};

struct BodyChecks {
  std::int32_t body_id = 0;
  std::string name;
  std::array<CheckResult, kAllChecks.size()> results;  // in the order of kAllChecks
  WrenchDifferences largest;

  CheckResult& at(Check check) { return results[static_cast<std::size_t>(check)]; }
  const CheckResult& at(Check check) const { return results[static_cast<std::size_t>(check)]; }
};

// A wrench that differs from the expected one by more than is allowed.
struct DifferingWrench {
  const Body* body = nullptr;
  BodyState state;
  std::int64_t seq = 0;
  BodyWrench expected, received;
  bool force_differs = false, torque_differs = false, volume_differs = false, center_differs = false;
};

// What this program computed for a request; the outputs that the scene does not request are empty.
struct ExpectedReply {
  ByteVector wrenches, hydrostatics, loads;
};

class ResponseChecks {
 public:
  static constexpr std::size_t kMaxDiffering = 1024;  // wrenches that are kept

  // scene must outlive the checks.
  explicit ResponseChecks(const Scene& scene);

  // Sets the sea of a scene that receives it. Errors: those of SeaTimeline::receive().
  Expected<void> receive_sea(Bytes sea) { return water_.receive_sea(sea); }

  // states: the bodies of the request, in the order of the scene. received: holds wrenches; other outputs
  // that it lacks are not compared.
  void add(const RequestId& id, const std::vector<BodyState>& states, const ExpectedReply& expected,
           const Reply& received);

  const std::vector<BodyChecks>& bodies() const { return bodies_; }  // in the order of the scene
  std::int64_t replies() const { return replies_; }
  std::int64_t identical() const { return identical_; }  // replies with the same bits as expected
  // Number of replies whose ids or bodies are not those of the request, so that their values are not
  // compared, and a description of the first one.
  std::int64_t wrong_ids() const { return wrong_ids_; }
  const std::string& first_wrong_ids() const { return first_wrong_ids_; }
  const std::vector<DifferingWrench>& differing() const { return differing_; }
  // Does the service's buoyancy agree in every loads message although some wrench differs?
  bool only_motion_loads_differ() const { return loads_differ_ && !buoyancy_in_loads_differs_; }
  bool all_passed() const;

 private:
  // Returns false, and records it, if ids or bodies differ.
  template <typename Message>
  bool has_same_ids(const RequestId& id, const Message& expected, const Message& received,
                    std::string_view what);
  void compare_wrench(const RequestId& id, const BodyState& state, std::size_t body,
                      const BodyWrench& expected, const BodyWrench& received);
  double volume_limit(const RequestId& id, const BodyState& state, const Body& body,
                      const BodyWrench& expected, const BodyWrench& received);
  void compare_hydrostatics_of(const RequestId& id, const BodiesHydrostatics& expected,
                               const BodiesHydrostatics& received);
  void compare_loads_of(const RequestId& id, const BodiesLoads& expected, const BodiesLoads& received);

  const Scene* scene_;
  WaterAtTime water_;
  std::vector<BodyChecks> bodies_;
  std::int64_t replies_ = 0, identical_ = 0, wrong_ids_ = 0;
  std::string first_wrong_ids_;
  std::vector<DifferingWrench> differing_;
  bool loads_differ_ = false, buoyancy_in_loads_differs_ = false;
  WrenchResponse expected_wrenches_, received_wrenches_;              // reused
  BodiesHydrostatics expected_hydrostatics_, received_hydrostatics_;  // reused
  BodiesLoads expected_loads_, received_loads_;                       // reused
};

}  // namespace buoyancy::ping

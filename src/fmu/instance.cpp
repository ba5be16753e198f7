#include "fmu/instance.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <sstream>
#include <utility>

#include "base/format.h"
#include "base/number_range.h"
#include "base/text_file.h"
#include "engine/condition_range.h"
#include "hydrodynamics/hydrodynamic_load.h"
#include "messages/conversions.h"

namespace buoyancy::fmu {
namespace {

constexpr double kMaxSeconds = 9.2e12;                    // as many microseconds as an int64 holds
constexpr std::uint64_t kStateMark = 0x3154535546594f42;  // "BOYFUST1"

template <std::size_t kSize>
std::array<double, kSize> array_at(const std::vector<double>& values, std::size_t first) {
  std::array<double, kSize> array{};
  std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(first), kSize, array.begin());
  return array;
}

std::span<const double> all_of(const std::array<std::array<double, 6>, 6>& matrix) {
  return {matrix.front().data(), 36};
}

Mat6 to_matrix(const std::array<std::array<double, 6>, 6>& rows) {
  Mat6 matrix;
  for (Eigen::Index row = 0; row < 6; ++row) {
    for (Eigen::Index column = 0; column < 6; ++column) {
      matrix(row, column) = rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
    }
  }
  return matrix;
}

NumberRange range_of(Quantity quantity) {
  return quantity == Quantity::kDensity || quantity == Quantity::kGravity ? NumberRange::from_zero("")
                                                                          : NumberRange::any("");
}

}  // namespace

Expected<std::unique_ptr<Instance>> Instance::open(FmiVersion version, const std::filesystem::path& resources,
                                                   std::string_view token, Logger logger) {
  constexpr std::uintmax_t kMaxListBytes = 1'000'000;
  const Expected<std::string> list =
      read_text_file(resources / kInstantiationFile, "the bodies of the FMU", kMaxListBytes);
  if (!list) return make_error(list.error());
  std::istringstream lines(*list);
  std::string own_token;
  std::getline(lines, own_token);
  if (own_token != token) {
    return make_error({resources.string(), "the token '" + own_token + "'",
                       "the one that the instance was asked for with, '" + std::string(token) + "'",
                       "the library and the resources are of two FMUs", ""});
  }
  std::set<std::int32_t> ids;
  for (std::int32_t id = 0; lines >> id;) ids.insert(id);
  Expected<SceneDescription> description = read_scene_file(resources / kSceneFile);
  if (!description) return make_error(std::move(description.error()));
  std::erase_if(description->bodies, [&](const BodyDescription& body) { return !ids.contains(body.id); });
  Expected<Scene> scene = Scene::prepare(*description);
  if (!scene) return make_error(std::move(scene.error()));
  return std::unique_ptr<Instance>(
      new Instance(version, *std::move(description), *std::move(scene), std::move(logger)));
}

Instance::Instance(FmiVersion version, SceneDescription description, Scene scene, Logger logger)
    : version_(version),
      description_(std::move(description)),
      scene_(std::move(scene)),
      table_(scene_),
      logger_(std::move(logger)),
      values_(table_.start_values()),
      results_(scene_.bodies().size()) {
  for (const Body& body : scene_.bodies()) {
    conditions_.push_back(body.subdivision == nullptr ? BodyCondition{}
                                                      : initial_condition(*body.subdivision));
  }
}

Status Instance::set_logging(bool on, std::span<const char* const> categories) {
  std::array<bool, kLogCategories.size()> logged{};
  for (const char* const category : categories) {
    const auto known = std::ranges::find_if(kLogCategories, [category](const char* name) {
      return category != nullptr && std::strcmp(category, name) == 0;
    });
    if (known == kLogCategories.end()) return report(Status::kError, "no such category of log messages");
    logged[static_cast<std::size_t>(known - kLogCategories.begin())] = on;
  }
  if (categories.empty()) logged.fill(on);
  logged_ = logged;
  return Status::kOk;
}

Status Instance::report(Status status, const std::string& message) const {
  const std::size_t category = status == Status::kWarning ? 1 : 2;
  if (logger_ && (logged_[0] || logged_[category])) logger_(status, kLogCategories[category], message);
  return status;
}

Status Instance::enter_initialization() {
  phase_ = Phase::kInitialization;
  return Status::kOk;
}

Status Instance::exit_initialization() {
  if (const Expected<void> set = set_water(); !set) return report(Status::kError, set.error().message());
  phase_ = Phase::kStep;
  return Status::kOk;
}

void Instance::reset() {
  phase_ = Phase::kInstantiated;
  values_ = table_.start_values();
  is_water_set_ = false;
  forget_results();
  for (BodyResult& result : results_) result.reported = BodyStatus::kOk;
}

Status Instance::set_time(double seconds) {
  if (!(std::abs(seconds) <= kMaxSeconds)) {
    return report(Status::kError, "the time is " + format_shortest(seconds) +
                                      " s; expected finite seconds within 9.2e12 of 0");
  }
  if (seconds != values_.front() && scene_.sea() != nullptr) forget_results();
  values_.front() = seconds;
  return Status::kOk;
}

void Instance::forget_results() {
  for (BodyResult& result : results_) result.has_wrench = result.has_stiffness = false;
}

std::optional<Instance::Values> Instance::find(std::uint32_t reference) const {
  const Variable* const variable = table_.owner(reference);
  if (variable == nullptr) return std::nullopt;
  if (version_ == FmiVersion::k2) return Values{variable, reference, 1};
  if (variable->first != reference) return std::nullopt;
  return Values{variable, reference, variable->size};
}

Expected<std::vector<Instance::Values>> Instance::resolve(std::span<const std::uint32_t> references,
                                                          std::size_t count) const {
  std::vector<Values> resolved;
  std::size_t total = 0;
  for (const std::uint32_t reference : references) {
    const std::optional<Values> values = find(reference);
    if (!values) {
      return make_error({"value reference " + std::to_string(reference), "no such variable",
                         "one of the model description", "", ""});
    }
    resolved.push_back(*values);
    total += values->size;
  }
  if (total != count) {
    return make_error(
        {"the values", std::to_string(count), std::to_string(total) + " for these variables", "", ""});
  }
  return resolved;
}

template <typename Number>
Status Instance::get(std::span<const std::uint32_t> references, std::span<Number> values) {
  const Expected<std::vector<Values>> resolved = resolve(references, values.size());
  if (!resolved) return report(Status::kError, resolved.error().message());
  for (const Values& of : *resolved) {
    if (of.variable->is_integer() != std::is_integral_v<Number>) {
      return report(Status::kError, of.variable->name + " has another type");
    }
  }
  Status status = Status::kOk;
  std::size_t next = 0;
  for (const Values& of : *resolved) {
    status = std::max(status, compute(of));
    if (status == Status::kError) return status;
    for (std::size_t i = 0; i < of.size; ++i) values[next++] = static_cast<Number>(values_[of.first + i]);
  }
  return status;
}
template Status Instance::get(std::span<const std::uint32_t> references, std::span<double> values);
template Status Instance::get(std::span<const std::uint32_t> references, std::span<std::int32_t> values);

Status Instance::set(std::span<const std::uint32_t> references, std::span<const double> values) {
  const Expected<std::vector<Values>> resolved = resolve(references, values.size());
  if (!resolved) return report(Status::kError, resolved.error().message());
  std::size_t next = 0;
  for (const Values& of : *resolved) {
    const Variable& variable = *of.variable;
    const bool is_parameter = variable.causality == Causality::kParameter;
    if (variable.causality != Causality::kInput && (!is_parameter || phase_ == Phase::kStep)) {
      return report(Status::kError, variable.name + " cannot be set" + (is_parameter ? " any more" : ""));
    }
    for (const double value : values.subspan(next, of.size)) {
      if (is_parameter && !range_of(variable.quantity).contains(value)) {
        return report(Status::kError, variable.name + " = " + format_shortest(value) + "; expected " +
                                          range_of(variable.quantity).describe());
      }
    }
    next += of.size;
  }
  next = 0;
  for (const Values& of : *resolved) {
    if (of.variable->causality == Causality::kParameter) {
      is_water_set_ = false;
      forget_results();
    } else {
      BodyResult& result = results_[of.variable->body];
      result.has_wrench = result.has_stiffness = false;
    }
    for (std::size_t i = 0; i < of.size; ++i) values_[of.first + i] = values[next++];
  }
  return Status::kOk;
}

Expected<void> Instance::set_water() {
  if (is_water_set_) return {};
  water_ = scene_.water();
  current_ = scene_.current();
  for (const Variable& variable : table_.variables()) {
    const double value = values_[variable.first];
    if (variable.quantity == Quantity::kLevel) water_.level = value;
    if (variable.quantity == Quantity::kDensity) water_.density = value;
    if (variable.quantity == Quantity::kGravity) water_.gravity = value;
    if (variable.quantity == Quantity::kCurrent) {
      current_.velocity_W = to_vec3(array_at<3>(values_, variable.first));
    }
  }
  waves_.reset();
  sea_ = scene_.prepared_sea();
  const bool is_of_scene = water_.level == scene_.water().level && water_.density == scene_.water().density &&
                           water_.gravity == scene_.water().gravity && current_ == scene_.current();
  if (sea_ != nullptr && !is_of_scene) {
    SeaDescription description = description_.sea;
    description.current_W = current_.velocity_W;
    Expected<Sea> sea = Sea::make(description, water_);
    if (!sea) return make_error(std::move(sea.error()));
    sea_ = std::make_shared<const PreparedSea>(*std::move(sea));
  }
  is_water_set_ = true;
  return {};
}

const SeaAtTime* Instance::waves_now() {
  if (sea_ == nullptr) return nullptr;
  const std::int64_t utime = std::llround(time() * 1e6);
  if (waves_) {
    waves_->set_time(utime);
  } else {
    waves_.emplace(*sea_, utime);
  }
  return waves_->amplitude_factor() > 0.0 ? &*waves_ : nullptr;
}

Status Instance::compute(const Values& values) {
  const Variable& variable = *values.variable;
  if (variable.causality != Causality::kOutput) return Status::kOk;
  if (const Expected<void> set = set_water(); !set) return report(Status::kError, set.error().message());
  BodyResult& result = results_[variable.body];
  const Status status = result.has_wrench ? Status::kOk : compute_wrench(variable.body);
  result.has_wrench = true;
  if (variable.quantity == Quantity::kStiffness && !result.has_stiffness) {
    store(variable.body, Quantity::kStiffness, all_of(hydrostatics_of(variable.body).stiffness));
    result.has_stiffness = true;
  }
  return status;
}

BodyState Instance::state_of(std::size_t body) const {
  const auto at = [&](Quantity quantity) { return table_.place(body, quantity).value(); };
  return {.body_id = scene_.bodies()[body].id,
          .position = array_at<3>(values_, at(Quantity::kPosition)),
          .quaternion_wxyz = array_at<4>(values_, at(Quantity::kQuaternion)),
          .linear_velocity = array_at<3>(values_, at(Quantity::kLinearVelocity)),
          .angular_velocity = array_at<3>(values_, at(Quantity::kAngularVelocity))};
}

const BodyCondition* Instance::condition_of(std::size_t body) {
  BodyCondition& condition = conditions_[body];
  for (std::size_t i = 0; i < condition.flooded.size(); ++i) {
    condition.flooded[i] = values_[table_.place(body, Quantity::kFlooded).value() + i];
    if (!kFloodedRange.contains(condition.flooded[i])) return nullptr;
  }
  for (std::size_t i = 0; i < condition.liquid_volumes.size(); ++i) {
    const std::optional<double> volume =
        usable_liquid_volume(scene_.bodies()[body].subdivision->tanks[i],
                             values_[table_.place(body, Quantity::kLiquidVolume).value() + i]);
    if (!volume) return nullptr;
    condition.liquid_volumes[i] = *volume;
  }
  return &condition;
}

Status Instance::compute_wrench(std::size_t index) {
  const Body& body = scene_.bodies()[index];
  const BodyCondition* const condition = body.subdivision == nullptr ? nullptr : condition_of(index);
  const StateEvaluation evaluation =
      evaluate_state(body, {&water_, waves_now()}, current_, state_of(index), 0.0, condition);
  const BodyWrench& wrench = evaluation.wrench;
  const auto store_one = [&](Quantity quantity, double value) { store(index, quantity, {&value, 1}); };
  store_one(Quantity::kStatus, static_cast<double>(wrench.status));
  store(index, Quantity::kForce, wrench.force);
  store(index, Quantity::kTorque, wrench.torque);
  store_one(Quantity::kSubmergedVolume, wrench.submerged_volume);
  store(index, Quantity::kCenterOfBuoyancy, wrench.center_of_buoyancy);
  store_one(Quantity::kForceErrorBound, wrench.force_error_bound);
  store_one(Quantity::kTorqueErrorBound, wrench.torque_error_bound);
  if (body.hydrodynamics != nullptr) {
    const BodyLoads loads = evaluation.loads.value_or(BodyLoads{});
    store(index, Quantity::kAddedMass, all_of(loads.added_mass));
    store(index, Quantity::kDamping, all_of(loads.damping));
  }
  const bool is_new = wrench.status != std::exchange(results_[index].reported, wrench.status);
  if (!is_new || wrench.status == BodyStatus::kOk) return Status::kOk;
  return report(Status::kWarning, "body " + std::to_string(body.id) + " (" + body.name + ") has the status " +
                                      to_string(wrench.status) + ": its outputs are 0");
}

BodyHydrostatics Instance::hydrostatics_of(std::size_t index) {
  const Body& body = scene_.bodies()[index];
  const BodyState state = state_of(index);
  const auto status = static_cast<BodyStatus>(
      static_cast<std::int32_t>(values_[table_.place(index, Quantity::kStatus).value()]));
  ServiceCounters counters;
  return evaluate_hydrostatics(body, water_, validate_pose(state, 0.0).pose, status, counters,
                               body.subdivision == nullptr ? nullptr : &conditions_[index]);
}

void Instance::store(std::size_t body, Quantity quantity, std::span<const double> values) {
  std::ranges::copy(values,
                    values_.begin() + static_cast<std::ptrdiff_t>(table_.place(body, quantity).value()));
}

Expected<Vec6> Instance::derivative(std::size_t index, std::span<const Values> knowns,
                                    std::span<const double> seed) {
  const Body& body = scene_.bodies()[index];
  if (!has_derivatives(scene_, body)) {
    return make_error({"body " + std::to_string(body.id), "its derivatives",
                       "water at rest, and the method hierarchical", "", ""});
  }
  std::array<double, 3> moved{}, velocity{}, angular_velocity{};
  std::array<double, 4> turned{};
  bool is_moved = false;
  std::size_t next = 0;
  for (const Values& of : knowns) {
    const Quantity quantity = of.variable->quantity;
    const std::span<double> change = quantity == Quantity::kPosition         ? std::span<double>(moved)
                                     : quantity == Quantity::kQuaternion     ? std::span<double>(turned)
                                     : quantity == Quantity::kLinearVelocity ? std::span<double>(velocity)
                                     : quantity == Quantity::kAngularVelocity
                                         ? std::span<double>(angular_velocity)
                                         : std::span<double>();
    if (change.empty()) {
      return make_error({of.variable->name, "its derivative", "one by a pose or a velocity", "", ""});
    }
    for (std::size_t i = 0; i < of.size; ++i, ++next) {
      if (of.variable->body != index) continue;
      change[of.first - of.variable->first + i] += seed[next];
      is_moved = is_moved || quantity == Quantity::kPosition || quantity == Quantity::kQuaternion;
    }
  }
  if (is_moved && body.hydrodynamics != nullptr) {
    return make_error({"body " + std::to_string(body.id), "its derivative by the pose",
                       "one by its velocities, since it has drag or added mass", "", ""});
  }
  const BodyState state = state_of(index);
  const Eigen::Quaterniond& q_WB = validate_pose(state, 0.0).pose.q_WB;
  const Vec3 reference_W = q_WB.normalized() * body.reference_B;
  // The change of the reference point and of the rotation, about W's axes, per change of a pose or velocity.
  const auto about_reference = [&](const std::array<double, 3>& linear, const Vec3& angular) {
    Vec6 twist;
    twist << to_vec3(linear) + angular.cross(reference_W), angular;
    return twist;
  };
  Vec6 change = Vec6::Zero();
  if (is_moved) {
    const Eigen::Quaterniond turn(turned[0], turned[1], turned[2], turned[3]);
    const Vec3 rotation_W = 2.0 * (turn * q_WB.conjugate()).vec() / q_WB.squaredNorm();
    change -= to_matrix(hydrostatics_of(index).stiffness) * about_reference(moved, rotation_W);
  }
  if (body.hydrodynamics != nullptr) {
    const auto damping = array_at<36>(values_, table_.place(index, Quantity::kDamping).value());
    const Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>> damping_W(damping.data());
    change -= damping_W * about_reference(velocity, to_vec3(angular_velocity));
  }
  return change;
}

Status Instance::directional_derivative(std::span<const std::uint32_t> unknowns,
                                        std::span<const std::uint32_t> knowns, std::span<const double> seed,
                                        std::span<double> sensitivity) {
  const Expected<std::vector<Values>> of_unknowns = resolve(unknowns, sensitivity.size());
  const Expected<std::vector<Values>> of_knowns = resolve(knowns, seed.size());
  if (!of_unknowns || !of_knowns) {
    return report(Status::kError, (of_unknowns ? of_knowns : of_unknowns).error().message());
  }
  Status status = Status::kOk;
  std::size_t next = 0;
  for (const Values& of : *of_unknowns) {
    const Variable& variable = *of.variable;
    const bool is_torque = variable.quantity == Quantity::kTorque;
    if (!is_torque && variable.quantity != Quantity::kForce) {
      return report(Status::kError, variable.name + " has no directional derivatives: force and torque have");
    }
    status = std::max(status, compute(of));
    if (status == Status::kError) return status;
    const Expected<Vec6> change = derivative(variable.body, *of_knowns, seed);
    if (!change) return report(Status::kError, change.error().message());
    for (std::size_t i = 0; i < of.size; ++i) {
      sensitivity[next++] =
          (*change)[static_cast<Eigen::Index>((is_torque ? 3 : 0) + of.first - variable.first + i)];
    }
  }
  return status;
}

void* Instance::save_state(void* replaced) {
  const auto known = std::ranges::find(states_, replaced, &std::unique_ptr<SavedState>::get);
  if (known != states_.end()) {
    **known = {values_, phase_};
    return replaced;
  }
  return states_.emplace_back(std::make_unique<SavedState>(SavedState{values_, phase_})).get();
}

Status Instance::restore_state(const void* state) {
  const auto known = std::ranges::find(states_, state, &std::unique_ptr<SavedState>::get);
  if (known == states_.end()) return report(Status::kError, "no state of this instance");
  values_ = (*known)->values;
  phase_ = (*known)->phase;
  is_water_set_ = false;
  forget_results();
  return Status::kOk;
}

bool Instance::free_state(const void* state) {
  return std::erase_if(states_, [state](const auto& saved) { return saved.get() == state; }) > 0;
}

std::size_t Instance::serialized_size() const {
  return sizeof kStateMark + 1 + values_.size() * sizeof(double);
}

Status Instance::serialize(const void* state, std::span<std::uint8_t> bytes) {
  const auto known = std::ranges::find(states_, state, &std::unique_ptr<SavedState>::get);
  if (known == states_.end() || bytes.size() < serialized_size()) {
    return report(Status::kError, "no state of this instance, or too few bytes for it");
  }
  std::uint8_t* const end = bytes.data() + sizeof kStateMark;
  std::memcpy(bytes.data(), &kStateMark, sizeof kStateMark);
  *end = static_cast<std::uint8_t>((*known)->phase);
  std::memcpy(end + 1, (*known)->values.data(), values_.size() * sizeof(double));
  return Status::kOk;
}

void* Instance::deserialize(std::span<const std::uint8_t> bytes) {
  std::uint64_t mark = 0;
  if (bytes.size() != serialized_size()) return nullptr;
  std::memcpy(&mark, bytes.data(), sizeof mark);
  const std::uint8_t phase = bytes[sizeof mark];
  if (mark != kStateMark || (phase != 1 && phase != 2 && phase != 4 && phase != 8)) return nullptr;
  std::vector<double> values(values_.size());
  std::memcpy(values.data(), bytes.data() + sizeof mark + 1, values.size() * sizeof(double));
  if (!(std::abs(values.front()) <= kMaxSeconds)) return nullptr;
  for (const Variable& variable : table_.variables()) {
    if (variable.causality != Causality::kParameter) continue;
    for (std::size_t i = 0; i < variable.size; ++i) {
      if (!range_of(variable.quantity).contains(values[variable.first + i])) return nullptr;
    }
  }
  return states_.emplace_back(std::make_unique<SavedState>(SavedState{std::move(values), Phase{phase}}))
      .get();
}

}  // namespace buoyancy::fmu

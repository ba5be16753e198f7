// Fuzz target: bytes to a mesh, a pose, water and a reference point. Every method must return finite numbers
// or a status for all of them. If every value is 0 or of magnitude 2^-40 to 2^40, the errors must be within
// the bounds that the method publishes.
//
//   options    1 byte: bits 0-1 encoding of pose, water and reference point (0 int8; 1 two int8, the second
//              in units of 2^-26; 2 float32; 3 double), bit 2 up is encoded too, bit 3 density and gravity
//              are encoded too, bit 4 the water plane passes through a vertex, bit 5 the mesh is encoded
//   mesh       1 byte: index of a mesh below, if none is encoded
//   tolerance  1 byte t: 0 none, else 2^-(t / 4), for a second run of `hierarchical`
//   target     1 byte: index of one of the processor's instruction sets
//   vertex     1 byte: the vertex that the water plane passes through, 1 int8: offset in ulp
//   scale      1 int8 e: position, level and reference point are multiplied by 2^e
//   then q_WB (w, x, y, z), p_WB, level, reference point, up, density, gravity, and a mesh (fuzz_mesh.h)
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "geometry/shapes.h"
#include "hydrostatics/buoyancy.h"
#include "hydrostatics/hydrostatics.h"
#include "hydrostatics/wetted_tree_sum.h"
#include "tests/fuzz/fuzz_bytes.h"
#include "tests/fuzz/fuzz_check.h"
#include "tests/fuzz/fuzz_mesh.h"
#include "tests/geometry/sample_meshes.h"
#include "tests/hydrostatics/test_meshes.h"
#include "tests/truth/truth.h"

namespace buoyancy {
namespace {

constexpr std::size_t kMaxTriangles = 120;  // of an encoded mesh
constexpr int kMaxExponent = 40;  // of a value where bounds are checked: nothing overflows or underflows

// A mesh for the oracle, and the same mesh prepared for the methods.
struct Subject {
  TriangleMesh source;
  HydrostaticMesh mesh;
};

std::optional<Subject> subject_of(const TriangleMesh& source, OpenPolicy open = OpenPolicy::kRefuse) {
  ImportedMesh imported;
  imported.mesh = source;
  const MeshValidation validation = validate_mesh(imported, "fuzz", {.open = open});
  if (!validation.mesh) return std::nullopt;
  return Subject{validation.mesh->mesh, make_hydrostatic_mesh(*validation.mesh)};
}

const std::vector<Subject>& subjects() {
  static const std::vector<Subject> kSubjects = [] {
    const TriangleMesh box = make_shape(BoxShape{});
    const TriangleMesh rock = make_shape(RockShape{.frequency = 2, .roughness = 0.5, .seed = 3});
    const TriangleMesh fine_box = make_shape(BoxShape{.size = {1, 2, 3}, .segments = {2, 2, 2}});
    const TriangleMesh cavity = moved_and_scaled(inside_out(box), {0.125, 0, 0}, 0.5);
    std::vector<Subject> list;
    for (const TriangleMesh& mesh :
         {box, fine_box, rock, make_shape(BoxShape{.size = {1, 1, 1e-8}, .segments = {2, 2, 1}}),
          make_shape(BoxShape{.size = {8192, 1, 1}, .segments = {4, 1, 1}}),
          make_shape(ConeShape{.segments = 5, .stacks = 2}), make_shape(SphereShape{.segments = 5}),
          make_shape(WigleyShape{.segments = 4, .levels = 2}), joined(box, cavity),
          joined(box, moved_and_scaled(box, {3, 0, 1})), moved_and_scaled(rock, Vec3::Zero(), 1e-6),
          moved_and_scaled(rock, Vec3::Zero(), 1e6), moved_and_scaled(rock, {600, -800, 100}),
          moved_and_scaled(rock, {6e5, -8e5, 1e5})}) {
      std::optional<Subject> subject = subject_of(mesh);
      require(subject.has_value(), "the target's own meshes are accepted");
      list.push_back(*std::move(subject));
    }
    return list;
  }();
  return kSubjects;
}

struct Case {
  std::size_t mesh = 0;
  bool mesh_is_encoded = false;
  double tolerance = 0.0;
  std::size_t target = 0;
  Pose pose;
  Water water;
  Vec3 reference_B = Vec3::Zero();
};

class CaseReader {
 public:
  explicit CaseReader(FuzzBytes& bytes) : bytes_(&bytes) {}

  Case read() {
    const unsigned options = bytes_->byte();
    encoding_ = options & 3U;
    Case read;
    read.mesh = bytes_->byte();
    read.mesh_is_encoded = (options & 32U) != 0;
    const int tolerance = bytes_->byte();
    if (tolerance > 0) read.tolerance = std::exp2(-0.25 * tolerance);
    read.target = bytes_->byte();
    vertex_ = bytes_->byte();
    ulps_ = bytes_->small();
    through_a_vertex_ = (options & 16U) != 0;
    scale_ = bytes_->small();
    const double w = coordinate(*bytes_, encoding_);
    const Vec3 u = vector(0);
    read.pose.q_WB = Eigen::Quaterniond(w, u.x(), u.y(), u.z());
    read.pose.p_WB = vector(scale_);
    read.water.level = std::ldexp(coordinate(*bytes_, encoding_), scale_);
    read.reference_B = vector(scale_);
    read.water.density = 1.0;
    read.water.gravity = 1.0;
    if ((options & 4U) != 0) read.water.up_W = direction();
    if ((options & 8U) != 0) {
      read.water.density = std::abs(coordinate(*bytes_, encoding_));
      read.water.gravity = std::abs(coordinate(*bytes_, encoding_));
    }
    return read;
  }

  // Sets the level so that the water plane passes through a vertex, if that option is set.
  void aim(const TriangleMesh& mesh, Case& read) const {
    if (!through_a_vertex_) return;
    const Vec3 vertex_B = mesh.vertex(static_cast<std::int32_t>(vertex_ % mesh.vertex_count()));
    double level = read.water.up_W.dot(read.pose.q_WB.normalized() * vertex_B + read.pose.p_WB);
    for (int i = 0; i < std::abs(ulps_); ++i) level = std::nextafter(level, ulps_ > 0 ? INFINITY : -INFINITY);
    read.water.level = level;
  }

 private:
  Vec3 vector(int scale) {
    Vec3 v;
    for (double& value : v) value = std::ldexp(coordinate(*bytes_, encoding_), scale);
    return v;
  }
  Vec3 direction() {
    const Vec3 v = vector(0);
    const double max = v.cwiseAbs().maxCoeff();
    if (!v.allFinite() || max == 0.0) return Vec3::UnitZ();
    return (v / max).normalized();
  }

  FuzzBytes* bytes_;
  unsigned encoding_ = 0;
  std::size_t vertex_ = 0;
  int ulps_ = 0;
  int scale_ = 0;
  bool through_a_vertex_ = false;
};

// The preconditions of buoyancy().
bool is_valid_input(const Case& input) {
  return input.pose.p_WB.allFinite() && input.pose.q_WB.coeffs().allFinite() &&
         !input.pose.q_WB.coeffs().isZero(0.0) && std::isfinite(input.water.level) &&
         std::isfinite(input.water.density) && std::isfinite(input.water.gravity) &&
         input.reference_B.allFinite();
}

bool is_moderate(double value) {
  return value == 0.0 || (std::abs(value) <= std::ldexp(1.0, kMaxExponent) &&
                          std::abs(value) >= std::ldexp(1.0, -kMaxExponent));
}

template <typename Values>
bool all_moderate(const Values& values) {
  return std::all_of(values.begin(), values.end(), is_moderate);
}

bool is_moderate(const Case& input, const Subject& subject) {
  const std::array<double, 3> water{input.water.level, input.water.density, input.water.gravity};
  return all_moderate(water) && all_moderate(input.water.up_W) && all_moderate(input.pose.p_WB) &&
         all_moderate(input.pose.q_WB.coeffs()) && all_moderate(input.reference_B) &&
         all_moderate(subject.source.x) && all_moderate(subject.source.y) && all_moderate(subject.source.z);
}

void check_within(const char* what, Method method, double error, double bound) {
  if (error <= bound) return;
  std::array<char, 120> figures{};
  std::snprintf(figures.data(), figures.size(), "error of the %s of %s: %.4g, bound %.4g", what,
                std::string(to_string(method)).c_str(), error, bound);
  fail_requirement("the published bound holds", figures.data());
}

void check_result(const BuoyancyResult& result) {
  require(result.force_W.allFinite() && result.torque_W.allFinite() && std::isfinite(result.volume) &&
              result.center_of_buoyancy_W.allFinite(),
          "a result holds finite numbers");
  if (result.status != BuoyancyStatus::kOk) {
    require(result.force_W.isZero(0.0) && result.torque_W.isZero(0.0) && result.volume == 0.0 &&
                result.center_of_buoyancy_W.isZero(0.0),
            "a result whose status is not OK is zero");
  }
}

void check_method(const Solver& solver, const Case& input, const Truth* truth) {
  const BuoyancyResult result = buoyancy(solver, input.pose, input.water, input.reference_B);
  check_result(result);
  if (result.status != BuoyancyStatus::kOk || truth == nullptr) return;
  require(std::isfinite(result.force_error_bound) && std::isfinite(result.torque_error_bound),
          "every method has bounds");
  check_within("force", solver.method(), truth->force_error(result.force_W, result.force_error_bound),
               result.force_error_bound);
  check_within("torque", solver.method(), truth->torque_error(result.torque_W, result.torque_error_bound),
               result.torque_error_bound);
}

void check_hydrostatics(const Case& input, const Subject& subject, const Truth* truth) {
  const auto found =
      hydrostatics(subject.mesh, input.pose, input.water, input.reference_B, subject.mesh.center_B);
  if (!found) return;
  require(std::isfinite(found->volume) && found->stiffness.allFinite() && found->waterplane_area >= 0.0 &&
              found->wetted_area >= 0.0,
          "hydrostatics are finite");
  if (truth == nullptr) return;
  const double bound = subject.mesh.max_rounding_bound();
  check_within("volume", Method::kHierarchical, truth->volume_error(found->volume, bound), bound);
}

void check(FuzzBytes bytes) {
  CaseReader reader(bytes);
  Case input = reader.read();
  std::optional<Subject> encoded;
  if (input.mesh_is_encoded) {
    const FuzzMesh mesh = read_mesh(bytes);
    if (mesh.imported.mesh.triangles.size() > kMaxTriangles) return;
    encoded = subject_of(mesh.imported.mesh, mesh.options.open);
    if (!encoded) return;
  }
  const Subject& subject = encoded ? *encoded : subjects()[input.mesh % subjects().size()];
  if (!is_valid_input(input)) return;
  reader.aim(subject.source, input);
  if (!std::isfinite(input.water.level)) return;

  static const std::vector<std::string> kTargets = simd_targets();
  force_simd_target(kTargets[input.target % kTargets.size()]);
  std::optional<Truth> known;
  if (is_moderate(input, subject)) {
    known.emplace(std::vector{&subject.source}, input.pose, input.water, input.reference_B);
  }
  const Truth* truth = known ? &*known : nullptr;
  for (const Method method : kAllMethods) check_method(Solver(subject.mesh, method), input, truth);
  check_method(Solver(subject.mesh, Method::kHierarchical, input.tolerance), input, truth);
  if (buoyancy(Solver(subject.mesh, Method::kHierarchical), input.pose, input.water, input.reference_B)
          .status == BuoyancyStatus::kOk) {
    check_hydrostatics(input, subject, truth);
  }
}

}  // namespace
}  // namespace buoyancy

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  buoyancy::check(buoyancy::FuzzBytes({data, size}));
  return 0;
}

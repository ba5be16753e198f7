// Bytes to a mesh, a pose, water and a reference point. Whatever they are, every method answers with numbers
// or with a status. Where every value is moderate (wrench_truth.h), it must be within the bounds that it
// publishes of the truth.
//
//   options    1 byte: bits 0-1 how pose, water and reference point are written (0 int8; 1 two int8, the
//              second 2^-26 of the first; 2 float32; 3 double), bit 2 up is written too, bit 3 density and
//              gravity are written too, bit 4 the water goes through a vertex, bit 5 the mesh is written
//   mesh       1 byte: which of the meshes below, where it is not written
//   tolerance  1 byte t: 0 none, else 2^-(t / 4), of `hierarchical` a second time
//   target     1 byte: which of the processor's instruction sets
//   vertex     1 byte: which the water goes through, 1 int8: how many ulp off
//   scale      1 int8 e: position, level and reference point are multiplied by 2^e
//   then q_WB (w, x, y, z), p_WB, level, reference point, up, density, gravity, and a mesh (fuzz_mesh.h)
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "geometry/shapes.h"
#include "hydrostatics/buoyancy.h"
#include "hydrostatics/hydrostatics.h"
#include "hydrostatics/wetted_tree_sum.h"
#include "tests/fuzz/fuzz_bytes.h"
#include "tests/fuzz/fuzz_check.h"
#include "tests/fuzz/fuzz_mesh.h"
#include "tests/fuzz/wrench_truth.h"
#include "tests/geometry/sample_meshes.h"
#include "tests/hydrostatics/test_meshes.h"

namespace buoyancy {
namespace {

constexpr std::size_t kMaxTriangles = 120;  // of a written mesh; the truth takes some 10 us for each

// A mesh, prepared, as the oracle and as the methods see it.
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
      law(subject.has_value(), "the target's own meshes are accepted");
      list.push_back(*std::move(subject));
    }
    return list;
  }();
  return kSubjects;
}

struct Case {
  std::size_t mesh = 0;
  bool mesh_is_written = false;
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
    writing_ = options & 3U;
    Case read;
    read.mesh = bytes_->byte();
    read.mesh_is_written = (options & 32U) != 0;
    const int tolerance = bytes_->byte();
    if (tolerance > 0) read.tolerance = std::exp2(-0.25 * tolerance);
    read.target = bytes_->byte();
    vertex_ = bytes_->byte();
    ulps_ = bytes_->small();
    through_a_vertex_ = (options & 16U) != 0;
    scale_ = bytes_->small();
    const double w = coordinate(*bytes_, writing_);
    const Vec3 u = vector(0);
    read.pose.q_WB = Eigen::Quaterniond(w, u.x(), u.y(), u.z());
    read.pose.p_WB = vector(scale_);
    read.water.level = std::ldexp(coordinate(*bytes_, writing_), scale_);
    read.reference_B = vector(scale_);
    read.water.density = 1.0;
    read.water.gravity = 1.0;
    if ((options & 4U) != 0) read.water.up_W = direction();
    if ((options & 8U) != 0) {
      read.water.density = std::abs(coordinate(*bytes_, writing_));
      read.water.gravity = std::abs(coordinate(*bytes_, writing_));
    }
    return read;
  }

  // Sets the level so that the water's surface passes through a vertex, where the bytes say so.
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
    for (double& value : v) value = std::ldexp(coordinate(*bytes_, writing_), scale);
    return v;
  }
  Vec3 direction() {
    const Vec3 v = vector(0);
    const double largest = v.cwiseAbs().maxCoeff();
    if (!v.allFinite() || largest == 0.0) return Vec3::UnitZ();
    return (v / largest).normalized();
  }

  FuzzBytes* bytes_;
  unsigned writing_ = 0;
  std::size_t vertex_ = 0;
  int ulps_ = 0;
  int scale_ = 0;
  bool through_a_vertex_ = false;
};

// What buoyancy() asks of its callers.
bool is_valid_input(const Case& asked) {
  return asked.pose.p_WB.allFinite() && asked.pose.q_WB.coeffs().allFinite() &&
         !asked.pose.q_WB.coeffs().isZero(0.0) && std::isfinite(asked.water.level) &&
         std::isfinite(asked.water.density) && std::isfinite(asked.water.gravity) &&
         asked.reference_B.allFinite();
}

bool is_moderate(double value) {
  return value == 0.0 || (std::abs(value) <= std::ldexp(1.0, kMaxExponent) &&
                          std::abs(value) >= std::ldexp(1.0, -kMaxExponent));
}

template <typename Values>
bool all_moderate(const Values& values) {
  return std::all_of(values.begin(), values.end(), is_moderate);
}

bool is_moderate(const Case& asked, const Subject& subject) {
  const std::array<double, 3> water{asked.water.level, asked.water.density, asked.water.gravity};
  return all_moderate(water) && all_moderate(asked.water.up_W) && all_moderate(asked.pose.p_WB) &&
         all_moderate(asked.pose.q_WB.coeffs()) && all_moderate(asked.reference_B) &&
         all_moderate(subject.source.x) && all_moderate(subject.source.y) && all_moderate(subject.source.z);
}

void check_within(const char* what, Method method, double error, double bound) {
  if (error <= bound) return;
  std::array<char, 120> figures{};
  std::snprintf(figures.data(), figures.size(), "%s of %s off by %.4g, bound %.4g", what,
                std::string(to_string(method)).c_str(), error, bound);
  fail_requirement("the published bound holds", figures.data());
}

void check_result(const BuoyancyResult& result) {
  law(result.force_W.allFinite() && result.torque_W.allFinite() && std::isfinite(result.volume) &&
          result.center_of_buoyancy_W.allFinite(),
      "a result holds numbers");
  if (result.status != BuoyancyStatus::kOk) {
    law(result.force_W.isZero(0.0) && result.torque_W.isZero(0.0) && result.volume == 0.0 &&
            result.center_of_buoyancy_W.isZero(0.0),
        "what is not answered is zero");
  }
}

void check_method(const Solver& solver, const Case& asked, const TrueWrench* truth) {
  const BuoyancyResult result = buoyancy(solver, asked.pose, asked.water, asked.reference_B);
  check_result(result);
  if (result.status != BuoyancyStatus::kOk || truth == nullptr) return;
  law(std::isfinite(result.force_error_bound) && std::isfinite(result.torque_error_bound),
      "every method has bounds");
  check_within("force", solver.method(), truth->force_error(result.force_W), result.force_error_bound);
  check_within("torque", solver.method(), truth->torque_error(result.torque_W), result.torque_error_bound);
}

void check_hydrostatics(const Case& asked, const Subject& subject, const TrueWrench* truth) {
  const auto found =
      hydrostatics(subject.mesh, asked.pose, asked.water, asked.reference_B, subject.mesh.center_B);
  if (!found) return;
  law(std::isfinite(found->volume) && found->stiffness.allFinite() && found->waterplane_area >= 0.0 &&
          found->wetted_area >= 0.0,
      "hydrostatics are numbers");
  if (truth == nullptr) return;
  check_within("volume", Method::kHierarchical, truth->volume_error(found->volume),
               subject.mesh.max_rounding_bound());
}

void check(FuzzBytes bytes) {
  CaseReader reader(bytes);
  Case asked = reader.read();
  std::optional<Subject> written;
  if (asked.mesh_is_written) {
    const FuzzMesh mesh = read_mesh(bytes);
    if (mesh.imported.mesh.triangles.size() > kMaxTriangles) return;
    written = subject_of(mesh.imported.mesh, mesh.options.open);
    if (!written) return;
  }
  const Subject& subject = written ? *written : subjects()[asked.mesh % subjects().size()];
  if (!is_valid_input(asked)) return;
  reader.aim(subject.source, asked);
  if (!std::isfinite(asked.water.level)) return;

  static const std::vector<std::string> kTargets = simd_targets();
  force_simd_target(kTargets[asked.target % kTargets.size()]);
  std::optional<TrueWrench> known;
  if (is_moderate(asked, subject)) known.emplace(subject.source, asked.pose, asked.water, asked.reference_B);
  const TrueWrench* truth = known ? &*known : nullptr;
  for (const Method method : kAllMethods) check_method(Solver(subject.mesh, method), asked, truth);
  check_method(Solver(subject.mesh, Method::kHierarchical, asked.tolerance), asked, truth);
  if (buoyancy(Solver(subject.mesh, Method::kHierarchical), asked.pose, asked.water, asked.reference_B)
          .status == BuoyancyStatus::kOk) {
    check_hydrostatics(asked, subject, truth);
  }
}

}  // namespace
}  // namespace buoyancy

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  buoyancy::check(buoyancy::FuzzBytes({data, size}));
  return 0;
}

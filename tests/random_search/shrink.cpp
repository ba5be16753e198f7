#include "tests/random_search/shrink.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

namespace buoyancy {
namespace {

// The mesh without unused vertices.
TriangleMesh compacted(const TriangleMesh& mesh) {
  TriangleMesh result;
  std::vector<std::int32_t> place(mesh.vertex_count(), -1);
  for (const Triangle& face : mesh.triangles) {
    Triangle moved{};
    for (std::size_t i = 0; i < 3; ++i) {
      std::int32_t& to = place[static_cast<std::size_t>(face[i])];
      if (to < 0) {
        to = static_cast<std::int32_t>(result.vertex_count());
        result.add_vertex(mesh.vertex(face[i]));
      }
      moved[i] = to;
    }
    result.triangles.push_back(moved);
  }
  return result;
}

// Merges a vertex into its neighbour, which keeps a closed mesh closed.
TriangleMesh collapsed(const TriangleMesh& mesh, std::int32_t from, std::int32_t to) {
  TriangleMesh result = mesh;
  result.triangles.clear();
  for (Triangle face : mesh.triangles) {
    for (std::int32_t& index : face) {
      if (index == from) index = to;
    }
    if (face[0] != face[1] && face[1] != face[2] && face[2] != face[0]) result.triangles.push_back(face);
  }
  return compacted(result);
}

double rounded_to(double value, int bits) {
  if (value == 0.0) return value;
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  return std::ldexp(std::nearbyint(std::ldexp(fraction, bits)), exponent - bits);
}

SearchCase with_short_numbers(SearchCase failing, int bits) {
  for (auto* coordinates : {&failing.mesh.x, &failing.mesh.y, &failing.mesh.z}) {
    for (double& value : *coordinates) value = rounded_to(value, bits);
  }
  return failing;
}

bool collapse_one_edge(SearchCase& failing, const StillFails& still_fails) {
  for (const Triangle& face : failing.mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      TriangleMesh smaller = collapsed(failing.mesh, face[i], face[(i + 1) % 3]);
      if (smaller.triangles.empty() || !still_fails(smaller, failing.requested)) continue;
      failing.mesh = std::move(smaller);
      return true;
    }
  }
  return false;
}

// Tries simpler values of each parameter of the request.
void simplify_request(SearchCase& failing, const StillFails& still_fails) {
  const auto try_change = [&](auto&& change) {
    SearchPose simpler = failing.requested;
    change(simpler);
    if (still_fails(failing.mesh, simpler)) failing.requested = simpler;
  };
  try_change([](SearchPose& requested) { requested.reference_B = Vec3::Zero(); });
  try_change([](SearchPose& requested) { requested.pose.q_WB = Eigen::Quaterniond::Identity(); });
  try_change([](SearchPose& requested) { requested.pose.p_WB = Vec3::Zero(); });
  try_change([](SearchPose& requested) { requested.water.level = 0.0; });
  try_change([](SearchPose& requested) { requested.water.up_W = Vec3::UnitZ(); });
  try_change([](SearchPose& requested) { requested.tolerance = 1e-3; });
  for (const int bits : {30, 16, 8, 4}) {
    try_change([bits](SearchPose& requested) {
      for (double& value : requested.pose.p_WB) value = rounded_to(value, bits);
      for (double& value : requested.reference_B) value = rounded_to(value, bits);
      for (double& value : requested.pose.q_WB.coeffs()) value = rounded_to(value, bits);
      requested.water.level = rounded_to(requested.water.level, bits);
    });
  }
}

std::string number(double value) {
  std::array<char, 40> text;
  std::snprintf(text.data(), text.size(), "%a", value);
  return text.data();
}

std::string numbers(const Vec3& v) {
  return number(v.x()) + ", " + number(v.y()) + ", " + number(v.z());
}

}  // namespace

bool fails(const TriangleMesh& mesh, const SearchPose& requested, const EvaluateAll& evaluate) {
  ImportedMesh imported;
  imported.mesh = mesh;
  const MeshValidation validation = validate_mesh(imported, "case", {.repair = RepairPolicy::kNone});
  if (!validation.mesh) return false;
  const HydrostaticMesh prepared = make_hydrostatic_mesh(*validation.mesh);
  return !check_results(validation.mesh->mesh, prepared, requested, evaluate(prepared, requested))
              .violations.empty();
}

SearchCase shrunk(SearchCase failing, const StillFails& still_fails) {
  while (collapse_one_edge(failing, still_fails)) {
  }
  for (const int bits : {24, 12, 6, 3}) {
    SearchCase shorter = with_short_numbers(failing, bits);
    if (still_fails(shorter.mesh, shorter.requested)) failing = std::move(shorter);
  }
  simplify_request(failing, still_fails);
  while (collapse_one_edge(failing, still_fails)) {
  }
  return failing;
}

std::string as_test(const SearchCase& failing, std::uint64_t seed, std::int64_t number_of_case) {
  const SearchPose& requested = failing.requested;
  const Eigen::Quaterniond& q = requested.pose.q_WB;
  std::string text = "TEST(FoundBySearch, Seed" + std::to_string(seed) + "Case" +
                     std::to_string(number_of_case) + ") {\n  // from: " + failing.kind +
                     "\n  TriangleMesh mesh;\n";
  for (std::size_t i = 0; i < failing.mesh.vertex_count(); ++i)
    text += "  mesh.add_vertex({" + numbers(failing.mesh.vertex(static_cast<std::int32_t>(i))) + "});\n";
  text += "  mesh.triangles = {";
  for (const Triangle& face : failing.mesh.triangles) {
    std::array<char, 48> corners;
    std::snprintf(corners.data(), corners.size(), "{%d, %d, %d}, ", face[0], face[1], face[2]);
    text += corners.data();
  }
  text += "};\n  SearchPose requested;\n";
  text += "  requested.pose.p_WB = {" + numbers(requested.pose.p_WB) + "};\n";
  text += "  requested.pose.q_WB = {" + number(q.w()) + ", " + numbers(q.vec()) + "};\n";
  text += "  requested.water.up_W = {" + numbers(requested.water.up_W) + "};\n";
  text += "  requested.water.level = " + number(requested.water.level) + ";\n";
  text += "  requested.reference_B = {" + numbers(requested.reference_B) + "};\n";
  text += "  requested.tolerance = " + number(requested.tolerance) + ";\n";
  text += "  EXPECT_FALSE(fails(mesh, requested, product_results));\n}\n";
  return text;
}

}  // namespace buoyancy

#include "scene/loads_toml.h"

#include <algorithm>
#include <array>
#include <utility>

#include "hydrodynamics/coefficient_checks.h"

namespace buoyancy {
namespace {

constexpr std::array kScalings{ImmersionScaling::kVolume, ImmersionScaling::kWettedArea,
                               ImmersionScaling::kNone};
constexpr std::array<std::string_view, kScalings.size()> kScalingNames{"volume", "wetted_area", "none"};

constexpr std::array<std::size_t, 2> kMatrixSizes{6, 36};

// Is it a hydrodynamic derivative in SNAME notation, as other programs name their coefficients: xU, xUU,
// xUabsU, xDotU, X_udot?
bool is_sname_key(std::string_view key) {
  constexpr std::string_view kForces = "xyzkmnXYZKMN";
  constexpr std::string_view kVelocities = "uvwpqrUVWPQR";
  if (key.size() < 2 || kForces.find(key.front()) == std::string_view::npos) return false;
  std::string rest;
  for (const char c : key.substr(1)) {
    if (c != '_' && c != '|') rest += c;
  }
  for (const std::string_view word : {"Dot", "dot", "abs", "Abs"}) {
    for (std::size_t at = rest.find(word); at != std::string::npos; at = rest.find(word)) {
      rest.erase(at, word.size());
    }
  }
  return !rest.empty() && rest.size() <= 2 && rest.find_first_not_of(kVelocities) == std::string::npos;
}

void refuse_sname_keys(const toml::table& toml, TomlTable& table, std::string expected) {
  for (const auto& [key, value] : toml) {
    if (!is_sname_key(key.str())) continue;
    table.fail_at(
        key.str(), std::move(expected),
        "the name and the sign convention of another program (gz-sim, VRX, Fossen's SNAME notation)",
        std::string(kNegativeSignHint) + ". docs/importing.md maps their keys to these");
    return;
  }
}

// Six numbers are a diagonal, 36 a matrix row by row. Returns false if the key is absent or wrong.
bool read_matrix(TomlTable& table, std::string_view key, std::string_view unit, Mat6& matrix) {
  const std::vector<double> numbers = table.numbers(key, kMatrixSizes, unit);
  if (numbers.empty()) return false;
  matrix.setZero();
  for (Eigen::Index row = 0; row < 6; ++row) {
    if (numbers.size() == 6) matrix(row, row) = numbers[static_cast<std::size_t>(row)];
    for (Eigen::Index column = 0; column < 6 && numbers.size() == 36; ++column) {
      matrix(row, column) = numbers[static_cast<std::size_t>(6 * row + column)];
    }
  }
  return true;
}

void fail_with(TomlTable& table, std::string_view key, CoefficientFault fault) {
  table.fail_at(key, std::move(fault.expected), std::move(fault.cause), std::move(fault.hint));
}

void read_drag_matrix(TomlTable& table, std::string_view key, std::string_view unit, Mat6& matrix) {
  if (!read_matrix(table, key, unit, matrix)) return;
  if (std::optional<CoefficientFault> fault = find_drag_fault(matrix))
    fail_with(table, key, *std::move(fault));
}

void read_center(TomlTable& table, std::optional<Vec3>& center_B) {
  Vec3 center = Vec3::Zero();
  table.read("center", center, "m");
  if (table.has("center")) center_B = center;
}

void read_immersion(TomlTable& table, ImmersionScaling& immersion) {
  if (const auto chosen = table.choice("immersion", kScalingNames)) immersion = kScalings[*chosen];
}

}  // namespace

void parse_drag(TomlTable& body, const std::string& body_name, SceneParseContext& context,
                std::optional<DragDescription>& drag) {
  const toml::table* toml = body.table("drag");
  if (toml == nullptr) return;
  TomlTable table(*toml, body_name + ", [body.drag]", context);
  DragDescription& read = drag.emplace();
  refuse_sname_keys(*toml, table, "linear and quadratic, each 6 numbers (a diagonal) or 36 (row by row)");
  read_drag_matrix(table, "linear", "N/(m/s), N m/(rad/s) and mixed", read.linear);
  read_drag_matrix(table, "quadratic", "N/(m/s)^2, N m/(rad/s)^2 and mixed", read.quadratic);
  read_center(table, read.center_B);
  read_immersion(table, read.immersion);
  table.finish();
  if (!table.has("linear") && !table.has("quadratic")) {
    table.fail("neither 'linear' nor 'quadratic'", "at least one of them", {},
               "Add, for example, quadratic = [18, 22, 37, 1.5, 1.5, 1.5], or remove [body.drag]");
  }
}

void parse_added_mass(TomlTable& body, const std::string& body_name, SceneParseContext& context,
                      std::optional<AddedMassDescription>& added_mass) {
  const toml::table* toml = body.table("added_mass");
  if (toml == nullptr) return;
  TomlTable table(*toml, body_name + ", [body.added_mass]", context);
  AddedMassDescription& read = added_mass.emplace();
  refuse_sname_keys(*toml, table, "matrix, 6 numbers (a diagonal) or 36 (row by row)");
  if (read_matrix(table, "matrix", "kg, kg m, kg m^2", read.matrix)) {
    if (std::optional<CoefficientFault> fault = find_added_mass_fault(read.matrix)) {
      fail_with(table, "matrix", *std::move(fault));
    }
    read.matrix = (0.5 * (read.matrix + read.matrix.transpose())).eval();
  }
  read_center(table, read.center_B);
  read_immersion(table, read.immersion);
  table.finish();
  if (!table.has("matrix")) table.fail_missing("matrix", "6 numbers (a diagonal) or 36 (row by row)");
}

}  // namespace buoyancy

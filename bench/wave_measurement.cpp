#include "wave_measurement.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <utility>

#include "markdown_table.h"

namespace buoyancy::bench {
namespace {

using Rows = std::vector<WaveMeasurement>;

// The methods of the rows, with their tolerances: hierarchical first.
std::vector<std::pair<std::string, double>> methods_of(const Rows& rows) {
  std::vector<std::pair<std::string, double>> methods;
  for (const WaveMeasurement& row : rows) {
    const std::pair method{row.method, row.tolerance};
    if (std::find(methods.begin(), methods.end(), method) == methods.end()) methods.push_back(method);
  }
  return methods;
}

std::string heading_of(const std::pair<std::string, double>& method) {
  return method.second == 0.0 ? method.first : method.first + " at " + format_cell("%g", method.second);
}

std::string microseconds(double ns) {
  const double us = ns / 1000.0;
  return format_cell(us < 10.0 ? "%.2f" : us < 100.0 ? "%.1f" : "%.0f", us);
}

// "31.2 (4.8e-06 of 8.9e-04)": time, error, bound.
std::string cell_of(const WaveMeasurement& row) {
  std::string cell = microseconds(row.median_ns) + " (" + format_cell("%.1e", row.force_error);
  if (std::isfinite(row.force_bound)) cell += " of " + format_cell("%.1e", row.force_bound);
  return cell + (row.capped > 0 ? ", capped)" : ")");
}

// A row of the table for each place at which all methods were measured. `place` names it in columns.
void print_table(std::FILE* file, const Rows& rows, std::vector<std::string> header, std::size_t text_columns,
                 const std::function<std::vector<std::string>(const WaveMeasurement&)>& place) {
  const auto methods = methods_of(rows);
  for (const auto& method : methods) header.push_back(heading_of(method));
  MarkdownTable table(std::move(header));
  for (std::size_t i = 0; i + methods.size() <= rows.size(); i += methods.size()) {
    std::vector<std::string> cells = place(rows[i]);
    for (std::size_t m = 0; m < methods.size(); ++m) cells.push_back(cell_of(rows[i + m]));
    table.add(std::move(cells));
  }
  table.print(file, text_columns);
}

template <typename Predicate>
Rows select(const Rows& rows, const Predicate& predicate) {
  Rows selected;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(selected), predicate);
  return selected;
}

// The size of the largest mesh that was measured with as many numbers of components as any.
std::size_t triangles_of_components_table(const Rows& rows) {
  std::size_t triangles = 0;
  std::size_t most = 0;
  for (const WaveMeasurement& row : rows) {
    std::set<int> components;
    for (const WaveMeasurement& other : rows) {
      if (other.triangles == row.triangles) components.insert(other.components);
    }
    if (components.size() > most || (components.size() == most && row.triangles > triangles)) {
      most = components.size();
      triangles = row.triangles;
    }
  }
  return triangles;
}

}  // namespace

void write_csv(std::FILE* file, const std::vector<WaveMeasurement>& measurements) {
  std::fprintf(file,
               "mesh,triangles,pressure,components,method,tolerance,median_ns,force_error,torque_error,"
               "force_bound,torque_bound,capped\n");
  for (const WaveMeasurement& row : measurements) {
    std::fprintf(file, "%s,%zu,%s,%d,%s,%g,%.6g,%.6g,%.6g,%.6g,%.6g,%d\n", row.mesh.c_str(), row.triangles,
                 row.pressure.c_str(), row.components, row.method.c_str(), row.tolerance, row.median_ns,
                 row.force_error, row.torque_error, row.force_bound, row.torque_bound, row.capped);
  }
}

void print_wave_report(std::FILE* file, const std::vector<WaveMeasurement>& measurements, int components) {
  for (const char* const pressure : {"wheeler", "hydrostatic"}) {
    const Rows rows =
        select(measurements, [pressure](const WaveMeasurement& row) { return row.pressure == pressure; });
    std::fprintf(file, "### Loads in waves, `%s` pressure\n\n", pressure);
    std::fprintf(file,
                 "Median time per query, us, and behind it the largest error of the force (of its bound). %d "
                 "components:\n\n",
                 components);
    print_table(file, select(rows, [&](const WaveMeasurement& row) { return row.components == components; }),
                {"mesh", "triangles"}, 1, [](const WaveMeasurement& row) {
                  return std::vector<std::string>{row.mesh, std::to_string(row.triangles)};
                });
    const std::size_t triangles = triangles_of_components_table(rows);
    std::fprintf(file, "The %s of %zu triangles:\n\n",
                 std::find_if(rows.begin(), rows.end(),
                              [&](const WaveMeasurement& row) { return row.triangles == triangles; })
                     ->mesh.c_str(),
                 triangles);
    print_table(file, select(rows, [&](const WaveMeasurement& row) { return row.triangles == triangles; }),
                {"components"}, 0, [](const WaveMeasurement& row) {
                  return std::vector<std::string>{std::to_string(row.components)};
                });
  }
}

}  // namespace buoyancy::bench

#include "measurement.h"

#include <algorithm>

namespace buoyancy::bench {

void write_csv(std::FILE* file, const std::vector<Measurement>& rows) {
  std::fprintf(file,
               "mesh,triangles,method,tolerance,target,regime,median_ns,force_error,torque_error,bound\n");
  for (const Measurement& row : rows) {
    std::fprintf(file, "%s,%zu,%s,%g,%s,%s,%.6g,%.6g,%.6g,%.6g\n", row.mesh.c_str(), row.triangles,
                 row.method.c_str(), row.tolerance, row.target.c_str(), row.regime.c_str(), row.median_ns,
                 row.errors.force, row.errors.torque, row.errors.bound);
  }
}

const Measurement* find_measurement(const std::vector<Measurement>& rows, const std::string& mesh,
                            std::size_t triangles, const std::string& method, double tolerance,
                            const std::string& target, const std::string& regime) {
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const Measurement& r) {
    return r.mesh == mesh && r.triangles == triangles && r.method == method && r.tolerance == tolerance &&
           (target.empty() || r.target == target) && r.regime == regime;
  });
  return row == rows.end() ? nullptr : &*row;
}

}  // namespace buoyancy::bench

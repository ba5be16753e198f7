#include "measurement.h"

#include <algorithm>

namespace buoyancy::bench {

void write_csv(std::FILE* file, const std::vector<Measurement>& measurements) {
  std::fprintf(file,
               "mesh,triangles,method,tolerance,target,regime,median_ns,force_error,torque_error,bound\n");
  for (const Measurement& row : measurements) {
    std::fprintf(file, "%s,%zu,%s,%g,%s,%s,%.6g,%.6g,%.6g,%.6g\n", row.mesh.c_str(), row.triangles,
                 row.method.c_str(), row.tolerance, row.target.c_str(), row.regime.c_str(), row.median_ns,
                 row.errors.force, row.errors.torque, row.errors.bound);
  }
}

const Measurement* find_measurement(const std::vector<Measurement>& measurements, const std::string& mesh,
                                    std::size_t triangles, const std::string& method, double tolerance,
                                    const std::string& target, const std::string& regime) {
  const auto found = std::find_if(measurements.begin(), measurements.end(), [&](const Measurement& m) {
    return m.mesh == mesh && m.triangles == triangles && m.method == method && m.tolerance == tolerance &&
           (target.empty() || m.target == target) && m.regime == regime;
  });
  return found == measurements.end() ? nullptr : &*found;
}

}  // namespace buoyancy::bench

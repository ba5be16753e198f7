#include "service/replay/loads_csv.h"

#include "service/replay/csv_row.h"

namespace buoyancy::service {
namespace {

std::string make_header() {
  std::string header = "utime,body_id,status,immersion";
  for (const char* part : {"buoyancy", "drag", "added_mass"}) {
    for (const char* component : {"fx", "fy", "fz", "tx", "ty", "tz"}) {
      ((((header += ',') += part) += '_') += component);
    }
  }
  header += ",water_vx,water_vy,water_vz";
  for (const char* matrix : {"added_mass", "damping"}) {
    for (int row = 1; row <= 6; ++row) {
      for (int column = 1; column <= 6; ++column) {
        (((header += ',') += matrix) += '_') += std::to_string(10 * row + column);
      }
    }
  }
  return header + '\n';
}

}  // namespace

const std::string& loads_csv_header() {
  static const std::string kHeader = make_header();
  return kHeader;
}

void format_loads_row(std::int64_t utime, const BodyLoads& loads, std::string& row) {
  begin_row(utime, loads.body_id, loads.status, row);
  append_field(loads.immersion, row);
  append_field(loads.buoyancy_force, row);
  append_field(loads.buoyancy_torque, row);
  append_field(loads.drag_force, row);
  append_field(loads.drag_torque, row);
  append_field(loads.added_mass_force, row);
  append_field(loads.added_mass_torque, row);
  append_field(loads.water_velocity, row);
  append_field(loads.added_mass, row);
  append_field(loads.damping, row);
  row += '\n';
}

}  // namespace buoyancy::service

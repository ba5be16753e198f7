#include "service/replay/wrench_csv.h"

#include "service/replay/csv_row.h"

namespace buoyancy::service {

void format_wrench_row(std::int64_t utime, const BodyWrench& wrench, std::string& row) {
  begin_row(utime, wrench.body_id, wrench.status, row);
  append_field(wrench.force, row);
  append_field(wrench.torque, row);
  append_field(wrench.submerged_volume, row);
  append_field(wrench.center_of_buoyancy, row);
  append_field(wrench.force_error_bound, row);
  append_field(wrench.torque_error_bound, row);
  row += '\n';
}

}  // namespace buoyancy::service

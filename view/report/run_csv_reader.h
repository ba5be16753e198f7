// A run as CSV: see run_file.h.
#pragma once

#include "view/report/run_file.h"

namespace buoyancy {

Expected<void> read_run_csv(const std::filesystem::path& path, const RunFileOptions& options,
                            RunBuilder& builder);

}  // namespace buoyancy

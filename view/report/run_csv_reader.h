// Reads a run from a CSV file; see run_file.h for the format.
#pragma once

#include "view/report/run_file.h"

namespace buoyancy::view {

Expected<void> read_run_csv(const std::filesystem::path& path, const RunFileOptions& options,
                            RunBuilder& builder);

}  // namespace buoyancy::view

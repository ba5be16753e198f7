// Reads a run from an LCM log; see run_file.h.
#pragma once

#include "view/report/run_file.h"

namespace buoyancy::view {

Expected<void> read_run_log(const std::filesystem::path& path, const RunFileOptions& options,
                            RunBuilder& builder);

}  // namespace buoyancy::view

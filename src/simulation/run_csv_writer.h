// Writes a run to a CSV file: one row per body and step; the start is step 0. Numbers have 17 significant
// digits and read back as the same doubles. No value depends on a clock, so the same run gives the same
// bytes.
//
// Columns: utime [us], body_id, px,py,pz [m] (B's origin, in W), qw,qx,qy,qz (q_WB), vx,vy,vz [m/s] (of B's
// origin, in W), wx,wy,wz [rad/s] (W), status, fx,fy,fz [N] (W), tx,ty,tz [N m] (W, about the reference
// point), volume [m^3], bx,by,bz [m] (W axes, from B's origin to the centre of buoyancy), energy [J] (see
// rigid_body.h). State and wrench of a row belong together: the wrench is the response to the request about
// the row's pose (free-running: the newest response at that time).
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>

#include "recording/record_writer.h"
#include "simulation/simulation.h"

namespace buoyancy {

class RunCsvWriter {
 public:
  // Creates the file, or replaces an existing one. every: >= 1, write only steps whose number is a multiple
  // of it. Errors: the file cannot be written.
  static Expected<RunCsvWriter> create(const std::filesystem::path& path, std::int64_t every = 1);

  // See RecordWriter.
  void give_up_after(int signal) { file_.give_up_after(signal); }

  // Writes the current step; rows are buffered for at most half a second of steps. Errors: the file cannot be
  // written, e.g. a full disk, maybe for an earlier row. The file then ends with a complete step.
  Expected<void> write(const Simulation& simulation);
  // Writes the buffered rows, the last of which are lost without this call. Errors: as for write().
  Expected<void> flush();

 private:
  RunCsvWriter(std::int64_t every, RecordWriter file) : every_(every), file_(std::move(file)) {}

  std::int64_t every_;
  RecordWriter file_;
  Clock::time_point flush_at_;
  std::string rows_;  // reused
};

}  // namespace buoyancy

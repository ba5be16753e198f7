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

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "simulation/simulation.h"

namespace buoyancy {

class RunCsvWriter {
 public:
  // Creates the file, or replaces an existing one. every: >= 1, write only steps whose number is a multiple
  // of it. Errors: the file cannot be written.
  static Expected<RunCsvWriter> create(const std::filesystem::path& path, std::int64_t every = 1);

  Expected<void> write(const Simulation& simulation);  // Errors: the file cannot be written, e.g. a full disk
  Expected<void> close();                              // Errors: same; the last rows may then be missing

 private:
  struct FileCloser {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  RunCsvWriter(std::filesystem::path path, std::int64_t every, std::FILE* file)
      : path_(std::move(path)), every_(every), file_(file) {}
  tl::unexpected<Error> write_error() const;

  std::filesystem::path path_;
  std::int64_t every_;
  std::unique_ptr<std::FILE, FileCloser> file_;
  std::string rows_;  // reused
};

}  // namespace buoyancy

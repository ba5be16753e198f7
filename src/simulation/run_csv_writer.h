// The run as a CSV file: one row per body and step, the start being step 0. Numbers have 17 significant
// digits and read back as the same doubles; nothing in the file comes from a clock, so the same run gives the
// same bytes.
//
// Columns: utime (us), body_id, px,py,pz (m, W: B's origin), qw,qx,qy,qz (q_WB), vx,vy,vz (m/s, W: of B's
// origin), wx,wy,wz (rad/s, W), status, fx,fy,fz (N, W), tx,ty,tz (N m, W, about the reference point), volume
// (m^3), bx,by,bz (m, W axes, from B's origin to the centre of buoyancy), energy (J, see rigid_body.h). State
// and wrench of a row belong together: the wrench is the response about the row's pose (free-running: the
// newest one there was).
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "simulation/simulation.h"

namespace buoyancy {

class RunCsv {
 public:
  // every: writes the steps whose number is a multiple of it, >= 1. Replaces an existing file. Errors: the
  // file cannot be written.
  static Expected<RunCsv> create(const std::filesystem::path& path, std::int64_t every = 1);

  Expected<void> write(const Simulation& simulation);  // Errors: the file cannot be written, a full disk
  Expected<void> close();                              // Errors: likewise; the last rows may be missing then

 private:
  struct FileCloser {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  RunCsv(std::filesystem::path path, std::int64_t every, std::FILE* file)
      : path_(std::move(path)), every_(every), file_(file) {}
  tl::unexpected<Error> write_error() const;

  std::filesystem::path path_;
  std::int64_t every_;
  std::unique_ptr<std::FILE, FileCloser> file_;
  std::string rows_;  // reused
};

}  // namespace buoyancy

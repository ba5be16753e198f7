#include "simulation/run_csv_writer.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <system_error>

namespace buoyancy {
namespace {

constexpr std::string_view kHeader =
    "utime,body_id,px,py,pz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz,status,fx,fy,fz,tx,ty,tz,volume,bx,by,bz,energy\n";

void append(std::string& row, std::int64_t value) {
  row += std::to_string(value);
}

void append(std::string& row, double value) {
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 17).ptr;
  row += ',';
  row.append(text.data(), end);
}

template <std::size_t kSize>
void append(std::string& row, const std::array<double, kSize>& values) {
  for (const double value : values) append(row, value);
}

void append_row(std::string& rows, std::int64_t utime, const SimulatedBody& body) {
  const BodyState state = to_body_state(body.body->id, body.rigid, body.state);
  append(rows, utime);
  rows += ',';
  append(rows, std::int64_t{state.body_id});
  append(rows, state.position);
  append(rows, state.quaternion_wxyz);
  append(rows, state.linear_velocity);
  append(rows, state.angular_velocity);
  rows += ',';
  append(rows, static_cast<std::int64_t>(body.wrench.status));
  append(rows, body.wrench.force);
  append(rows, body.wrench.torque);
  append(rows, body.wrench.submerged_volume);
  append(rows, body.wrench.center_of_buoyancy);
  append(rows, body.energy.current);
  rows += '\n';
}

}  // namespace

Expected<RunCsvWriter> RunCsvWriter::create(const std::filesystem::path& path, std::int64_t every) {
  RunCsvWriter csv(path, every, std::fopen(path.c_str(), "w"));
  if (!csv.file_) return csv.write_error();
  if (std::fwrite(kHeader.data(), 1, kHeader.size(), csv.file_.get()) != kHeader.size()) {
    return csv.write_error();
  }
  return csv;
}

Expected<void> RunCsvWriter::write(const Simulation& simulation) {
  if (simulation.step_number() % every_ != 0) return {};
  rows_.clear();
  for (const SimulatedBody& body : simulation.bodies()) append_row(rows_, simulation.utime(), body);
  if (std::fwrite(rows_.data(), 1, rows_.size(), file_.get()) != rows_.size()) return write_error();
  return {};
}

Expected<void> RunCsvWriter::close() {
  if (std::fclose(file_.release()) != 0) return write_error();
  return {};
}

tl::unexpected<Error> RunCsvWriter::write_error() const {
  return make_error({path_.string(), std::generic_category().message(errno), "a file that can be written",
                     "a missing directory, missing permission or a full disk", ""});
}

}  // namespace buoyancy

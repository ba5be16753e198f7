#include "simulation/run_csv_writer.h"

#include <array>
#include <charconv>

namespace buoyancy {
namespace {

constexpr std::chrono::milliseconds kFlushInterval{500};
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
  Expected<RecordWriter> file = RecordWriter::create(path);
  if (!file) return make_error(file.error());
  RunCsvWriter csv(every, std::move(*file));
  Expected<void> written = csv.file_.append(kHeader);
  if (written) written = csv.flush();
  if (!written) return make_error(written.error());
  return csv;
}

Expected<void> RunCsvWriter::write(const Simulation& simulation) {
  if (simulation.step_number() % every_ != 0) return {};
  rows_.clear();
  for (const SimulatedBody& body : simulation.bodies()) append_row(rows_, simulation.utime(), body);
  if (Expected<void> appended = file_.append(rows_); !appended) return appended;
  return Clock::now() < flush_at_ ? Expected<void>{} : flush();
}

Expected<void> RunCsvWriter::flush() {
  flush_at_ = Clock::now() + kFlushInterval;
  return file_.flush();
}

}  // namespace buoyancy

#include "simulation/run_csv_writer.h"

#include "messages/body_csv.h"

namespace buoyancy {
namespace {

constexpr std::chrono::milliseconds kFlushInterval{500};
// The wrench is written without its error bounds and without the body's id, which the state has.
constexpr FieldRange kWrenchFields{"status", "center_of_buoyancy"};

void append_row(std::string& rows, std::int64_t utime, const SimulatedBody& body) {
  rows += std::to_string(utime);
  append_csv(to_body_state(body.body->id, body.rigid, body.state), rows);
  append_csv(body.wrench, rows, kWrenchFields);
  append_csv(body.energy.current, rows);
  rows += '\n';
}

}  // namespace

Expected<RunCsvWriter> RunCsvWriter::create(const std::filesystem::path& path, std::int64_t every) {
  Expected<RecordWriter> file = RecordWriter::create(path);
  if (!file) return make_error(file.error());
  RunCsvWriter csv(every, std::move(*file));
  Expected<void> written =
      csv.file_.append(csv_header<BodyState>() + "," + csv_columns<BodyWrench>(kWrenchFields) + ",energy\n");
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

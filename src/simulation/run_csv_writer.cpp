#include "simulation/run_csv_writer.h"

#include <cerrno>
#include <system_error>

#include "messages/body_csv.h"

namespace buoyancy {
namespace {

// Of the wrench; its error bounds and the id, which is that of the state, are not written.
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
  RunCsvWriter csv(path, every, std::fopen(path.c_str(), "w"));
  if (!csv.file_) return csv.write_error();
  const std::string header =
      csv_header<BodyState>() + "," + csv_columns<BodyWrench>(kWrenchFields) + ",energy\n";
  if (std::fwrite(header.data(), 1, header.size(), csv.file_.get()) != header.size()) {
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

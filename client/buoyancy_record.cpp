// buoyancy-record: writes the messages of a bus to a log in the format of lcm-logger, and counts what is
// missing.
#include <chrono>
#include <csignal>
#include <cstdint>
#include <string>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <poll.h>

#include "cli/channel_options.h"
#include "cli/command_line.h"
#include "cli/termination_signals.h"
#include "messages/wire.h"
#include "recording/event_log.h"
#include "recording/record_writer.h"
#include "recording/sequence_gaps.h"
#include "transport/lcm_connection.h"

namespace buoyancy {
namespace {

using Clock = std::chrono::steady_clock;

// [bytes]. The buffer holds what arrives while the disk is busy: half a minute of a simulator that sends 10
// kB a thousand times a second.
constexpr std::size_t kReceiveBuffer = std::size_t{256} << 20U;
constexpr std::chrono::milliseconds kFlushInterval{500};
constexpr int kMessagesPerPoll = 256;  // signals are checked after so many

struct Arguments {
  std::string output;
  std::string lcm_url;
  std::vector<std::string> channels{std::string(kStatesChannel),       std::string(kWrenchesChannel),
                                    std::string(kHydrostaticsChannel), std::string(kLoadsChannel),
                                    std::string(kStatusChannel),       std::string(kSeaChannel),
                                    std::string(kSeaGridChannel),      std::string(kConditionChannel),
                                    std::string(kWaterPointsChannel),  std::string(kWaterSamplesChannel)};
};

class Recorder {
 public:
  // app: names the program in warnings.
  static Expected<Recorder> open(const CLI::App& app, const Arguments& arguments) {
    Expected<LcmConnection> connection = LcmConnection::open(arguments.lcm_url);
    if (!connection) return tl::unexpected(connection.error());
    connection->reserve_receive_buffer(kReceiveBuffer);
    Expected<RecordWriter> file = RecordWriter::create(arguments.output);
    if (!file) return tl::unexpected(file.error());
    return Recorder(app, std::move(*connection), std::move(*file));
  }

  Expected<void> subscribe(const std::vector<std::string>& channels) {
    for (const std::string& channel : channels) {
      if (Expected<void> subscribed = connection_.subscribe(
              channel, [this](Bytes bytes, std::string_view name) { record(bytes, name); });
          !subscribed) {
        return subscribed;
      }
    }
    return {};
  }

  // Records until a signal arrives.
  Expected<void> run(TerminationSignals& signals) {
    file_.give_up_after(signals.fileno());
    Clock::time_point flush_at = Clock::now() + kFlushInterval;
    while (!signals.pending()) {
      int handled = 0;
      while (handled < kMessagesPerPoll && connection_.handle_one()) ++handled;
      if (!written_) return written_;
      if (Clock::now() >= flush_at) {
        if (Expected<void> flushed = file_.flush(); !flushed) return flushed;
        warn_of_losses();
        flush_at = Clock::now() + kFlushInterval;
      }
      if (handled == kMessagesPerPoll) continue;
      std::array<pollfd, 2> wait{pollfd{connection_.fileno(), POLLIN, 0},
                                 pollfd{signals.fileno(), POLLIN, 0}};
      ::poll(wait.data(), wait.size(), static_cast<int>(kFlushInterval.count()));
    }
    while (connection_.handle_one()) {  // messages that had arrived before the signal
    }
    return written_ ? file_.flush() : written_;
  }

  bool complete() const { return requests_.missing() == 0 && responses_.missing() == 0; }

  std::string summary() const {
    std::string text = std::to_string(events_) + " events, " + std::to_string(bytes_) + " bytes; " +
                       std::to_string(requests_.missing()) + " requests and " +
                       std::to_string(responses_.missing()) + " responses missing; the kernel dropped " +
                       std::to_string(connection_.drop_counts().packets) + " packets\n";
    for (const auto& [gaps, what] :
         {std::pair(&requests_, "requests"), std::pair(&responses_, "responses")}) {
      for (const std::string& line : gap_lines(*gaps, what)) text += line + "\n";
    }
    return text;
  }

 private:
  Recorder(const CLI::App& app, LcmConnection connection, RecordWriter file)
      : app_(app), connection_(std::move(connection)), file_(std::move(file)) {}

  void record(Bytes bytes, std::string_view channel) {
    if (!written_) return;
    encode_event(events_, connection_.received_utime(), channel, bytes, event_);
    written_ = file_.append(event_);
    if (!written_) return;
    ++events_;
    bytes_ += static_cast<std::int64_t>(event_.size());
    if (const auto id = peek_request_id(bytes)) {
      requests_.add(id->session_id, id->seq);
    } else if (!decode(bytes, response_)) {
      responses_.add(response_.id.session_id, response_.id.seq);
    }
  }

  void warn_of_losses() {
    const std::int64_t dropped = connection_.drop_counts().packets;
    if (dropped == warned_of_) return;
    print_warning(app_,
                  {"log", std::to_string(dropped) + " packets were dropped by the kernel",
                   "a receive buffer that holds what arrives while the disk is busy",
                   "its receive buffer was full: net.core.rmem_max limits it",
                   "Run 'sysctl -w net.core.rmem_max=" + std::to_string(kReceiveBuffer) + "' and restart"});
    warned_of_ = dropped;
  }

  const CLI::App& app_;
  LcmConnection connection_;
  RecordWriter file_;
  Expected<void> written_;
  std::int64_t events_ = 0;
  std::int64_t bytes_ = 0;
  std::int64_t warned_of_ = 0;
  SequenceGaps requests_, responses_;
  WrenchResponse response_;
  std::vector<std::uint8_t> event_;
};

int record(const CLI::App& app, const Arguments& arguments) {
  const auto fail = [&app](const Error& error, ExitCode exit_code) {
    print_error(app, error);
    return exit_code;
  };
  if (const Expected<void> checked = check_channels_distinct(arguments.channels); !checked) {
    return fail(checked.error(), kUsageError);
  }
  if (const Expected<void> checked = check_lcm_url(arguments.lcm_url); !checked) {
    return fail(checked.error(), kUsageError);
  }
  TerminationSignals signals;
  std::signal(SIGPIPE, SIG_IGN);  // a closed pipe becomes a write error with a message
  Expected<Recorder> recorder = Recorder::open(app, arguments);
  if (!recorder) return fail(recorder.error(), kFailure);
  if (const Expected<void> subscribed = recorder->subscribe(arguments.channels); !subscribed) {
    return fail(subscribed.error(), kFailure);
  }
  if (!print_output(app, "ready: recording to " + arguments.output + "\n")) return kFailure;
  const Expected<void> recorded = recorder->run(signals);
  signals.unblock();  // writing the summary may block on its reader
  if (!recorded) print_error(app, recorded.error());
  const bool printed = print_output(app, recorder->summary());
  return printed && recorded && recorder->complete() ? kSuccess : kFailure;
}

int record_main(int argc, char** argv) {
  CLI::App app(
      R"(Record the messages of a buoyancy service and its clients in a log like those of lcm-logger, until
SIGINT or SIGTERM. Requests and responses that did not arrive are counted by their numbers.
)" + exit_status_help({.failure = "on a runtime error, or if requests or responses are missing",
                       .usage_error = "on invalid arguments"}),
      "buoyancy-record");
  Arguments arguments;
  app.set_version_flag("--version", "buoyancy-record " BUOYANCY_VERSION);
  app.add_option("OUTPUT", arguments.output, "Log to write (.lcmlog); overwritten")->required();
  add_lcm_url_option(app, arguments.lcm_url);
  app.add_option("--channel", arguments.channels,
                 "Channel to record; repeatable. By default those of the service")
      ->allow_extra_args(false)
      ->option_text("NAME");
  if (const auto exit_code = parse_command_line(app, argc, argv)) return *exit_code;
  return record(app, arguments);
}

}  // namespace
}  // namespace buoyancy

int main(int argc, char** argv) {
  return buoyancy::record_main(argc, argv);
}

#include "service/replay/replay_join.h"

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include "messages/wire.h"
#include "recording/event_log.h"
#include "recording/record_writer.h"
#include "recording/staged_file.h"
#include "service/replay/content_hash.h"
#include "service/replay/part_manifest.h"
#include "service/replay/range_hash.h"

namespace buoyancy::service {
namespace {

// Formats numbers in ascending order as "2,5-7", as Slurm's --array takes them.
std::string list_of(const std::vector<int>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!text.empty()) text += ',';
    text += std::to_string(numbers[i]);
    const std::size_t first = i;
    while (i + 1 < numbers.size() && numbers[i + 1] == numbers[i] + 1) ++i;
    if (i > first) text += '-' + std::to_string(numbers[i]);
  }
  return text;
}

std::string parts_text(const std::vector<int>& numbers, int count) {
  return (numbers.size() == 1 ? "part " : "parts ") + list_of(numbers) + " of " + std::to_string(count);
}

std::string value_of(const ReplayFacts& facts, const std::string& name) {
  const auto found = std::ranges::find(facts, name, [](const auto& fact) { return fact.first; });
  return found == facts.end() ? "" : found->second;
}

class Join {
 public:
  Join(int count, FileWindow input, std::filesystem::path output, const JoinProgress& on_progress)
      : count_(count), input_(std::move(input)), output_(std::move(output)), on_progress_(&on_progress) {}

  Expected<JoinResult> run();

 private:
  std::filesystem::path path_of(int number) const { return part_path(output_, {number, count_}); }
  const PartManifest& manifest_of(int number) const {
    return manifests_[static_cast<std::size_t>(number - 1)];
  }
  tl::unexpected<Error> refuse(const std::vector<int>& numbers, const std::string& actual,
                               const std::string& expected, const std::string& cause) const;

  Expected<void> read_manifests();
  Expected<void> check_names() const;
  Expected<void> check_facts() const;
  Expected<void> check_ranges() const;
  Expected<void> check_input();
  // Also checks the parts' hashes.
  Expected<void> write_output(RecordWriter& file);

  // These copy a part's bytes, changed as its place requires, and return the hash of what they have read; "":
  // the events cannot be read.
  Expected<std::string> copy_log(const PartManifest& manifest, FileWindow& part, RecordWriter& file);
  Expected<std::string> copy_csv(FileWindow& part, RecordWriter& file);
  void place_event(const EventLayout& layout, std::int64_t number);

  JoinResult sum() const;
  void report_progress(std::int64_t bytes) { (*on_progress_)(done_ += bytes, total_); }

  int count_;
  FileWindow input_;
  std::filesystem::path output_;
  const JoinProgress* on_progress_;
  std::int64_t done_ = 0;                // [bytes]
  std::int64_t total_ = 0;               // [bytes]
  std::vector<PartManifest> manifests_;  // of part 1, 2, ...
  std::string wrenches_channel_;
  std::string hydrostatics_channel_;
  std::string loads_channel_;
  // Totals of the parts before the one that is copied.
  std::int64_t events_ = 0;
  std::map<std::int64_t, std::int64_t> numbered_requests_;  // by session
  std::vector<std::uint8_t> event_;                         // reused
};

tl::unexpected<Error> Join::refuse(const std::vector<int>& numbers, const std::string& actual,
                                   const std::string& expected, const std::string& cause) const {
  const std::string which = numbers.size() == 1 ? "Run it again (--part " + std::to_string(numbers.front())
                                                : std::string("Run them again (--part I");
  return make_error(
      {output_.string(), parts_text(numbers, count_) + " " + actual, expected, cause,
       which + "/" + std::to_string(count_) + ") with the arguments of the other parts, then join"});
}

Expected<void> Join::read_manifests() {
  std::vector<int> missing;
  std::vector<int> unusable;
  std::optional<Error> error;
  for (int number = 1; number <= count_; ++number) {
    const std::filesystem::path path = path_of(number);
    std::error_code no_such_file;
    if (!std::filesystem::exists(path, no_such_file) ||
        !std::filesystem::exists(manifest_path(path), no_such_file)) {
      missing.push_back(number);
      continue;
    }
    Expected<PartManifest> manifest = read_manifest(path);
    if (manifest) {
      manifests_.push_back(*std::move(manifest));
    } else {
      unusable.push_back(number);
      if (!error) error = manifest.error();
    }
  }
  if (!missing.empty()) {
    const std::string path = path_of(missing.front()).string();
    return refuse(missing, "not complete: there is no " + path + " with its manifest",
                  "all parts beside the output",
                  "a part still runs, was killed, failed or was never started");
  }
  if (error) {
    return refuse(unusable, "without a usable manifest: " + error->subject + " (" + error->actual + ")",
                  error->expected, error->cause);
  }
  return {};
}

Expected<void> Join::check_names() const {
  std::vector<int> wrong;
  for (int number = 1; number <= count_; ++number) {
    if (manifest_of(number).part != Part{number, count_}) wrong.push_back(number);
  }
  if (wrong.empty()) return {};
  const Part& found = manifest_of(wrong.front()).part;
  return refuse(wrong,
                "not what the name says: the manifest of " + path_of(wrong.front()).string() +
                    " is that of part " + std::to_string(found.number) + " of " + std::to_string(found.count),
                "each part under its own name", "files were copied or renamed");
}

Expected<void> Join::check_facts() const {
  std::map<std::string, std::map<std::string, std::size_t>> counts;  // of the values of each name
  for (const PartManifest& manifest : manifests_) {
    for (const auto& [name, value] : manifest.facts) ++counts[name][value];
  }
  for (const auto& [name, values] : counts) {
    const auto common = std::ranges::max_element(values, {}, [](const auto& value) { return value.second; });
    std::vector<int> others;
    for (int number = 1; number <= count_; ++number) {
      if (value_of(manifest_of(number).facts, name) != common->first) others.push_back(number);
    }
    if (others.empty()) continue;
    const bool processors = name == kInstructionSetFact;
    return refuse(others,
                  "computed with another " + name + " than the rest: '" +
                      value_of(manifest_of(others.front()).facts, name) + "', not '" + common->first + "'",
                  "parts of one replay",
                  processors
                      ? "the machines have different processors, whose results differ in the last digits"
                      : "the arguments or the files were not the same");
  }
  return {};
}

Expected<void> Join::check_ranges() const {
  std::int64_t end = 0;
  for (const PartManifest& manifest : manifests_) {
    if (manifest.input_begin != end) {
      return refuse({manifest.part.number},
                    "begins at byte " + std::to_string(manifest.input_begin) +
                        " of INPUT, and the part before ends at byte " + std::to_string(end),
                    "parts that follow one another",
                    "a long message or a corrupt section that holds events of its own, inside which the part "
                    "began; next time it begins where the part before ends");
    }
    end = manifest.input_end;
  }
  if (end == input_.size()) return {};
  return make_error({input_.path().string(), "has " + std::to_string(input_.size()) + " bytes",
                     "the " + std::to_string(end) + " bytes that the parts were computed from",
                     "it was changed, or is another recording", "Run all parts again"});
}

Expected<void> Join::check_input() {
  std::vector<int> others;
  for (const PartManifest& manifest : manifests_) {
    Expected<FileWindow> window = input_.duplicate();
    if (!window) return tl::unexpected(window.error());
    RangeHash hash(*std::move(window), manifest.input_begin);
    if (Expected<void> hashed = hash.extend_to(manifest.input_end); !hashed) return hashed;
    if (hash.hash() != manifest.input_hash) others.push_back(manifest.part.number);
    report_progress(manifest.input_end - manifest.input_begin);
  }
  if (others.empty()) return {};
  return refuse(others, "computed from other bytes than INPUT holds", "parts of " + input_.path().string(),
                "INPUT was changed or replaced between the parts");
}

Expected<void> Join::write_output(RecordWriter& file) {
  std::vector<int> damaged;
  for (const PartManifest& manifest : manifests_) {
    Expected<FileWindow> part = FileWindow::open(path_of(manifest.part.number));
    if (!part) return tl::unexpected(part.error());
    Expected<std::string> hash = "";
    if (part->size() == manifest.output_bytes) {
      const bool is_log = output_.extension() == ".lcmlog";
      hash = is_log ? copy_log(manifest, *part, file) : copy_csv(*part, file);
    }
    if (!hash) return tl::unexpected(hash.error());
    if (*hash != manifest.output_hash) damaged.push_back(manifest.part.number);
    events_ += manifest.output_events;
    for (const auto& [session, count] : manifest.numbered_requests) numbered_requests_[session] += count;
  }
  if (!damaged.empty()) {
    return refuse(damaged, "damaged: size or hash differ from the manifest's",
                  "the file as buoyancy-replay wrote it", "an incomplete copy, or a full or defective disk");
  }
  return file.flush();
}

void Join::place_event(const EventLayout& layout, std::int64_t number) {
  renumber_event(events_ + number, event_);
  const std::span<std::uint8_t> data = std::span(event_).subspan(layout.data);
  if (numbered_requests_.empty() || data.size() < kResponseHeaderSize) return;
  const std::string_view channel(reinterpret_cast<const char*>(event_.data() + layout.channel),
                                 layout.data - layout.channel);
  if (channel != wrenches_channel_ && channel != hydrostatics_channel_ && channel != loads_channel_) return;
  const RequestId id = response_id(data);
  if (const auto before = numbered_requests_.find(id.session_id); before != numbered_requests_.end()) {
    set_response_seq(before->second + id.seq, data);
  }
}

Expected<std::string> Join::copy_log(const PartManifest& manifest, FileWindow& part, RecordWriter& file) {
  constexpr std::int64_t kEventsPerReport = 4096;
  ContentHash hash;
  std::int64_t offset = 0;
  std::int64_t reported = 0;
  for (std::int64_t number = 0; number < manifest.output_events; ++number) {
    const std::optional<EventLayout> layout = event_layout(part.read_at(offset, kEventHeaderSize));
    if (!layout || static_cast<std::int64_t>(layout->end) > part.size() - offset) return "";
    const Bytes event = part.read_at(offset, layout->end);
    if (event.size() < layout->end) return "";
    event_.assign(event.begin(), event.begin() + static_cast<std::ptrdiff_t>(layout->end));
    hash.update(event_);
    place_event(*layout, number);
    if (const Expected<void> written = file.append(event_); !written) return tl::unexpected(written.error());
    offset += static_cast<std::int64_t>(layout->end);
    if (number % kEventsPerReport == 0) report_progress(offset - std::exchange(reported, offset));
  }
  report_progress(offset - reported);
  return offset == part.size() ? hash.text() : "";
}

Expected<std::string> Join::copy_csv(FileWindow& part, RecordWriter& file) {
  ContentHash hash;
  for (std::int64_t offset = 0; offset < part.size();) {
    const Bytes bytes = part.read_at(offset, 1);
    if (bytes.empty()) return "";
    hash.update(bytes);
    if (const Expected<void> written = file.append(bytes); !written) return tl::unexpected(written.error());
    offset += static_cast<std::int64_t>(bytes.size());
    report_progress(static_cast<std::int64_t>(bytes.size()));
  }
  return hash.text();
}

JoinResult Join::sum() const {
  JoinResult result;
  result.unseen_channels = manifests_.front().unseen_channels;
  for (const PartManifest& manifest : manifests_) {
    result.summary.counters += manifest.summary.counters;
    for (const std::string& doubt : manifest.summary.doubts) {
      // Every part finds the mistake of a session anew.
      const std::string subject = doubt.substr(0, doubt.find(" = "));
      const bool is_known = std::ranges::any_of(
          result.summary.doubts, [&subject](const std::string& each) { return each.starts_with(subject); });
      if (!is_known) result.summary.doubts.push_back(doubt);
    }
    result.summary.copied += manifest.summary.copied;
    result.summary.corrupt_sections += manifest.summary.corrupt_sections;
    result.summary.seconds += manifest.summary.seconds;
    result.input_errors.insert(result.input_errors.end(), manifest.input_errors.begin(),
                               manifest.input_errors.end());
    std::erase_if(result.unseen_channels, [&manifest](const std::string& channel) {
      return std::ranges::find(manifest.unseen_channels, channel) == manifest.unseen_channels.end();
    });
  }
  return result;
}

Expected<JoinResult> Join::run() {
  if (const Expected<void> read = read_manifests(); !read) return tl::unexpected(read.error());
  if (const Expected<void> checked = check_names(); !checked) return tl::unexpected(checked.error());
  if (const Expected<void> checked = check_facts(); !checked) return tl::unexpected(checked.error());
  if (const Expected<void> checked = check_ranges(); !checked) return tl::unexpected(checked.error());
  wrenches_channel_ = value_of(manifests_.front().facts, kWrenchesChannelFact);
  hydrostatics_channel_ = value_of(manifests_.front().facts, kHydrostaticsChannelFact);
  loads_channel_ = value_of(manifests_.front().facts, kLoadsChannelFact);
  total_ = input_.size();
  for (const PartManifest& manifest : manifests_) total_ += manifest.output_bytes;
  if (const Expected<void> checked = check_input(); !checked) return tl::unexpected(checked.error());

  Expected<StagedFile> staged = StagedFile::create(output_);
  if (!staged) return tl::unexpected(staged.error());
  Expected<RecordWriter> file = RecordWriter::create(*staged);
  if (!file) return tl::unexpected(file.error());
  if (const Expected<void> written = write_output(*file); !written) return tl::unexpected(written.error());
  if (const Expected<void> committed = staged->commit(); !committed) return tl::unexpected(committed.error());
  return sum();
}

}  // namespace

Expected<JoinResult> join_parts(int count, FileWindow input, const std::filesystem::path& output,
                                const JoinProgress& on_progress) {
  return Join(count, std::move(input), output, on_progress).run();
}

}  // namespace buoyancy::service

#include "service/replay/part_manifest.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <system_error>

#include "base/format.h"
#include "base/json.h"
#include "hydrostatics/wetted_tree_sum.h"
#include "recording/record_writer.h"
#include "recording/staged_file.h"
#include "scene/scene_fingerprint.h"
#include "service/replay/content_hash.h"
#include "service/replay/range_hash.h"
#include "service/replay/replay_summary.h"

namespace buoyancy::service {
namespace {

constexpr const char* kFormat = "buoyancy-replay part, version 1";

Expected<std::string> hash_of_file(const std::filesystem::path& path) {
  Expected<FileWindow> file = FileWindow::open(path);
  if (!file) return tl::unexpected(file.error());
  const std::int64_t size = file->size();
  RangeHash hash(std::move(*file), 0);
  if (const Expected<void> hashed = hash.extend_to(size); !hashed) return tl::unexpected(hashed.error());
  return hash.hash();
}

std::string joined(std::vector<std::string> texts) {
  std::ranges::sort(texts);
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : " ") + text;
  return all;
}

std::string pose_text(const std::vector<PoseChannel>& channels) {
  std::vector<std::string> texts;
  for (const PoseChannel& pose : channels) {
    std::string text = pose.channel + "=" + std::to_string(pose.body_id);
    if (!pose.force_torque_channel.empty()) text += "->" + pose.force_torque_channel;
    texts.push_back(std::move(text));
  }
  return joined(std::move(texts));
}

std::string frame_text(const std::optional<VelocityFrame>& frame) {
  if (!frame) return "";
  return *frame == VelocityFrame::kWorld ? "world" : "body";
}

tl::unexpected<Error> no_manifest(const std::filesystem::path& path, const std::string& actual) {
  return make_error({path.string(), actual, "the manifest of a part, as this version writes it",
                     "the file is damaged, or another version wrote it",
                     "Run the part again with this version"});
}

Json to_json(const PartManifest& manifest) {
  Json facts = Json::object();
  for (const auto& [name, value] : manifest.facts) facts[name] = value;
  Json numbered = Json::object();
  for (const auto& [session, count] : manifest.numbered_requests) numbered[std::to_string(session)] = count;
  return {{"format", kFormat},
          {"part", manifest.part.number},
          {"parts", manifest.part.count},
          {"facts", facts},
          {"input",
           {{"begin", manifest.input_begin}, {"end", manifest.input_end}, {"hash", manifest.input_hash}}},
          {"output",
           {{"bytes", manifest.output_bytes},
            {"hash", manifest.output_hash},
            {"events", manifest.output_events}}},
          {"numbered_requests", numbered},
          {"summary", summary_to_json(manifest.summary)},
          {"input_errors", manifest.input_errors},
          {"unseen_channels", manifest.unseen_channels}};
}

// Throws a std::exception, such as nlohmann::json::exception, if this is no manifest.
PartManifest from_json(const Json& json) {
  PartManifest manifest;
  json.at("part").get_to(manifest.part.number);
  json.at("parts").get_to(manifest.part.count);
  for (const auto& [name, value] : json.at("facts").items()) {
    manifest.facts.emplace_back(name, value.get<std::string>());
  }
  const Json& input = json.at("input");
  input.at("begin").get_to(manifest.input_begin);
  input.at("end").get_to(manifest.input_end);
  input.at("hash").get_to(manifest.input_hash);
  const Json& output = json.at("output");
  output.at("bytes").get_to(manifest.output_bytes);
  output.at("hash").get_to(manifest.output_hash);
  output.at("events").get_to(manifest.output_events);
  for (const auto& [session, count] : json.at("numbered_requests").items()) {
    manifest.numbered_requests.emplace(std::stoll(session), count.get<std::int64_t>());
  }
  if (manifest.input_begin < 0 || manifest.input_end < manifest.input_begin) {
    throw std::out_of_range("input: begin and end are no range");
  }
  manifest.summary = summary_from_json(json.at("summary"));
  json.at("input_errors").get_to(manifest.input_errors);
  json.at("unseen_channels").get_to(manifest.unseen_channels);
  return manifest;
}

}  // namespace

Expected<ReplayFacts> replay_facts(const ReplayOptions& options, const Scene& scene,
                                   const std::vector<PoseChannel>& channels, std::int64_t input_size) {
  ReplayFacts facts{{"version", BUOYANCY_VERSION}, {kInstructionSetFact, simd_target()}};
  if (options.mesh.empty()) {
    const Expected<std::string> hash = hash_of_file(options.scene);
    if (!hash) return tl::unexpected(hash.error());
    facts.emplace_back("scene file", *hash);
  } else {
    facts.emplace_back("--method", options.method);
    facts.emplace_back("--tolerance", format_shortest(options.tolerance));
    facts.emplace_back("--open", options.open == OpenPolicy::kRefuse ? "refuse" : "dry_boundary");
  }
  // The fingerprint also covers files that the scene file and mesh files refer to.
  facts.emplace_back("scene, meshes and waves", std::to_string(scene_fingerprint(scene)));
  facts.emplace_back("formats",
                     options.input.extension().string() + " to " + options.output.extension().string());
  facts.emplace_back("--format, --time-unit and --body",
                     options.format + " " + options.time_unit + " " + options.body);
  facts.emplace_back("size of INPUT", std::to_string(input_size));
  facts.emplace_back("--states-channel", options.states_channel);
  facts.emplace_back(kWrenchesChannelFact, options.wrenches_channel);
  facts.emplace_back(kHydrostaticsChannelFact, options.hydrostatics_channel);
  facts.emplace_back(kLoadsChannelFact, options.loads_channel);
  facts.emplace_back("--condition-channel", options.condition_channel);
  facts.emplace_back("--water-points-channel", options.water_points_channel);
  facts.emplace_back("--water-samples-channel", options.water_samples_channel);
  facts.emplace_back("--pose and --force-torque", pose_text(channels));
  facts.emplace_back("--velocity-frame", frame_text(options.poses.velocity_frame));
  facts.emplace_back("--lead-time", format_shortest(options.poses.lead_time));
  facts.emplace_back("--copy", joined(options.copied));
  return facts;
}

std::filesystem::path manifest_path(const std::filesystem::path& part) {
  std::filesystem::path path = part;
  path += ".json";
  return path;
}

void remove_manifest(const std::filesystem::path& part) {
  std::error_code no_such_file;
  std::filesystem::remove(manifest_path(part), no_such_file);
}

Expected<void> write_manifest(const std::filesystem::path& part, const PartManifest& manifest) {
  // Names of channels and files need not be UTF-8.
  const std::string text = json_lines(to_json(manifest));
  Expected<StagedFile> staged = StagedFile::create(manifest_path(part));
  if (!staged) return tl::unexpected(staged.error());
  Expected<RecordWriter> file = RecordWriter::create(*staged);
  if (!file) return tl::unexpected(file.error());
  const Bytes bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  if (Expected<void> written = file->append(bytes); !written) return written;
  if (Expected<void> flushed = file->flush(); !flushed) return flushed;
  return staged->commit();
}

Expected<PartManifest> read_manifest(const std::filesystem::path& part) {
  const std::filesystem::path path = manifest_path(part);
  std::ifstream file(path, std::ios::binary);
  if (!file) return no_manifest(path, "is missing or not readable");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  try {
    const Json json = Json::parse(text);
    if (json.at("format") != kFormat) return no_manifest(path, "has another format");
    return from_json(json);
  } catch (const std::exception& error) {
    return no_manifest(path, error.what());
  }
}

}  // namespace buoyancy::service

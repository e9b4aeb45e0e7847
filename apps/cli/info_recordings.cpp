// SPDX-License-Identifier: Apache-2.0
// saccade info of frames, bags, sessions, campaigns, hands and results.
#include <set>

#include "info_files.hpp"
#include "json_output.hpp"
#include "saccade/io/bags/bags.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/frames/camera_io.hpp"
#include "saccade/io/frames/rgbd_folder.hpp"
#include "saccade/io/frames/trajectory_io.hpp"
#include "saccade/io/sessions/annotation_session.hpp"
#include "saccade/trial/campaign.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// Whether a document of `scene sequence` beside the frames says that they are not all there.
bool is_cut_sequence(const fs::path& folder) {
  const auto document = read_json(folder / "sequence.json");
  return document && document->is_object() && document->value("complete", json{}) == json(false);
}

}  // namespace

Result<Description> describe_frames(const fs::path& folder) {
  auto opened = open_rgbd_folder(folder);
  std::string lacks;
  if (!opened && opened.error().code == Errc::not_found) {  // frames all the same, if given intrinsics open them
    RgbdFolderConfig any_camera;
    any_camera.intrinsics.emplace();
    any_camera.intrinsics->fx = any_camera.intrinsics->fy = 1.0;
    if (auto without = open_rgbd_folder(folder, any_camera)) {
      lacks = opened.error().message;
      opened = std::move(without);
    }
  }
  SACCADE_TRY(const auto source, std::move(opened));
  const RgbdFolderInfo& info = source->info();
  const PinholeCamera& camera = source->camera();
  const std::size_t frames = source->size().value_or(0);
  Description described;
  described.line("frames", std::to_string(frames) + ", layout " + std::string{kRgbdLayoutWords.of(info.layout)});
  const std::string rays = ", f = " + fixed(camera.fx, 1) + " px (" + info.intrinsics_from + ")";
  described.line("camera", std::to_string(camera.width) + " × " + std::to_string(camera.height) + " pixels" +
                               (lacks.empty() ? rays : "; " + lacks));
  std::size_t posed = 0;
  for (std::size_t i = 0; info.has_poses && i < frames; ++i) posed += source->pose_at(i) ? 1 : 0;
  const std::string some = posed == frames ? "yes" : "of " + std::to_string(posed) + " of the frames";
  described.line("poses", info.has_poses ? some : "none; fuse finds them by --tracking icp");
  described.line("depth", fixed(info.encoding.units_per_m, 1) + " samples per metre (" +
                              std::string{to_string(info.units_from)} + ")");
  described.line("colour", info.has_color ? "yes" : "none");
  const bool is_cut = is_cut_sequence(folder);
  if (is_cut) described.line("incomplete", "scene sequence was interrupted; run the same command again for all frames");
  for (const std::string& note : info.notes) described.line("note", note);
  described.result = {{"kind", "frames"},
                      {"frames",
                       {{"count", frames},
                        {"layout", kRgbdLayoutWords.of(info.layout)},
                        {"camera", lacks.empty() ? camera_to_json(camera) : json{}},
                        {"intrinsics_from", lacks.empty() ? json{info.intrinsics_from} : json{}},
                        {"poses", info.has_poses},
                        {"frames_with_pose", posed},
                        {"depth_units_per_m", info.encoding.units_per_m},
                        {"depth_units_from", to_string(info.units_from)},
                        {"notes", info.notes},
                        {"complete", !is_cut},
                        {"color", info.has_color}}}};
  return described;
}

Result<Description> describe_bag(const fs::path& path) {
  SACCADE_TRY(const auto bag, Bag::open(path));
  Description described;
  described.line("bag", path.string());
  json topics = json::array();
  for (const BagTopic& topic : bag->topics()) {
    described.line("topic", topic.name + ", " + topic.type + ", " + std::to_string(topic.messages) + " messages");
    topics.push_back({{"name", topic.name}, {"type", topic.type}, {"messages", topic.messages}});
  }
  if (!bag->damage().empty()) described.line("damage", bag->damage());
  described.result = {
      {"kind", "bag"},
      {"bag", {{"topics", std::move(topics)}, {"damage", bag->damage().empty() ? json{} : json(bag->damage())}}}};
  return described;
}

Result<Description> describe_session(const fs::path& path) {
  SACCADE_TRY(const SavedSession session, read_journal(path));
  Description described;
  described.line("session", path.string());
  described.line("cloud", session.subject.cloud_name + ", " + std::to_string(session.subject.points) + " points");
  described.line("actions", std::to_string(session.actions.size()));
  if (session.torn_bytes > 0) {
    described.line("torn",
                   std::to_string(session.torn_bytes) + " bytes at the end, of an action that was not finished");
  }
  described.result = {{"kind", "session"},
                      {"session",
                       {{"cloud", session.subject.cloud_name},
                        {"points", session.subject.points},
                        {"actions", session.actions.size()},
                        {"torn_bytes", session.torn_bytes}}}};
  return described;
}

Result<Description> describe_campaign(const fs::path& path) {
  SACCADE_TRY(const Campaign campaign, Campaign::open(path));
  SACCADE_TRY(const std::vector<CampaignEntry> runs, campaign.runs());
  std::set<std::string> scenes;
  std::set<std::string> strategies;
  std::set<std::uint64_t> seeds;
  for (const CampaignEntry& entry : runs) {
    scenes.insert(entry.key.scene);
    strategies.insert(entry.key.strategy);
    seeds.insert(entry.key.seed);
  }
  Description described;
  described.line("campaign", path.string());
  described.line("runs", std::to_string(runs.size()));
  described.line("scenes", joined(scenes));
  described.line("strategies", joined(strategies));
  described.line("seeds", std::to_string(seeds.size()));
  described.result = {
      {"kind", "campaign"},
      {"campaign", {{"runs", runs.size()}, {"scenes", scenes}, {"strategies", strategies}, {"seeds", seeds}}}};
  return described;
}

Result<Description> describe_hand(const fs::path& path) {
  SACCADE_TRY(const HandRecording recording, read_hand_trajectory(path));
  Description described;
  described.line("hand", path.string());
  described.line("samples", recording.report.to_string());
  described.result = {{"kind", "hand"}, {"hand", {{"samples", recording.report.samples}}}};
  return described;
}

Result<Description> describe_result(const fs::path& path) {
  SACCADE_TRY(json run, read_json(path));
  const bool is_result = run.is_object() && run.value("schema", json{}) == kJsonSchema && run.contains("result");
  if (!is_result) return Error{Errc::corrupt_data, "is not a result of saccade", path.string()};
  Description described;
  const json& result = run["result"];
  described.line("command", run.value("command", json{}).dump());
  for (const char* name : {"scene", "strategy", "tracking", "frames", "lost", "depth_residual_m", "trajectory_error_m",
                           "stopped_because"}) {
    if (result.is_object() && result.contains(name)) described.line(name, result[name].dump());
  }
  if (result.is_object() && result.value("complete", json{}) == json(false)) {
    described.line("incomplete", "the run failed or was interrupted; run the same command again");
  }
  if (result.is_object() && result.contains("views") && result["views"].is_array()) {
    described.line("views", std::to_string(result["views"].size()));
  }
  described.result = {{"kind", "result"}, {"run", std::move(run)}};
  return described;
}

}  // namespace saccade::cli

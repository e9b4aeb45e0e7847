// SPDX-License-Identifier: Apache-2.0
#include "info_files.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>

#include "saccade/io/bags/bags.hpp"
#include "saccade/io/clouds/cloud_io.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "saccade/scene/scene_yaml.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kKnown{
    "name a map (.sacmap), a cloud (.pcd, .ply, .las, .npy, .xyz, .txt, .csv, .pts, .asc, .bin), a mesh (.ply, .obj, "
    ".stl, .glb), an "
    "array (.npy), a bag (.bag, .mcap), a session (.sacann), a campaign (.sqlite), a result (.json), an arm (.urdf, "
    ".xacro), a "
    "scene or cell (.yaml), a hand's trajectory (.traj, .csv), or the folder of a run or of RGB-D frames"};
/// Results in folders, by their names.
constexpr std::array<std::string_view, 5> kDocuments{"run.json", "update.json", "views.json", "attend.json",
                                                     "filter.json"};

std::string ending_of(const fs::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

void append(Description& all, const Description& more) {
  for (const auto& [key, value] : more.result.items()) {
    if (key != "kind") all.result[key] = value;
  }
  all.lines.insert(all.lines.end(), more.lines.begin(), more.lines.end());
}

Result<Description> describe_map_file(const fs::path& path, const Executor& executor) {
  SACCADE_TRY(const TsdfSnapshot map, load_map(path, executor));
  return describe_map(path, map);
}

/// The folder of a run: its result, map and campaign, as far as they are there.
Result<Description> describe_run(const fs::path& folder, const Executor& executor) {
  Description all;
  all.result["kind"] = "run";
  std::error_code ignored;
  for (const std::string_view name : kDocuments) {
    if (!fs::exists(folder / name, ignored)) continue;
    SACCADE_TRY(const Description document, describe_result(folder / name));
    append(all, document);
    break;
  }
  if (fs::exists(folder / "journal.json", ignored)) all.line("interrupted", "explore --resume goes on with it");
  if (fs::exists(folder / "map.sacmap", ignored)) {
    SACCADE_TRY(const Description map, describe_map_file(folder / "map.sacmap", executor));
    append(all, map);
  }
  if (fs::exists(folder / "campaign.sqlite", ignored)) {
    SACCADE_TRY(const Description campaign, describe_campaign(folder / "campaign.sqlite"));
    append(all, campaign);
  }
  return all;
}

bool is_run(const fs::path& folder) {
  std::error_code ignored;
  const auto has = [&](std::string_view name) { return fs::exists(folder / name, ignored); };
  return std::any_of(kDocuments.begin(), kDocuments.end(), has) || has("map.sacmap") || has("journal.json") ||
         has("campaign.sqlite");
}

/// A folder of files of one kind, of which the first is described.
Result<Description> describe_many(const std::vector<fs::path>& files, const char* kind, Result<Description> first) {
  SACCADE_TRY(const Description one, std::move(first));
  Description all;
  all.result["kind"] = kind;
  all.result["files"] = files.size();
  all.line(kind, std::to_string(files.size()) + ", of which the first:");
  append(all, one);
  return all;
}

Result<Description> describe_folder(const fs::path& folder, const Executor& executor) {
  if (is_run(folder)) return describe_run(folder, executor);
  if (is_bag(folder)) return describe_bag(folder);
  auto frames = describe_frames(folder);
  if (frames) return frames;
  const bool are_frames = frames.error().code != Errc::not_found;
  if (const auto clouds = list_clouds(folder); clouds && !are_frames) {
    return describe_many(*clouds, "clouds", describe_cloud(clouds->front(), executor));
  }
  if (const auto meshes = mesh_files(folder); meshes && !are_frames) {
    return describe_many(*meshes, "meshes", describe_mesh(meshes->front()));
  }
  if (are_frames) return frames;
  return Error{Errc::not_found, std::string{"holds no run and no frames, clouds or meshes; "} + kKnown,
               folder.string()};
}

Result<Description> describe_ply(const fs::path& path, const Executor& executor) {
  SACCADE_TRY(const PlyFile file, read_ply(path));
  const PlyElement* faces = file.find("face");
  return faces != nullptr && faces->table.rows > 0 ? describe_mesh(path) : describe_cloud(path, executor);
}

/// Tells by the header whether a CSV file holds the motion of a hand, not a cloud.
bool is_hand_csv(const fs::path& path) {
  std::ifstream file{path};
  std::string header;
  std::getline(file, header);
  return header.find("time") != std::string::npos;
}

}  // namespace

Result<Description> describe_file(const fs::path& path, const Executor& executor) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (!fs::exists(status)) return Error{Errc::not_found, "there is no such file or folder", path.string()};
  if (fs::is_directory(status)) return describe_folder(path, executor);
  const std::string ending = ending_of(path);
  if (ending == ".sacmap") return describe_map_file(path, executor);
  if (ending == ".ply") return describe_ply(path, executor);
  if (is_mesh_file(path)) return describe_mesh(path);
  if (ending == ".traj" || (ending == ".csv" && is_hand_csv(path))) return describe_hand(path);
  if (ending == ".npy") return is_cloud(path) ? describe_cloud(path, executor) : describe_array(path);
  if (ending == ".sacann") return describe_session(path);
  if (ending == ".sqlite") return describe_campaign(path);
  if (ending == ".json") return describe_result(path);
  if (ending == ".urdf" || ending == ".xacro") return describe_urdf(path);
  if (ending == ".yaml" || ending == ".yml") return describe_scene(path);
  if (is_bag(path)) return describe_bag(path);
  if (is_cloud(path)) return describe_cloud(path, executor);
  return Error{Errc::unsupported, std::string{"is not a kind of file that Saccade reads; "} + kKnown, path.string()};
}

}  // namespace saccade::cli

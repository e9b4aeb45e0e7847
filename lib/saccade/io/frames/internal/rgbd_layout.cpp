// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/frames/internal/rgbd_layout.hpp"

#include <algorithm>
#include <array>
#include <set>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/frames/internal/layout_files.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using Patterns = RgbdLayoutRule::Patterns;

constexpr DepthEncoding kMillimetres{1000.0, false};
constexpr DepthEncoding kTum{5000.0, false};
constexpr DepthEncoding kPrinceton{10000.0, true};
constexpr DepthEncoding kSun3d{1000.0, true};

/// Layouts in the order in which they are tried. docs/reference/formats.md has this table for people.
const std::vector<RgbdLayoutRule>& layout_rules() {
  static const std::vector<RgbdLayoutRule> rules{
      {.layout = RgbdLayout::princeton,
       .title = "Princeton APC",
       .marks = {{"cam.info.txt"}, {"#.depth.*"}},
       .depth = {"#.depth.*"},
       .color = {"#.color.*"},
       .encoding = kPrinceton,
       .complete = complete_princeton},
      {.layout = RgbdLayout::bop,
       .title = "BOP",
       .marks = {{"scene_camera.json"}, {"depth/#.*"}},
       .depth = {"depth/#.*"},
       .color = {"rgb/#.*", "gray/#.*"},
       .complete = complete_bop},
      {.layout = RgbdLayout::bundlefusion,
       .title = "BundleFusion",
       .marks = {{"info.txt", "_info.txt"}, {"#.depth.*"}},
       .depth = {"#.depth.*"},
       .color = {"#.color.*"},
       .pose_each = {"#.pose.txt"},
       .intrinsics = {"info.txt", "_info.txt"},
       .encoding = kMillimetres,
       .complete = complete_bundlefusion},
      {.layout = RgbdLayout::scannet,
       .title = "ScanNet",
       .marks = {{"intrinsic/intrinsic_depth.txt", "intrinsic_depth.txt", "intrinsics_depth.txt"}, {"depth/#.*"}},
       .depth = {"depth/#.*"},
       .color = {"color/#.*", "rgb/#.*"},
       .pose_each = {"pose/#.txt", "poses/#.txt"},
       .intrinsics = {"intrinsic/intrinsic_depth.txt", "intrinsic_depth.txt", "intrinsics_depth.txt"},
       .encoding = kMillimetres,
       .complete = complete_scannet},
      {.layout = RgbdLayout::rtabmap,
       .title = "RTAB-Map",
       .marks = {{"calib/#.yaml", "*_calib/#.yaml"}, {"depth/#.*", "*_depth/#.*"}},
       .depth = {"depth/#.*", "*_depth/#.*"},
       .color = {"rgb/#.*", "*_rgb/#.*"},
       .pose_list = {"*camera_poses*.txt", "poses.txt", "*poses*.txt", "*.g2o", "poses*.graph"},
       .intrinsics = {"calib/#.yaml", "*_calib/#.yaml"},
       .encoding = kMillimetres,
       .complete = complete_rtabmap},
      {.layout = RgbdLayout::sun3d,
       .title = "SUN3D",
       .marks = {{"extrinsics/*.txt"}, {"depth/#.*"}},
       .depth = {"depth/#.*"},
       .encoding = kSun3d,
       .complete = complete_sun3d},
      {.layout = RgbdLayout::replica,
       .title = "Replica",
       .marks = {{"results/depth#.*"}, {"traj.txt", "cam_params.json", "../cam_params.json", "results/frame#.*"}},
       .depth = {"results/depth#.*"},
       .color = {"results/frame#.*"},
       .pose_list = {"traj.txt"},
       .intrinsics = {"cam_params.json", "../cam_params.json"}},
      {.layout = RgbdLayout::tum,
       .title = "TUM RGB-D",
       .marks = {{"depth.txt"}},
       .pose_list = {"groundtruth.txt"},
       .encoding = kTum,
       .complete = complete_tum},
      {.layout = RgbdLayout::icl_nuim,
       .title = "ICL-NUIM and TUM with associations",
       .marks = {{"associations.txt", "association.txt", "associated.txt", "associate.txt"}},
       .pose_list = {"*.gt.freiburg", "groundtruth.txt", "*.freiburg"},
       .encoding = kTum,
       .complete = complete_associations},
      {.layout = RgbdLayout::open3d,
       .title = "Open3D, which Azure Kinect and RealSense are recorded in",
       .marks = {{"depth/#.*", "depths/#.*", "depth_image/#.*", "depth_images/#.*", "aligned_depth/#.*"}},
       .depth = {"depth/#.*", "depths/#.*", "depth_image/#.*", "depth_images/#.*", "aligned_depth/#.*"},
       .color = {"color/#.*", "rgb/#.*", "image/#.*", "images/#.*", "colors/#.*"},
       .pose_each = {"pose/#.txt", "poses/#.txt"},
       .pose_list = {"trajectory.log", "trajectory.txt", "traj.txt", "traj_w_c.txt", "poses.txt", "groundtruth.txt"},
       .encoding = kMillimetres,
       .complete = complete_open3d},
      {.layout = RgbdLayout::seven_scenes,
       .title = "7-Scenes",
       .marks = {{"#.depth.*"}},
       .depth = {"#.depth.*"},
       .color = {"#.color.*"},
       .pose_each = {"#.pose.txt"},
       .encoding = kMillimetres}};
  return rules;
}

/// Patterns of depth images lead to files that can hold such.
FileKind kind_of(const Patterns& patterns) {
  return patterns.front().find("depth") != std::string_view::npos && patterns.front().ends_with(".*") ? FileKind::depth
                                                                                                      : FileKind::any;
}

std::vector<const Patterns*> missing_marks(const fs::path& folder, const RgbdLayoutRule& rule) {
  std::vector<const Patterns*> missing;
  for (const Patterns& mark : rule.marks) {
    if (find_first(folder, mark, kind_of(mark)).empty()) missing.push_back(&mark);
  }
  return missing;
}

const RgbdLayoutRule* recognise(const fs::path& folder) {
  for (const RgbdLayoutRule& rule : layout_rules()) {
    if (missing_marks(folder, rule).empty()) return &rule;
  }
  return nullptr;
}

/// Writes a pattern as people do: "depth/N.*".
std::string shown(std::string_view pattern) {
  std::string text{pattern};
  std::replace(text.begin(), text.end(), '#', 'N');
  if (text.ends_with(".*")) text.replace(text.size() - 1, 1, "png");
  return text;
}

/// Recordings that are one packed file, and how to get at their frames.
struct PackedRecording {
  std::string_view pattern;
  std::string_view advice;
};
constexpr std::array<PackedRecording, 6> kPackedRecordings{
    {{"*.sens", "is packed; unpack it with the reader that ScanNet offers"},
     {"*.db", "is a database, perhaps of RTAB-Map; export it: rtabmap-export --images --poses_camera FILE"},
     {"*.mkv",
      "is perhaps of an Azure Kinect; unpack it with azure_kinect_mkv_reader.py of Open3D, or depth with "
      "ffmpeg and calibration.json with mkvextract"},
     {"*.bag", "is a bag; pass it itself"},
     {"*.mcap", "is a bag; pass it itself"},
     {"*.oni", "is of OpenNI; play it as a camera"}}};

/// Returns the first folders in a folder, by name.
std::vector<fs::path> folders_in(const fs::path& folder) {
  constexpr std::size_t kMostFolders{20};
  std::vector<fs::path> folders;
  std::error_code code;
  for (fs::directory_iterator it{folder, code}; !code && it != fs::directory_iterator{}; it.increment(code)) {
    std::error_code ignored;
    if (it->is_directory(ignored)) folders.push_back(it->path());
  }
  std::sort(folders.begin(), folders.end());
  folders.resize(std::min(folders.size(), kMostFolders));
  return folders;
}

/// Counts what a folder has of a layout.
std::size_t likeness(const fs::path& folder, const RgbdLayoutRule& rule, std::size_t missing) {
  std::size_t found = rule.marks.size() - missing;
  for (const Patterns* patterns : {&rule.color, &rule.pose_each, &rule.pose_list, &rule.intrinsics}) {
    found += find_first(folder, *patterns).empty() ? 0 : 1;
  }
  return found;
}

/// Says which layout a folder is nearest to, and what to do.
Error unknown_folder(const fs::path& folder) {
  const RgbdLayoutRule* nearest = nullptr;
  std::vector<const Patterns*> missing;
  std::size_t most = 0;
  for (const RgbdLayoutRule& rule : layout_rules()) {
    auto lacking = missing_marks(folder, rule);
    const std::size_t found = likeness(folder, rule, lacking.size());
    if (found < most || (found == most && (nearest == nullptr || lacking.size() >= missing.size()))) continue;
    nearest = &rule;
    most = found;
    missing = std::move(lacking);
  }
  std::string message{"no depth frames in any layout that is read"};
  if (nearest != nullptr) {
    message.append("; nearest is that of ").append(nearest->title).append(", which lacks ");
    message += joined(missing, " and ", [](const Patterns* mark) { return joined(*mark, " or ", shown); });
  }
  fs::path inner_folder;
  for (const fs::path& inner : folders_in(folder)) {
    const RgbdLayoutRule* rule = recognise(inner);
    if (rule == nullptr) continue;
    message.append("; ").append(inner.filename().string()).append("/ in it is one of ").append(rule->title);
    inner_folder = inner;
    break;
  }
  for (const PackedRecording& packed : kPackedRecordings) {
    const auto files = find_files(folder, packed.pattern);
    if (files.empty()) continue;
    message.append("; ").append(files.front().path.filename().string()).append(" ").append(packed.advice);
    break;
  }
  message += "; docs/reference/formats.md lists the layouts";
  if (!inner_folder.empty()) message += "; try " + inner_folder.string();
  return {Errc::not_found, std::move(message), folder.string()};
}

/// Names how many files of a kind belong to no depth image.
void note_surplus(std::size_t files, std::size_t used, std::string_view one, std::string_view many,
                  RgbdListing& listing) {
  if (files <= used) return;
  listing.notes.push_back(std::to_string(files - used) + " of " + counted(files, one, many) +
                          " belong to no depth image and are left out");
}

/// Adds frames whose depth is missing, where depth, colour and pose of a frame are named alike: they are reported.
void add_without_depth(const std::vector<KeyedFile>& files, std::set<std::string>& known, RgbdListing& listing) {
  for (const KeyedFile& file : files) {
    if (known.insert(file.key).second) listing.frames.push_back({file.key});
  }
}

void list_frames(const fs::path& folder, const RgbdLayoutRule& rule, RgbdListing& listing) {
  const auto depths = find_first(folder, rule.depth, FileKind::depth);
  const auto colors = find_first(folder, rule.color, FileKind::color);
  const auto poses = find_first(folder, rule.pose_each);
  for (const KeyedFile& depth : depths) listing.frames.push_back({depth.key, {}, depth.path});
  const bool is_flat = !rule.depth.empty() && rule.depth.front().starts_with('#');
  if (is_flat && !depths.empty()) {
    std::set<std::string> known;
    for (const KeyedFile& depth : depths) known.insert(depth.key);
    add_without_depth(colors, known, listing);
    add_without_depth(poses, known, listing);
    std::sort(listing.frames.begin(), listing.frames.end(),
              [](const RgbdFrameFiles& a, const RgbdFrameFiles& b) { return comes_before(a.name, b.name); });
  }
  const FilesByFrame color_of{colors};
  const FilesByFrame pose_of{poses};
  std::size_t with_color = 0;
  std::size_t with_pose = 0;
  for (RgbdFrameFiles& frame : listing.frames) {
    if (const fs::path* color = color_of.find(frame.name)) {
      frame.color = *color;
      ++with_color;
    }
    if (const fs::path* pose = pose_of.find(frame.name)) {
      frame.pose_file = *pose;
      ++with_pose;
    }
  }
  listing.has_poses = with_pose > 0;
  note_surplus(colors.size(), with_color, "colour image", "colour images", listing);
  note_surplus(poses.size(), with_pose, "pose file", "pose files", listing);
  if (!colors.empty() && with_color < listing.frames.size()) {
    listing.notes.push_back(std::to_string(listing.frames.size() - with_color) + " of " +
                            counted(listing.frames.size(), "depth image", "depth images") + " have no colour image");
  }
}

/// Takes intrinsics from the layout's own file; those of any layout are looked for later.
Status read_rule_intrinsics(const fs::path& folder, const RgbdLayoutRule& rule, RgbdListing& listing) {
  if (listing.intrinsics || rule.intrinsics.empty() || listing.intrinsics_are_color) return {};
  const auto files = find_first(folder, rule.intrinsics);
  if (files.empty()) return {};
  SACCADE_TRY(listing.intrinsics, read_intrinsics(files.front().path));
  listing.intrinsics_from = files.front().path.string();
  return {};
}

}  // namespace

Result<RgbdListing> list_rgbd_folder(const fs::path& folder, const RgbdFolderConfig& config) {
  std::error_code ignored;
  if (!fs::exists(folder, ignored)) return Error{Errc::not_found, "no such folder", folder.string()};
  if (!fs::is_directory(folder, ignored)) return Error{Errc::invalid_argument, "is not a folder", folder.string()};
  const RgbdLayoutRule* rule = recognise(folder);
  if (config.layout != RgbdLayout::automatic) {
    const auto& rules = layout_rules();
    rule = &*std::find_if(rules.begin(), rules.end(), [&](const auto& known) { return known.layout == config.layout; });
    const auto missing = missing_marks(folder, *rule);
    if (!missing.empty()) {
      return Error{Errc::not_found,
                   "is not in the layout of " + std::string{rule->title} + ": no depth frames, or not all that tells " +
                       "them; it lacks " +
                       joined(missing, " and ", [](const Patterns* mark) { return joined(*mark, " or ", shown); }),
                   folder.string()};
    }
  }
  if (rule == nullptr) return unknown_folder(folder);
  RgbdListing listing;
  listing.layout = rule->layout;
  if (rule->encoding) listing.scale = DepthUnits{*rule->encoding, UnitsSource::layout};
  list_frames(folder, *rule, listing);
  if (rule->complete != nullptr) SACCADE_CHECK(rule->complete(folder, *rule, config, listing));
  SACCADE_CHECK(read_rule_intrinsics(folder, *rule, listing));
  if (listing.frames.empty()) {
    return Error{Errc::not_found, "lists no depth frames", (folder / rule->marks.front().front()).string()};
  }
  if (config.poses_file) {
    SACCADE_CHECK(attach_pose_file(listing, *config.poses_file, config));
  } else if (const auto lists = find_first(folder, rule->pose_list); !lists.empty() && !listing.has_poses) {
    SACCADE_CHECK(attach_pose_lists(listing, lists, config));
  }
  for (RgbdFrameFiles& frame : listing.frames) {
    if (frame.strip) frame.name += "_" + std::to_string(frame.strip->camera);
  }
  return listing;
}

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/frames/internal/rgbd_layout.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/text_scan.hpp"
#include "saccade/io/frames/trajectory_io.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// Regular files of a folder by name.
Result<std::vector<fs::path>> files_in(const fs::path& folder) {
  std::error_code code;
  std::vector<fs::path> files;
  fs::directory_iterator it{folder, code};
  for (; !code && it != fs::directory_iterator{}; it.increment(code)) {
    std::error_code ignored;
    if (it->is_regular_file(ignored)) files.push_back(it->path());
  }
  if (code) return Error{Errc::io_failure, "cannot list the folder: " + code.message(), folder.string()};
  std::sort(files.begin(), files.end());
  return files;
}

/// "frame-000001" of "frame-000001.depth.png", if the name ends so.
std::optional<std::string> stem_before(const std::string& name, std::string_view ending) {
  if (name.size() <= ending.size() || !name.ends_with(ending)) return std::nullopt;
  return name.substr(0, name.size() - ending.size());
}

/// Frames by the stem of their depth, colour and pose files; a stem that lacks its depth stays, to be reported.
Result<std::vector<RgbdFrameFiles>> frames_by_stem(const fs::path& folder) {
  SACCADE_TRY(const auto files, files_in(folder));
  std::map<std::string, RgbdFrameFiles> frames;
  for (const fs::path& path : files) {
    const std::string name = path.filename().string();
    const auto put = [&](std::string_view ending, auto member) {
      const auto stem = stem_before(name, ending);
      if (!stem) return;
      frames[*stem].name = *stem;
      frames[*stem].*member = path;
    };
    put(".depth.png", &RgbdFrameFiles::depth);
    put(".color.png", &RgbdFrameFiles::color);
    put(".color.jpg", &RgbdFrameFiles::color);
    put(".pose.txt", &RgbdFrameFiles::pose_file);
  }
  std::vector<RgbdFrameFiles> list;
  for (auto& [stem, frame] : frames) list.push_back(std::move(frame));
  return list;
}

Result<RgbdListing> list_seven_scenes(const fs::path& folder) {
  RgbdListing listing{RgbdLayout::seven_scenes, {}, {}, {}, {}, false};
  SACCADE_TRY(listing.frames, frames_by_stem(folder));
  listing.has_poses = std::any_of(listing.frames.begin(), listing.frames.end(),
                                  [](const RgbdFrameFiles& frame) { return frame.pose_file.has_value(); });
  return listing;
}

Result<RgbdListing> list_princeton(const fs::path& folder) {
  constexpr DepthEncoding kPrinceton{10000.0, true};
  const fs::path info_path = folder / "cam.info.txt";
  SACCADE_TRY(const std::string text, read_text_file(info_path));
  const auto info = parse_cam_info(text);
  if (!info) return in_file(info.error(), info_path);
  RgbdListing listing{RgbdLayout::princeton, kPrinceton, info->color, info_path.string(), {}, false};
  SACCADE_TRY(listing.frames, frames_by_stem(folder));
  for (RgbdFrameFiles& frame : listing.frames) {
    frame.pose_file.reset();
    const auto pose = info->T_world_camera.find(frame.name);
    if (pose != info->T_world_camera.end()) frame.T_world_camera = pose->second.T_world_camera;
  }
  listing.has_poses = !info->T_world_camera.empty();
  return listing;
}

struct StampedPath {
  double time_s{0.0};
  fs::path path;
};

/// "time path" lines of TUM's depth.txt and rgb.txt, in order of time.
Result<std::vector<StampedPath>> read_stamped_paths(const fs::path& list) {
  SACCADE_TRY(const std::string text, read_text_file(list));
  std::vector<StampedPath> paths;
  LineScanner lines{text};
  while (const auto line = lines.next()) {
    TokenScanner tokens{*line, " \t"};
    const auto time = tokens.next();
    if (!time || time->front() == '#') continue;
    const auto path = tokens.next();
    const auto time_s = parse_number(*time);
    if (!path || !time_s || !std::isfinite(*time_s)) {
      return Error{Errc::corrupt_data, "'time path' expected",
                   list.string() + ", line " + std::to_string(lines.line())};
    }
    paths.push_back({*time_s, list.parent_path() / *path});
  }
  std::stable_sort(paths.begin(), paths.end(),
                   [](const StampedPath& a, const StampedPath& b) { return a.time_s < b.time_s; });
  return paths;
}

/// Element nearest in time among `sorted`, the earlier one at a tie; nullptr beyond the tolerance.
template <class T, class Time>
const T* nearest_in_time(const std::vector<T>& sorted, double time_s, double tolerance_s, Time time_of) {
  const auto after = std::lower_bound(sorted.begin(), sorted.end(), time_s,
                                      [&](const T& element, double t) { return time_of(element) < t; });
  const T* best = after != sorted.end() ? &*after : nullptr;
  if (after != sorted.begin()) {
    const T* before = &*std::prev(after);
    if (best == nullptr || time_s - time_of(*before) <= time_of(*best) - time_s) best = before;
  }
  return best != nullptr && std::abs(time_of(*best) - time_s) <= tolerance_s ? best : nullptr;
}

Result<RgbdListing> list_tum(const fs::path& folder, double tolerance_s) {
  RgbdListing listing{RgbdLayout::tum, {5000.0, false}, {}, {}, {}, false};
  SACCADE_TRY(const auto depths, read_stamped_paths(folder / "depth.txt"));
  std::vector<StampedPath> colors;
  if (fs::exists(folder / "rgb.txt")) {
    SACCADE_TRY(colors, read_stamped_paths(folder / "rgb.txt"));
  }
  for (const StampedPath& depth : depths) {
    RgbdFrameFiles frame;
    frame.name = depth.path.stem().string();
    frame.time_s = depth.time_s;
    frame.depth = depth.path;
    const StampedPath* color =
        nearest_in_time(colors, depth.time_s, tolerance_s, [](const auto& c) { return c.time_s; });
    if (color != nullptr) frame.color = color->path;
    listing.frames.push_back(std::move(frame));
  }
  return listing;
}

Result<RgbdListing> list_open3d(const fs::path& folder) {
  RgbdListing listing{RgbdLayout::open3d, {}, {}, {}, {}, false};
  SACCADE_TRY(const auto depths, files_in(folder / "depth"));
  std::map<std::string, fs::path> colors;
  for (const char* name : {"color", "rgb", "image"}) {
    if (!colors.empty() || !fs::is_directory(folder / name)) continue;
    SACCADE_TRY(const auto files, files_in(folder / name));
    for (const fs::path& path : files) colors[path.stem().string()] = path;
  }
  for (const fs::path& path : depths) {
    if (path.extension() != ".png") continue;
    RgbdFrameFiles frame;
    frame.name = path.stem().string();
    frame.depth = path;
    if (const auto color = colors.find(frame.name); color != colors.end()) frame.color = color->second;
    listing.frames.push_back(std::move(frame));
  }
  return listing;
}

RgbdLayout recognise(const fs::path& folder) {
  std::error_code ignored;
  if (fs::exists(folder / "cam.info.txt", ignored)) return RgbdLayout::princeton;
  if (fs::exists(folder / "depth.txt", ignored)) return RgbdLayout::tum;
  if (fs::is_directory(folder / "depth", ignored)) return RgbdLayout::open3d;
  return RgbdLayout::seven_scenes;
}

/// Attaches the poses of a list: by time where both sides have times, else by order.
void attach_poses(RgbdListing& listing, std::vector<PoseEntry> poses, double tolerance_s) {
  const auto time_of = [](const PoseEntry& entry) { return *entry.time_s; };
  const bool timed = !poses.empty() && poses.front().time_s.has_value();
  if (timed) {
    std::stable_sort(poses.begin(), poses.end(),
                     [](const PoseEntry& a, const PoseEntry& b) { return *a.time_s < *b.time_s; });
  }
  for (std::size_t i = 0; i < listing.frames.size(); ++i) {
    RgbdFrameFiles& frame = listing.frames[i];
    frame.pose_file.reset();
    frame.T_world_camera.reset();
    const PoseEntry* entry = i < poses.size() ? &poses[i] : nullptr;
    if (timed && frame.time_s) entry = nearest_in_time(poses, *frame.time_s, tolerance_s, time_of);
    if (entry != nullptr) frame.T_world_camera = entry->T_world_camera;
  }
  listing.has_poses = true;
}

Status attach_pose_file(RgbdListing& listing, const fs::path& path, double tolerance_s) {
  SACCADE_TRY(auto poses, read_pose_list(path));
  if (poses.empty()) return Error{Errc::not_found, "holds no pose", path.string()};
  attach_poses(listing, std::move(poses), tolerance_s);
  return {};
}

std::optional<fs::path> folder_pose_file(const fs::path& folder, RgbdLayout layout) {
  std::error_code ignored;
  const fs::path path = folder / (layout == RgbdLayout::tum ? "groundtruth.txt" : "trajectory.log");
  const bool used = layout == RgbdLayout::tum || layout == RgbdLayout::open3d;
  return used && fs::exists(path, ignored) ? std::optional{path} : std::nullopt;
}

Result<RgbdListing> list_layout(const fs::path& folder, RgbdLayout layout, double tolerance_s) {
  switch (layout) {
    case RgbdLayout::princeton: return list_princeton(folder);
    case RgbdLayout::tum: return list_tum(folder, tolerance_s);
    case RgbdLayout::open3d: return list_open3d(folder);
    default: return list_seven_scenes(folder);
  }
}

}  // namespace

Result<RgbdListing> list_rgbd_folder(const fs::path& folder, const RgbdFolderConfig& config) {
  std::error_code ignored;
  if (!fs::exists(folder, ignored)) return Error{Errc::not_found, "no such folder", folder.string()};
  if (!fs::is_directory(folder, ignored)) return Error{Errc::invalid_argument, "is not a folder", folder.string()};
  const RgbdLayout layout = config.layout == RgbdLayout::automatic ? recognise(folder) : config.layout;
  SACCADE_TRY(RgbdListing listing, list_layout(folder, layout, config.max_time_difference_s));
  const bool any_depth = std::any_of(listing.frames.begin(), listing.frames.end(),
                                     [](const RgbdFrameFiles& frame) { return frame.depth.has_value(); });
  if (!any_depth) {
    return Error{Errc::not_found,
                 "no depth frames here; expected NAME.depth.png (7-Scenes), depth.txt (TUM) or depth/*.png (Open3D)",
                 folder.string()};
  }
  const auto pose_file = config.poses_file ? config.poses_file : folder_pose_file(folder, layout);
  if (pose_file) SACCADE_CHECK(attach_pose_file(listing, *pose_file, config.max_time_difference_s));
  return listing;
}

}  // namespace saccade

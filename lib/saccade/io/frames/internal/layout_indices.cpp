// SPDX-License-Identifier: Apache-2.0
// Files that single layouts have of their own: lists of images, calibrations per image, scales.
#include <algorithm>
#include <cmath>
#include <set>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/text_scan.hpp"
#include "saccade/io/frames/internal/calibration.hpp"
#include "saccade/io/frames/internal/layout_files.hpp"
#include "saccade/io/frames/internal/nearest_in_time.hpp"
#include "saccade/io/frames/internal/rgbd_layout.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;

struct StampedPath {
  double time_s{0.0};
  fs::path path;
};

Error bad_list(const fs::path& list, std::size_t line, std::string what) {
  return {Errc::corrupt_data, std::move(what), list.string() + ", line " + std::to_string(line)};
}

/// Reads lines of `pairs` times and paths each, and passes them on.
template <class Use>
Status read_stamped_lines(const fs::path& list, std::size_t pairs, const char* expected, Use use) {
  SACCADE_TRY(const std::string text, read_text_file(list));
  LineScanner lines{text};
  while (const auto line = lines.next()) {
    TokenScanner tokens{*line, " \t"};
    std::vector<StampedPath> stamped;
    std::optional<std::string_view> time = tokens.next();
    if (!time || time->front() == '#') continue;
    for (std::size_t i = 0; i < pairs; ++i, time = tokens.next()) {
      const auto path = tokens.next();
      const auto time_s = time ? parse_number(*time) : std::nullopt;
      if (!path || !time_s || !std::isfinite(*time_s)) return bad_list(list, lines.line(), expected);
      stamped.push_back({*time_s, list.parent_path() / *path});
    }
    SACCADE_CHECK(use(std::move(stamped), lines.line()));
  }
  return {};
}

/// Reads "time path" lines of TUM's depth.txt and rgb.txt, in order of time.
Result<std::vector<StampedPath>> read_stamped_paths(const fs::path& list) {
  std::vector<StampedPath> paths;
  SACCADE_CHECK(read_stamped_lines(list, 1, "'time path' expected", [&](std::vector<StampedPath> line, std::size_t) {
    paths.push_back(std::move(line.front()));
    return Status{};
  }));
  std::stable_sort(paths.begin(), paths.end(),
                   [](const StampedPath& a, const StampedPath& b) { return a.time_s < b.time_s; });
  return paths;
}

/// Tells whether a path is that of a depth image, by the names of its folder and itself.
bool names_depth(const fs::path& path) {
  const std::string name = (path.parent_path().filename() / path.filename()).string();
  return name.find("depth") != std::string::npos || name.find("Depth") != std::string::npos;
}

template <class T>
Status read_into(const fs::path& path, Result<T> (*parse)(std::string_view), std::optional<T>& out) {
  SACCADE_TRY(const std::string text, read_text_file(path));
  SACCADE_TRY(out, in_file(parse(text), path));
  return {};
}

Result<Pose> read_extrinsics(const fs::path& folder, RgbdLayoutRule::Patterns patterns) {
  const auto files = find_first(folder, patterns);
  if (files.empty()) return Pose{Pose::Identity()};
  SACCADE_TRY(const std::vector<Pose> poses, read_poses(files.front().path));
  if (poses.size() != 1) return Error{Errc::corrupt_data, "one 4x4 matrix expected", files.front().path.string()};
  return poses.front();
}

/// Returns the time in a name of SUN3D, "0000001-000000033369": microseconds behind the dash. nullopt without them.
std::optional<double> sun3d_time_s(std::string_view name) {
  const std::size_t dash = name.find('-');
  if (dash == std::string_view::npos) return std::nullopt;
  const auto microseconds = parse_integer<std::int64_t>(name.substr(dash + 1));
  constexpr double kSecondsPerMicrosecond{1e-6};
  return microseconds ? std::optional{kSecondsPerMicrosecond * static_cast<double>(*microseconds)} : std::nullopt;
}

struct Sun3dImage {
  double time_s{0.0};  ///< or its place, where names have no times
  fs::path path;
  std::size_t place{0};
};

/// Lists the colour images in order of time.
std::vector<Sun3dImage> sun3d_images(const std::vector<KeyedFile>& files, bool has_times) {
  std::vector<Sun3dImage> images;
  for (const KeyedFile& file : files) {
    const std::size_t place = images.size();
    images.push_back({has_times ? *sun3d_time_s(file.key) : static_cast<double>(place), file.path, place});
  }
  std::stable_sort(images.begin(), images.end(), [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
  return images;
}

/// Reads three rows of four numbers an image. A matrix that cannot be a pose (NaN, zeros, no rotation) stays an error
/// in its place.
Result<std::vector<Result<Pose>>> read_sun3d_poses(const fs::path& path) {
  SACCADE_TRY(const std::string text, read_text_file(path));
  SACCADE_TRY(const std::vector<NumberLine> rows, in_file(number_lines(text), path));
  constexpr std::size_t kMatrixRows{3};
  constexpr std::size_t kMatrixColumns{4};
  for (const NumberLine& row : rows) {
    if (row.values.size() != kMatrixColumns) {
      return in_file(bad_line(row.line, "four numbers of a 3x4 matrix expected"), path);
    }
  }
  if (rows.size() % kMatrixRows != 0) {
    return Error{Errc::corrupt_data, "the last 3x4 matrix is cut short", path.string()};
  }
  std::vector<Result<Pose>> poses;
  for (std::size_t first = 0; first < rows.size(); first += kMatrixRows) {
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    for (std::size_t row = 0; row < kMatrixRows; ++row) {
      matrix.row(static_cast<Eigen::Index>(row)) =
          Eigen::Map<const Eigen::RowVector4d>(rows[first + row].values.data());
    }
    poses.push_back(in_file(pose_from_matrix(matrix), path));
  }
  return poses;
}

constexpr const char* kDepthOffBody{
    "the depth camera is not where the recording's body is; poses are taken as those of the depth camera"};

}  // namespace

Status complete_princeton(const fs::path& folder, const RgbdLayoutRule& /*rule*/, const RgbdFolderConfig& /*config*/,
                          RgbdListing& listing) {
  std::optional<CamInfo> info;
  SACCADE_CHECK(read_into(folder / "cam.info.txt", parse_cam_info, info));
  listing.intrinsics = info->color;
  listing.intrinsics_from = (folder / "cam.info.txt").string();
  for (RgbdFrameFiles& frame : listing.frames) {
    const auto pose = info->T_world_camera.find(frame.name);
    if (pose != info->T_world_camera.end()) frame.T_world_camera = pose->second.T_world_camera;
  }
  listing.has_poses = !info->T_world_camera.empty();
  return {};
}

Status complete_bop(const fs::path& folder, const RgbdLayoutRule& /*rule*/, const RgbdFolderConfig& /*config*/,
                    RgbdListing& listing) {
  const fs::path path = folder / "scene_camera.json";
  std::optional<std::map<std::int64_t, Result<BopCamera>>> cameras;
  SACCADE_CHECK(read_into(path, parse_bop_cameras, cameras));
  std::set<std::int64_t> used;
  for (RgbdFrameFiles& frame : listing.frames) {
    const auto number = number_in(frame.name);
    const auto found = number ? cameras->find(*number) : cameras->end();
    if (found == cameras->end()) {
      frame.intrinsics = Error{Errc::not_found, "has no entry of this image", path.string()};
      continue;
    }
    used.insert(found->first);
    const Result<BopCamera>& camera = found->second;
    if (!camera) {
      frame.intrinsics = in_file(camera.error(), path);
      continue;
    }
    frame.intrinsics = camera->intrinsics;
    if (camera->T_world_camera) frame.T_world_camera = *camera->T_world_camera;
    listing.has_poses = listing.has_poses || camera->T_world_camera.has_value();
  }
  if (const std::size_t left = cameras->size() - used.size(); left > 0) {
    listing.notes.push_back(std::to_string(left) + " of " + counted(cameras->size(), "entry", "entries") +
                            " in scene_camera.json belong to no depth image and are left out");
  }
  listing.intrinsics_from = path.string();
  return {};
}

Status complete_bundlefusion(const fs::path& folder, const RgbdLayoutRule& rule, const RgbdFolderConfig& /*config*/,
                             RgbdListing& listing) {
  const auto files = find_first(folder, rule.intrinsics);
  if (files.empty()) return {};
  std::optional<SensorInfo> info;
  SACCADE_CHECK(read_into(files.front().path, parse_sensor_info, info));
  listing.intrinsics = info->depth;
  listing.intrinsics_from = files.front().path.string();
  listing.color_intrinsics = info->color;
  listing.T_color_depth = info->T_color_depth;
  if (info->is_depth_off_body) listing.notes.emplace_back(kDepthOffBody);
  return {};
}

Status complete_sun3d(const fs::path& folder, const RgbdLayoutRule& /*rule*/, const RgbdFolderConfig& config,
                      RgbdListing& listing) {
  const RgbdLayoutRule::Patterns colors{"image/#.*"};
  const std::vector<KeyedFile> files = find_first(folder, colors, FileKind::color);
  const auto has_time = [](const auto& named) { return sun3d_time_s(named).has_value(); };
  const bool has_times =
      std::all_of(files.begin(), files.end(), [&](const KeyedFile& file) { return has_time(file.key); }) &&
      std::all_of(listing.frames.begin(), listing.frames.end(),
                  [&](const auto& frame) { return has_time(frame.name); });
  if (!has_times && !files.empty() && files.size() != listing.frames.size()) {
    return Error{Errc::size_mismatch,
                 "has " + counted(listing.frames.size(), "depth image", "depth images") + " and " +
                     counted(files.size(), "colour image", "colour images") +
                     ", and their names have no times to pair them by",
                 folder.string()};
  }
  const std::vector<Sun3dImage> images = sun3d_images(files, has_times);
  const auto extrinsics = find_files(folder, "extrinsics/#.txt");
  std::vector<Result<Pose>> poses;
  if (!config.poses_file && !extrinsics.empty()) {
    SACCADE_TRY(poses, read_sun3d_poses(extrinsics.back().path));  // the latest
    if (extrinsics.size() > 1) {
      listing.notes.push_back("poses are those of " + extrinsics.back().path.filename().string());
    }
  }
  for (std::size_t i = 0; i < listing.frames.size(); ++i) {
    RgbdFrameFiles& frame = listing.frames[i];
    if (has_times) frame.time_s = sun3d_time_s(frame.name);
    const Sun3dImage* image =
        nearest_in_time(images, has_times ? *frame.time_s : static_cast<double>(i),
                        has_times ? config.max_time_difference_s : 0.5, [](const auto& one) { return one.time_s; });
    if (image != nullptr) frame.color = image->path;
    const std::size_t place = image != nullptr ? image->place : images.empty() ? i : poses.size();
    if (place < poses.size()) frame.T_world_camera = poses[place];
  }
  listing.has_poses = !poses.empty();
  return {};
}

Status complete_scannet(const fs::path& folder, const RgbdLayoutRule& /*rule*/, const RgbdFolderConfig& /*config*/,
                        RgbdListing& listing) {
  const RgbdLayoutRule::Patterns patterns{"intrinsic/intrinsic_color.txt", "intrinsic_color.txt",
                                          "intrinsics_color.txt"};
  const auto color = find_first(folder, patterns);
  if (color.empty()) return {};
  SACCADE_TRY(listing.color_intrinsics, read_intrinsics(color.front().path));
  SACCADE_TRY(const Pose T_body_color, read_extrinsics(folder, {"intrinsic/extrinsic_color.txt"}));
  SACCADE_TRY(const Pose T_body_depth, read_extrinsics(folder, {"intrinsic/extrinsic_depth.txt"}));
  listing.T_color_depth = T_body_color.inverse() * T_body_depth;
  if (!T_body_depth.isApprox(Pose::Identity(), 1e-6)) listing.notes.emplace_back(kDepthOffBody);
  return {};
}

Status complete_tum(const fs::path& folder, const RgbdLayoutRule& /*rule*/, const RgbdFolderConfig& config,
                    RgbdListing& listing) {
  SACCADE_TRY(const auto depths, read_stamped_paths(folder / "depth.txt"));
  std::vector<StampedPath> colors;
  if (fs::exists(folder / "rgb.txt")) {
    SACCADE_TRY(colors, read_stamped_paths(folder / "rgb.txt"));
  }
  for (const StampedPath& depth : depths) {
    RgbdFrameFiles frame{depth.path.stem().string(), depth.time_s, depth.path};
    const StampedPath* color = nearest_in_time(colors, depth.time_s, config.max_time_difference_s,
                                               [](const StampedPath& stamped) { return stamped.time_s; });
    if (color != nullptr) frame.color = color->path;
    listing.frames.push_back(std::move(frame));
  }
  return {};
}

Status complete_associations(const fs::path& folder, const RgbdLayoutRule& rule, const RgbdFolderConfig& /*config*/,
                             RgbdListing& listing) {
  const auto files = find_first(folder, rule.marks.front());
  if (files.empty()) return {};
  const fs::path list = files.front().path;
  SACCADE_CHECK(read_stamped_lines(
      list, 2, "'time path time path' expected", [&](std::vector<StampedPath> pair, std::size_t line) -> Status {
        if (names_depth(pair[0].path) == names_depth(pair[1].path)) {
          return bad_list(list, line, "one of the two paths must be in a folder whose name contains 'depth'");
        }
        if (!names_depth(pair[0].path)) std::swap(pair[0], pair[1]);
        listing.frames.push_back({pair[0].path.stem().string(), pair[0].time_s, pair[0].path, pair[1].path});
        return {};
      }));
  std::stable_sort(listing.frames.begin(), listing.frames.end(),
                   [](const RgbdFrameFiles& a, const RgbdFrameFiles& b) { return *a.time_s < *b.time_s; });
  return {};
}

}  // namespace saccade

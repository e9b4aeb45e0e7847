// SPDX-License-Identifier: Apache-2.0
// RTAB-Map: a calibration per image, with the camera's place on the robot; the images of several cameras side by side.
#include <algorithm>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/frames/internal/calibration.hpp"
#include "saccade/io/frames/internal/rgbd_layout.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;

constexpr int kMostCameras{16};

Result<Intrinsics> calibration_of(const fs::path& path, RgbdFrameFiles& frame) {
  SACCADE_TRY(const std::string text, read_text_file(path));
  SACCADE_TRY(frame.T_base_camera, in_file(parse_local_transform(text), path));
  return in_file(parse_opencv_camera(text), path);
}

/// Reads a calibration into its frame. An unusable one stays an error of this frame.
void read_calibration(const fs::path& path, RgbdFrameFiles& frame, RgbdListing& listing) {
  frame.intrinsics = calibration_of(path, frame);
  if (*frame.intrinsics && listing.intrinsics_from.empty()) listing.intrinsics_from = path.string();
}

/// Returns the calibrations N_0.yaml, N_1.yaml … of a frame N whose images are those of several cameras.
std::vector<fs::path> strip_calibrations(const std::vector<KeyedFile>& files, const std::string& name) {
  std::vector<fs::path> strips;
  for (int camera = 0; camera < kMostCameras; ++camera) {
    const std::string key = name + "_" + std::to_string(camera);
    const auto found = std::find_if(files.begin(), files.end(), [&](const KeyedFile& file) { return file.key == key; });
    if (found == files.end()) break;
    strips.push_back(found->path);
  }
  return strips;
}

int cameras_of(const RgbdListing& listing) {
  int cameras = 1;
  for (const RgbdFrameFiles& frame : listing.frames) {
    if (frame.strip) cameras = std::max(cameras, frame.strip->cameras);
  }
  return cameras;
}

}  // namespace

Status complete_rtabmap(const fs::path& folder, const RgbdLayoutRule& rule, const RgbdFolderConfig& /*config*/,
                        RgbdListing& listing) {
  const std::vector<KeyedFile> files = find_first(folder, rule.intrinsics);
  const FilesByFrame calibrations{files};
  const bool has_strips =
      std::any_of(files.begin(), files.end(), [](const KeyedFile& file) { return file.key.ends_with("_0"); });
  std::vector<RgbdFrameFiles> frames;
  for (RgbdFrameFiles& frame : listing.frames) {
    const auto strips = has_strips ? strip_calibrations(files, frame.name) : std::vector<fs::path>{};
    for (std::size_t camera = 0; camera < strips.size(); ++camera) {
      frames.push_back(frame);
      frames.back().strip = CameraStrip{static_cast<int>(camera), static_cast<int>(strips.size())};
      read_calibration(strips[camera], frames.back(), listing);
    }
    if (!strips.empty()) continue;
    if (const fs::path* path = calibrations.find(frame.name)) {
      read_calibration(*path, frame, listing);
    } else {
      frame.intrinsics = Error{Errc::not_found, "its calibration, calib/" + frame.name + ".yaml, is missing", {}};
    }
    frames.push_back(std::move(frame));
  }
  listing.frames = std::move(frames);
  listing.intrinsics_are_color = true;
  return {};
}

Result<bool> are_poses_of_robot(const RgbdListing& listing, const fs::path& path, bool have_ids) {
  const bool is_same = std::all_of(listing.frames.begin(), listing.frames.end(), [](const RgbdFrameFiles& frame) {
    return !frame.T_base_camera || frame.T_base_camera->isApprox(Pose::Identity(), 1e-6);
  });
  if (is_same || path.filename().string().find("camera") != std::string::npos) return false;
  if (have_ids) return true;
  return Error{Errc::unsupported,
               "does not say whether its poses are the robot's or the camera's, which calib/ tells apart; export "
               "them by rtabmap-export --poses_camera, or pass --poses FILE with the camera's",
               path.string()};
}

Status attach_pose_lists(RgbdListing& listing, const std::vector<KeyedFile>& lists, const RgbdFolderConfig& config) {
  const int cameras = cameras_of(listing);
  if (cameras == 1) {
    SACCADE_CHECK(attach_pose_file(listing, lists.front().path, config));
    if (lists.size() > 1) listing.notes.push_back("poses are those of " + lists.front().path.filename().string());
    return {};
  }
  const fs::path& first = lists.front().path;
  if (first.filename().string().find("camera") == std::string::npos) return attach_pose_file(listing, first, config);
  if (lists.size() != static_cast<std::size_t>(cameras)) {
    return Error{Errc::size_mismatch,
                 "is one of " + counted(lists.size(), "file", "files") + " of camera poses, and calib/ has " +
                     std::to_string(cameras) + " cameras; export all by rtabmap-export --poses_camera",
                 first.string()};
  }
  for (int camera = 0; camera < cameras; ++camera) {
    RgbdListing part;
    for (const RgbdFrameFiles& frame : listing.frames) {
      if (frame.strip && frame.strip->camera == camera) part.frames.push_back(frame);
    }
    SACCADE_CHECK(attach_pose_file(part, lists[static_cast<std::size_t>(camera)].path, config));
    auto attached = part.frames.begin();
    for (RgbdFrameFiles& frame : listing.frames) {
      if (frame.strip && frame.strip->camera == camera) frame = *attached++;
    }
    listing.notes.insert(listing.notes.end(), part.notes.begin(), part.notes.end());
  }
  listing.has_poses = true;
  return {};
}

}  // namespace saccade

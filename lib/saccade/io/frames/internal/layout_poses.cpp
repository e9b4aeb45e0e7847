// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/text_scan.hpp"
#include "saccade/io/frames/internal/layout_files.hpp"
#include "saccade/io/frames/internal/nearest_in_time.hpp"
#include "saccade/io/frames/internal/rgbd_layout.hpp"
#include "saccade/io/frames/trajectory_io.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// Index of the pose of each frame; nullopt for a frame without one.
using PoseIndices = std::vector<std::optional<std::size_t>>;

PoseIndices in_order(std::size_t frames, std::size_t poses) {
  PoseIndices indices(frames);
  for (std::size_t i = 0; i < std::min(frames, poses); ++i) indices[i] = i;
  return indices;
}

/// Matches by a whole number of each pose; nullopt where a frame has no number, or none of them matches.
template <class NumberOf>
std::optional<PoseIndices> by_number(const std::vector<RgbdFrameFiles>& frames, const std::vector<PoseEntry>& poses,
                                     NumberOf number_of) {
  std::map<std::int64_t, std::size_t> index_of;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto number = number_of(poses[i], i);
    if (!number) return std::nullopt;
    index_of.emplace(*number, i);
  }
  PoseIndices indices;
  bool any = false;
  for (const RgbdFrameFiles& frame : frames) {
    const auto number = number_in(frame.name);
    if (!number) return std::nullopt;
    const auto found = index_of.find(*number);
    indices.push_back(found == index_of.end() ? std::nullopt : std::optional{found->second});
    any = any || found != index_of.end();
  }
  return any ? std::optional{std::move(indices)} : std::nullopt;
}

/// Matches by time, each frame with the nearest pose. Poses without a time match nothing.
template <class TimeOf>
PoseIndices by_time(const std::vector<RgbdFrameFiles>& frames, const std::vector<PoseEntry>& poses, double tolerance_s,
                    TimeOf time_of_frame) {
  std::vector<std::pair<double, std::size_t>> times;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (poses[i].time_s) times.emplace_back(*poses[i].time_s, i);
  }
  std::stable_sort(times.begin(), times.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  PoseIndices indices;
  for (const RgbdFrameFiles& frame : frames) {
    const auto time_s = time_of_frame(frame);
    const auto* nearest =
        time_s ? nearest_in_time(times, *time_s, tolerance_s, [](const auto& t) { return t.first; }) : nullptr;
    indices.push_back(nearest == nullptr ? std::nullopt : std::optional{nearest->second});
  }
  return indices;
}

/// Returns the time that a name is, such as "1305031102.175304"; a number without a point is none.
std::optional<double> time_in_name(const RgbdFrameFiles& frame) {
  if (frame.name.find('.') == std::string::npos) return std::nullopt;
  const auto time_s = parse_number(frame.name);
  return time_s && std::isfinite(*time_s) ? time_s : std::nullopt;
}

bool has_any(const PoseIndices& indices) {
  return std::any_of(indices.begin(), indices.end(), [](const auto& index) { return index.has_value(); });
}

std::optional<std::int64_t> whole_time(const PoseEntry& entry) {
  constexpr double kMostFrames{1e9};
  if (!entry.time_s || *entry.time_s != std::floor(*entry.time_s) || std::abs(*entry.time_s) > kMostFrames) return {};
  return static_cast<std::int64_t>(*entry.time_s);
}

/// Matches poses that have neither ids nor usable times.
std::optional<PoseIndices> by_count(const std::vector<RgbdFrameFiles>& frames, const std::vector<PoseEntry>& poses) {
  if (frames.size() == poses.size()) return in_order(frames.size(), poses.size());
  std::vector<std::int64_t> numbers;
  for (const RgbdFrameFiles& frame : frames) {
    const auto number = number_in(frame.name);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  const auto [least, most] = std::minmax_element(numbers.begin(), numbers.end());
  const auto count = static_cast<std::int64_t>(poses.size());
  const bool from_0 = *least == 0 || *most + 1 == count;
  const bool from_1 = *least == 1 && *most == count;
  if (!from_0 && !from_1) return std::nullopt;
  const std::int64_t first = from_0 ? 0 : 1;
  return by_number(frames, poses, [first](const PoseEntry&, std::size_t i) {
    return std::optional{static_cast<std::int64_t>(i) + first};
  });
}

/// Matches with the first rule that fits; nullopt where none does.
std::optional<PoseIndices> match(const RgbdListing& listing, const std::vector<PoseEntry>& poses, double tolerance_s) {
  const std::vector<RgbdFrameFiles>& frames = listing.frames;
  const auto own_time = [](const RgbdFrameFiles& frame) { return frame.time_s; };
  const bool has_times = poses.front().time_s.has_value();
  if (has_times && frames.front().time_s) return by_time(frames, poses, tolerance_s, own_time);
  if (has_times) {
    auto indices = by_time(frames, poses, tolerance_s, time_in_name);
    if (has_any(indices)) return indices;
  }
  if (poses.front().id) {
    return by_number(frames, poses, [](const PoseEntry& entry, std::size_t) { return entry.id; });
  }
  if (has_times && frames.size() != poses.size()) {
    return by_number(frames, poses, [](const PoseEntry& entry, std::size_t) { return whole_time(entry); });
  }
  return by_count(frames, poses);
}

/// Says why no image has a pose: with times, that those of poses and images lie apart.
Error none_matches(const RgbdListing& listing, const std::vector<PoseEntry>& poses, const fs::path& path) {
  std::string what = "none of its " + counted(poses.size(), "pose", "poses") + " belongs to one of the " +
                     counted(listing.frames.size(), "depth image", "depth images");
  const auto span = [](const auto& entries) {
    std::optional<std::pair<double, double>> times;
    for (const auto& entry : entries) {
      if (!entry.time_s) continue;
      if (!times) times.emplace(*entry.time_s, *entry.time_s);
      times->first = std::min(times->first, *entry.time_s);
      times->second = std::max(times->second, *entry.time_s);
    }
    return times;
  };
  const auto of_poses = span(poses);
  const auto of_frames = span(listing.frames);
  const auto seconds = [](const std::pair<double, double>& times) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%.3f to %.3f s", times.first, times.second);
    return std::string{text.data()};
  };
  if (of_poses && of_frames) {
    what += ": the poses are of " + seconds(*of_poses) + ", the images of " + seconds(*of_frames);
  }
  return Error{Errc::size_mismatch, std::move(what), path.string()};
}

void note_leftovers(RgbdListing& listing, const PoseIndices& indices, std::size_t poses, const fs::path& path) {
  std::vector<bool> used(poses);
  std::size_t without = 0;
  for (const auto& index : indices) {
    if (index) used[*index] = true;
    without += index ? 0 : 1;
  }
  const bool is_denser = listing.frames.front().time_s.has_value();  // a tracker's poses are more than images
  const auto left = static_cast<std::size_t>(std::count(used.begin(), used.end(), false));
  const std::string file = path.filename().string();
  if (left > 0 && !is_denser) {
    listing.notes.push_back(std::to_string(left) + " of " + counted(poses, "pose", "poses") + " in " + file +
                            " belong to no depth image and are left out");
  }
  if (without > 0) {
    listing.notes.push_back(std::to_string(without) + " of " + counted(indices.size(), "depth image", "depth images") +
                            " have no pose in " + file);
  }
}

}  // namespace

std::string counted(std::size_t count, std::string_view one, std::string_view many) {
  return std::to_string(count).append(" ").append(count == 1 ? one : many);
}

Status attach_pose_file(RgbdListing& listing, const fs::path& path, const RgbdFolderConfig& config) {
  SACCADE_TRY(std::vector<PoseEntry> poses, read_pose_list(path));
  if (poses.empty()) return Error{Errc::not_found, "holds no pose", path.string()};
  if (listing.frames.empty()) return {};
  bool are_robots = false;
  if (!config.poses_file || listing.frames.front().strip) {
    SACCADE_TRY(are_robots, are_poses_of_robot(listing, path, poses.front().id.has_value()));
  }
  const auto indices = match(listing, poses, config.max_time_difference_s);
  if (!indices) {
    return Error{
        Errc::size_mismatch,
        "holds " + counted(poses.size(), "pose", "poses") + " for " +
            counted(listing.frames.size(), "depth image", "depth images") +
            ", and neither times nor numbers say which belongs to which; pass --poses FILE with a pose per image",
        path.string()};
  }
  if (!has_any(*indices)) return none_matches(listing, poses, path);
  for (std::size_t i = 0; i < listing.frames.size(); ++i) {
    RgbdFrameFiles& frame = listing.frames[i];
    frame.pose_file.reset();
    frame.T_world_camera.reset();
    if ((*indices)[i]) frame.T_world_camera = in_file(poses[*(*indices)[i]].T_world_camera, path);
    const bool has_pose = frame.T_world_camera && *frame.T_world_camera;
    if (are_robots && has_pose && frame.T_base_camera) {
      frame.T_world_camera = **frame.T_world_camera * *frame.T_base_camera;
    }
  }
  note_leftovers(listing, *indices, poses.size(), path);
  listing.has_poses = true;
  return {};
}

}  // namespace saccade

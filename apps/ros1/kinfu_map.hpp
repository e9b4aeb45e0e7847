// SPDX-License-Identifier: Apache-2.0
#pragma once
// KinfuMap: the map of the node kinfu. One thread tracks and fuses frames while others answer questions.

#include <atomic>
#include <memory>

#include "kinfu_types.hpp"

namespace saccade::ros1 {

struct KinfuConfig {
  double volume_size{3.0};
  std::uint32_t volume_resolution{512};  ///< voxels along the volume: with its size, the size of a voxel
  double truncation{0.0};                ///< 0: 5.12 voxels
  double min_range{0.1}, max_range{4.4};
  bool minimum_motion{true};
  double memory_limit_mb{0.0};  ///< above it, space outside the volume is forgotten; 0: never
};

enum class Hint { none, start, forced };

struct PlainFrame {
  PlainCamera camera;
  std::vector<float> metres;
  std::vector<std::uint8_t> rgb;  ///< empty, or as large as the camera's image
  Hint hint{Hint::none};
  PlainPose pose;  ///< pose of the hint
};

struct FrameOutcome {
  std::string error;  ///< why the frame is unusable; the map is then untouched
  bool lost{false};
  std::string why;    ///< when lost
  bool fused{false};  ///< false for tracked frames that moved too little
  PlainPose pose;     ///< camera pose at the last frame that was not lost
  double track_ms{0.0}, fuse_ms{0.0};
  double forgotten_mb{0.0};
};

/// Upload: TSDF values at points, and known voxels, x fastest.
struct MapUpload {
  std::vector<std::array<float, 4>> points;  ///< x, y, z, value in [-1, 1]
  PlainBox box;
  std::vector<std::uint8_t> known;
  std::array<std::uint32_t, 3> known_size{};
  bool reset{false};
};

class KinfuMap {
 public:
  /// Throws std::invalid_argument with an error text.
  explicit KinfuMap(const KinfuConfig& config);
  ~KinfuMap();
  KinfuMap(const KinfuMap&) = delete;
  KinfuMap& operator=(const KinfuMap&) = delete;

  // Writers wait for each other, so any thread may call these.
  [[nodiscard]] FrameOutcome process(PlainFrame frame);
  /// Empties the map. The next frame is tracked from `start`, or defines the world. Returns an error text for a bad
  /// pose.
  std::string reset(const std::optional<PlainPose>& start);
  /// Sets voxels unknown, or empty; returns an error text for a bad region.
  std::string clear(const PlainSphere& region, bool to_empty);
  std::string clear(const PlainBox& region, bool to_empty);
  std::string clear(const PlainCylinder& region, bool to_empty);
  std::string upload(const MapUpload& upload);
  void set_minimum_motion(bool on);
  void set_volume_center(const std::array<double, 3>& center);

  /// Answers from the map's state at the call, while it continues to change. Any thread.
  [[nodiscard]] MapAnswer answer(const MapRequest& request, const std::atomic<bool>& cancelled) const;
  /// Returns the camera of the last frame; nullopt before the first.
  [[nodiscard]] std::optional<PlainCamera> camera() const;
  [[nodiscard]] double voxel_size() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Writes a cloud, or a mesh where there are triangles, as PCD or PLY; returns an error text.
std::string write_answer(const std::string& path, const MapAnswer& answer);

}  // namespace saccade::ros1

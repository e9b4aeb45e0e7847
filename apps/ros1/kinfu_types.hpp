// SPDX-License-Identifier: Apache-2.0
#pragma once
// Requests of the node to the map and their answers, in standard types, included by C++17 and C++20 files. Lengths are
// metres; "world" is the frame of the first camera pose.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace saccade::ros1 {

/// Linear map, row by row, and translation. Poses map camera coordinates to the world.
struct PlainPose {
  std::array<double, 9> linear{1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::array<double, 3> translation{};
};

struct PlainCamera {
  std::uint32_t width{0}, height{0};
  double fx{0.0}, fy{0.0}, cx{0.0}, cy{0.0};
};

struct PlainBox {
  std::array<double, 3> min{}, max{};
};
struct PlainSphere {
  std::array<double, 3> center{};
  double radius{0.0};
};
struct PlainCylinder {
  std::array<double, 3> base{}, top{};
  double radius{0.0};
};

/// Points with float fields; organised where height is more than 1.
struct PlainCloud {
  std::vector<std::string> fields;
  std::uint32_t width{0}, height{1};
  std::vector<float> values;  ///< point by point
};

struct Dimension {
  std::string label;
  std::uint32_t size{0}, stride{0};
};

/// The numbers of the author's request types.
enum class Question : std::uint32_t {
  ping = 0,
  tsdf = 1,
  mesh = 2,
  cloud = 3,
  known = 4,
  view = 5,
  view_cloud = 6,
  voxel_count = 7,
  voxelgrid = 8,
  frontier_points = 9,
  border_points = 10,
  surface_points = 11,
  view_score = 12,
};

struct MapRequest {
  Question question{Question::ping};
  std::optional<PlainPose> transformation;
  std::optional<PlainBox> box;
  std::optional<PlainSphere> sphere;
  std::optional<PlainBox> view_box;
  bool skip_unknown_outside_filter{false};
  bool accurate_surface{false};
  std::optional<double> subsample_m;
  std::optional<PlainCamera> camera;
  double min_range{0.0};  ///< start of rays, along z
  std::optional<double> emitter_x;
  std::optional<std::vector<PlainPose>> views;
  double occupied_weight{0.0}, occupied_distance_weight{0.0};
  double unknown_weight{0.0}, unknown_distance_weight{0.0};
};

/// Answer; only the field of the question is filled.
struct MapAnswer {
  std::string error;  ///< empty on success
  bool cancelled{false};
  PlainCloud cloud;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::uint32_t width{0}, height{0};
  std::vector<std::uint8_t> rgb;
  std::vector<float> floats;
  std::vector<std::uint64_t> counts;
  std::vector<Dimension> dimensions;  ///< layout of floats or counts
};

}  // namespace saccade::ros1

// SPDX-License-Identifier: Apache-2.0
#pragma once
// Keyframes: images of earlier frames with their poses, for the grey values of a surface and for finding a lost camera.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/sensor/pinhole_camera.hpp"
#include "saccade/sensor/point_image.hpp"

namespace saccade {

struct KeyframesConfig {
  double spacing_m{0.30};    ///< a frame becomes a keyframe where the nearest one is this far away,
  double spacing_rad{0.45};  ///< or turned by this angle, or by shares of both that add up to it
  std::size_t most{400};     ///< then every second one is forgotten

  [[nodiscard]] Status validate() const;
};

/// A frame shrunk to a few hundred pixels, each image with mean 0 and length 1; empty where it tells nothing.
struct Thumbnail {
  static constexpr int kWidth{32};
  static constexpr int kHeight{24};
  std::vector<float> grey;
  std::vector<float> depth;
};
[[nodiscard]] Thumbnail thumbnail(const Image<float>& grey, const Image<float>& z);
/// Returns the mean of the correlations of what both have, from -1 to 1; -1 where they share nothing.
[[nodiscard]] double alikeness(const Thumbnail& a, const Thumbnail& b);

/// An earlier frame and where it was taken.
struct Keyframe {
  Pose T_world_camera{Pose::Identity()};
  PinholeCamera camera;
  Image<std::uint8_t> grey;       ///< 0: unknown; empty: the frame had no colours
  Image<std::uint16_t> depth_mm;  ///< every second pixel of every second row; 0: none
  Thumbnail small;
};

/// Keyframes in the order in which they were taken. 450 kB each at 640×480 pixels.
class Keyframes {
 public:
  explicit Keyframes(const KeyframesConfig& config = {}) : config_{config} {}

  /// Returns whether no frame near this pose is kept; with colours, none that has them, too.
  [[nodiscard]] bool wants(const Pose& T_world_camera, bool has_color) const;
  /// Keeps a frame.
  /// @param grey as by to_grey; empty: no colours
  /// @param z    metres; 0 where there is no return
  void add(const Image<float>& grey, const Image<float>& z, const PinholeCamera& camera, const Pose& T_world_camera);

  /// Returns the keyframe with colours whose view is nearest to a pose; nullptr where there is none.
  [[nodiscard]] const Keyframe* nearest_with_color(const Pose& T_world_camera) const;
  /// Returns the poses of the keyframes that look most like a frame, best first. O(keyframes).
  [[nodiscard]] std::vector<Pose> most_alike(const Thumbnail& frame, std::size_t count) const;
  [[nodiscard]] std::size_t size() const { return keyframes_.size(); }

 private:
  [[nodiscard]] double distance(const Pose& a, const Pose& b) const;
  KeyframesConfig config_;
  std::vector<Keyframe> keyframes_;
};

/// Returns the grey values that a keyframe saw on a surface, for the pixels of a camera that sees this surface; 0 where
/// it does not see it, or sees something before it. O(pixels). Threads change no bit.
[[nodiscard]] Image<float> grey_of_surface(const Keyframe& keyframe, const PointImage& surface,
                                           const PinholeCamera& camera, const Pose& T_world_camera,
                                           const Executor& executor);

}  // namespace saccade

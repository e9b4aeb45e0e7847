// SPDX-License-Identifier: Apache-2.0
#pragma once
// What is painted on the bodies of a scene: the colour of a surface point and the true segment that it belongs to.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "saccade/scene/scene.hpp"

namespace saccade {

/// invalid_argument for sizes that are not positive, a glyph that there is none of, or a patch without a segment.
[[nodiscard]] Status validate(const Patch& patch);

struct Paint {
  Rgb8 color{};                  ///< before lighting
  std::size_t segment_patch{0};  ///< 1 + index of the patch whose segment it is; 0: the body's
  bool fine{false};              ///< within small print: one ray does not tell a pixel's colour
};

/// A point of the object's surface, both in the object's frame. O(patches).
[[nodiscard]] Paint paint_at(const SceneObject& object, const Eigen::Vector3d& p_object,
                             const Eigen::Vector3d& normal_object);

/// The true segments of a scene, numbered from 1 in the order of its objects and their patches. Segments of one name
/// are one segment.
class SegmentTable {
 public:
  explicit SegmentTable(const Scene& scene);
  /// By label; that of label 0, nothing, is empty.
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  /// Expects an object of the scene, and a Paint of it.
  [[nodiscard]] std::uint16_t label(std::size_t object, const Paint& paint) const {
    return labels_[object][paint.segment_patch];
  }

 private:
  std::vector<std::string> names_;
  std::vector<std::vector<std::uint16_t>> labels_;  ///< of each object: the body, then its patches
};

}  // namespace saccade

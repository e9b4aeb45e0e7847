// SPDX-License-Identifier: Apache-2.0
#pragma once
// Vector kernels of arms: frames of links, their balls in the world, and distances from another link's boxes.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace saccade::arm {

/// Number of balls of one link per block.
constexpr std::size_t kBlock{8};

/// Rigid transform, column by column, including the last row (0, 0, 0, 1).
using Frame = std::array<float, 16>;

/// Terms of the frame behind a joint in the previous frame: fixed + cos q · by_cosine + sin q · by_sine for a rotation,
/// fixed + q · by_cosine for a translation along an axis.
struct JointTerms {
  Frame fixed;
  Frame by_cosine;
  Frame by_sine;
};

/// Computes frames[i + 1] = frames[i] · (frame of joint i). frames[0] is given, as are cosines and sines, or values and
/// 0.
void chain(std::span<const JointTerms> joints, const float* cosines, const float* sines, Frame* frames);

/// Arrays of whole blocks: ball i of block b at index kBlock · b + i.
struct BallArrays {
  const float* x_m;
  const float* y_m;
  const float* z_m;
  const float* radius_m;
};

/// Computes the world coordinates of all blocks; links[b] is the link of block b.
void place_blocks(std::span<const Frame> frames, std::span<const std::uint8_t> links, const BallArrays& balls,
                  float* x_m, float* y_m, float* z_m);

/// Box along the axes of a link's frame.
struct FrameBox {
  std::array<float, 3> center_m;
  std::array<float, 3> half_m;
};

/// Boxes of one link and blocks of another.
struct BoxesAndBlocks {
  std::size_t link;  ///< link of the boxes
  std::size_t first_box;
  std::size_t end_box;
  std::size_t first_block;
  std::size_t end_block;
};

/// Returns the first of `pairs`, from `first` on, in which a ball is not farther than margins_m[pair] from a box; their
/// number when there is none. Balls are in the world frame.
[[nodiscard]] std::size_t first_near(std::span<const BoxesAndBlocks> pairs, std::size_t first, const float* margins_m,
                                     std::span<const Frame> frames, const FrameBox* boxes, const BallArrays& balls);

}  // namespace saccade::arm

// SPDX-License-Identifier: Apache-2.0
#pragma once
// Vector kernels of arms: frames of links, their balls in the world, whether they keep clear of another link's boxes.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace saccade::arm {

/// Balls come in blocks of so many of one link.
constexpr std::size_t kBlock{8};

/// A rigid transform, column by column, the last row (0, 0, 0, 1) too.
using Frame = std::array<float, 16>;

/// The frame behind a joint in the frame before it: fixed + cos q · by_cosine + sin q · by_sine for a turn,
/// fixed + q · by_cosine for a move along an axis.
struct JointTerms {
  Frame fixed;
  Frame by_cosine;
  Frame by_sine;
};

/// frames[i + 1] = frames[i] · that of joint i; frames[0] is given, and cosines and sines, or values and 0.
void chain(std::span<const JointTerms> joints, const float* cosines, const float* sines, Frame* frames);

/// Arrays of whole blocks: ball i of block b at index kBlock · b + i.
struct BallArrays {
  const float* x_m;
  const float* y_m;
  const float* z_m;
  const float* radius_m;
};

/// World coordinates of all blocks; links[b] is the link of block b.
void place_blocks(std::span<const Frame> frames, std::span<const std::uint8_t> links, const BallArrays& balls,
                  float* x_m, float* y_m, float* z_m);

/// In a link's frame, along its axes.
struct FrameBox {
  std::array<float, 3> center_m;
  std::array<float, 3> half_m;
};

/// The boxes of one link and the blocks of another.
struct BoxesAndBlocks {
  std::size_t link;  ///< of the boxes
  std::size_t first_box;
  std::size_t end_box;
  std::size_t first_block;
  std::size_t end_block;
};

/// The first of `pairs` from `first` on of which a ball is not farther than margins_m[pair] from a box; their number
/// when there is none. Balls are in the world frame.
[[nodiscard]] std::size_t first_near(std::span<const BoxesAndBlocks> pairs, std::size_t first, const float* margins_m,
                                     std::span<const Frame> frames, const FrameBox* boxes, const BallArrays& balls);

}  // namespace saccade::arm

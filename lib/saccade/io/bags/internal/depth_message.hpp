// SPDX-License-Identifier: Apache-2.0
#pragma once
// read_depth_message, read_color_message: pixels of image messages, plain and compressed; read_camera_info: intrinsics.

#include <string>

#include "saccade/io/bags/bags.hpp"

namespace saccade::internal::io_bags {

/// Beginning of each image message.
struct ImageHead {
  std::int64_t stamp_ns{0};
  std::string frame_id;
  std::string encoding;  ///< encoding of sensor_msgs/Image, format of a CompressedImage
};

[[nodiscard]] bool is_image(const BagTopic& topic);
/// Tells whether an encoding, or a format, is for depth.
[[nodiscard]] bool is_depth_encoding(std::string_view encoding);

/// Reads the beginning without pixels. Answers corrupt_data; unsupported where it is not a ROS message.
[[nodiscard]] Result<ImageHead> read_image_head(const BagMessage& message);

/// Reads depth in metres. 16UC1 and mono16 by the given encoding; 32FC1: metres, negative free up to there;
/// compressedDepth.
[[nodiscard]] Result<DepthImage> read_depth_message(const BagMessage& message, const DepthEncoding& encoding);
/// Reads rgb8, bgr8, rgba8, bgra8, mono8; JPEG and PNG of CompressedImage.
[[nodiscard]] Result<ColorImage> read_color_message(const BagMessage& message);

/// Reads intrinsics with distortion of the plumb bob model; a rectified image has the intrinsics of P and no
/// distortion. Answers unsupported for other lenses.
[[nodiscard]] Result<Intrinsics> read_camera_info(const BagMessage& message, bool is_rectified);

}  // namespace saccade::internal::io_bags

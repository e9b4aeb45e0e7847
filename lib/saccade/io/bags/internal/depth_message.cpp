// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/bags/internal/depth_message.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "saccade/io/bags/internal/tf_buffer.hpp"
#include "saccade/io/files/little_endian.hpp"

namespace saccade::internal::io_bags {
namespace {

using messages::CompressedImage;

constexpr std::string_view kCompressedType{"sensor_msgs/CompressedImage"};

template <class Message>
Result<Message> read_ros(const BagMessage& message) {
  if (!message.wire) return Error{Errc::unsupported, "the topic is not encoded as messages of ROS are", {}};
  return messages::read_message<Message>(*message.wire, message.bytes);
}

/// Rows of an image, which may be padded. corrupt_data where some are missing.
class ImageRows {
 public:
  static Result<ImageRows> create(const messages::Image& image, std::size_t pixel_bytes) {
    const auto edge = static_cast<std::uint32_t>(kMaxImageEdge);
    if (image.width == 0 || image.height == 0 || image.width > edge || image.height > edge) {
      return Error{Errc::unsupported,
                   "an image of " + std::to_string(image.width) + "x" + std::to_string(image.height) + " pixels",
                   {}};
    }
    const std::size_t row_bytes = image.width * pixel_bytes;
    const std::size_t needed = std::size_t{image.step} * (image.height - 1) + row_bytes;
    if (image.step < row_bytes || image.data.size() < needed) {
      return Error{Errc::corrupt_data,
                   "an image has " + std::to_string(image.data.size()) + " bytes, fewer than its size needs",
                   {}};
    }
    return ImageRows{image};
  }
  [[nodiscard]] int width() const { return static_cast<int>(image_.width); }
  [[nodiscard]] int height() const { return static_cast<int>(image_.height); }
  [[nodiscard]] const std::byte* row(int v) const {
    return image_.data.data() + std::size_t{image_.step} * std::size_t(v);
  }

  /// Returns the numbers in the machine's order.
  template <class T>
  [[nodiscard]] Image<T> pixels() const {
    Image<T> out{width(), height()};
    for (int v = 0; v < height(); ++v) std::memcpy(out.row(v), row(v), sizeof(T) * image_.width);
    if (image_.is_bigendian == 0) return out;
    for (std::size_t i = 0; i < out.size(); ++i) {
      auto* bytes = reinterpret_cast<std::byte*>(out.data() + i);  // NOLINT: bytes of a number
      std::reverse(bytes, bytes + sizeof(T));
    }
    return out;
  }

 private:
  explicit ImageRows(const messages::Image& image) : image_{image} {}
  const messages::Image& image_;
};

/// Reads "16UC1; compressedDepth png": a head of twelve bytes, then a PNG. Floats are quantised by their inverse.
Result<DepthImage> read_compressed_depth(const CompressedImage& image, const DepthEncoding& encoding) {
  const std::string_view format = image.format;
  if (format.find("rvl") != std::string_view::npos) {
    return Error{Errc::unsupported, "compressedDepth packed as RVL is not read; record it as PNG", {}};
  }
  ByteReader head{image.data};
  if (!head.has(12)) return Error{Errc::corrupt_data, "a compressedDepth image without its head", {}};
  static_cast<void>(head.value<std::int32_t>());
  const auto quantum = head.value<float>();
  const auto offset = head.value<float>();
  SACCADE_TRY(const Image16 samples, decode_png16(std::span{image.data}.subspan(12)));
  if (!format.starts_with("32FC1")) return decode_depth(samples, encoding);
  DepthImage depth{samples.width(), samples.height()};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::uint16_t sample = samples.data()[i];
    const float metres = sample == 0 ? 0.0F : quantum / (static_cast<float>(sample) - offset);
    depth.data()[i] = std::isfinite(metres) && metres > 0.0F ? metres : 0.0F;
  }
  return depth;
}

std::string quoted_encoding(const std::string& encoding) { return "the encoding \"" + encoding.substr(0, 40) + "\""; }

}  // namespace

bool is_image(const BagTopic& topic) {
  return topic.wire && (topic.type == "sensor_msgs/Image" || topic.type == kCompressedType);
}

bool is_depth_encoding(std::string_view encoding) {
  return encoding == "16UC1" || encoding == "mono16" || encoding == "32FC1" ||
         encoding.find("compressedDepth") != std::string_view::npos;
}

Result<ImageHead> read_image_head(const BagMessage& message) {
  if (message.type == kCompressedType) {
    SACCADE_TRY(const auto image, read_ros<CompressedImage>(message));
    return ImageHead{time_ns(image.header.stamp), std::string{frame_name(image.header.frame_id)}, image.format};
  }
  SACCADE_TRY(const auto image, read_ros<messages::Image>(message));
  return ImageHead{time_ns(image.header.stamp), std::string{frame_name(image.header.frame_id)}, image.encoding};
}

Result<DepthImage> read_depth_message(const BagMessage& message, const DepthEncoding& encoding) {
  if (message.type == kCompressedType) {
    SACCADE_TRY(const auto image, read_ros<CompressedImage>(message));
    if (is_depth_encoding(image.format)) return read_compressed_depth(image, encoding);
    return Error{Errc::unsupported, quoted_encoding(image.format) + " is none of depth; compressedDepth is", {}};
  }
  SACCADE_TRY(const auto image, read_ros<messages::Image>(message));
  if (image.encoding == "32FC1") {
    SACCADE_TRY(const ImageRows rows, ImageRows::create(image, 4));
    DepthImage depth = rows.pixels<float>();
    for (std::size_t i = 0; i < depth.size(); ++i) {
      if (!std::isfinite(depth.data()[i])) depth.data()[i] = 0.0F;
    }
    return depth;
  }
  if (!is_depth_encoding(image.encoding)) {
    return Error{
        Errc::unsupported, quoted_encoding(image.encoding) + " is none of depth; 16UC1, mono16 and 32FC1 are", {}};
  }
  SACCADE_TRY(const ImageRows rows, ImageRows::create(image, 2));
  return decode_depth(rows.pixels<std::uint16_t>(), encoding);
}

Result<ColorImage> read_color_message(const BagMessage& message) {
  if (message.type == kCompressedType) {
    SACCADE_TRY(const auto image, read_ros<CompressedImage>(message));
    return decode_color(image.data);
  }
  SACCADE_TRY(const auto image, read_ros<messages::Image>(message));
  const std::string_view encoding = image.encoding;
  const bool has_alpha = encoding == "rgba8" || encoding == "bgra8";
  const bool is_grey = encoding == "mono8" || encoding == "8UC1";
  const bool is_bgr = encoding == "bgr8" || encoding == "bgra8" || encoding == "8UC3";
  if (!has_alpha && !is_grey && !is_bgr && encoding != "rgb8") {
    return Error{Errc::unsupported,
                 quoted_encoding(image.encoding) + " is not a supported colour encoding; use rgb8 or bgr8",
                 {}};
  }
  const std::size_t pixel_bytes = is_grey ? 1 : has_alpha ? 4 : 3;
  SACCADE_TRY(const ImageRows rows, ImageRows::create(image, pixel_bytes));
  const std::size_t red = is_bgr ? 2 : 0;
  ColorImage color{rows.width(), rows.height()};
  for (int v = 0; v < rows.height(); ++v) {
    const std::byte* pixel = rows.row(v);
    for (int u = 0; u < rows.width(); ++u, pixel += pixel_bytes) {
      const auto at = [&](std::size_t channel) { return static_cast<std::uint8_t>(pixel[is_grey ? 0 : channel]); };
      color(u, v) = {at(red), at(1), at(2 - red)};
    }
  }
  return color;
}

Result<Intrinsics> read_camera_info(const BagMessage& message, bool is_rectified) {
  SACCADE_TRY(const auto info, read_ros<messages::CameraInfo>(message));
  const bool uses_p = is_rectified && info.p[0] > 0.0;
  Intrinsics intrinsics;
  intrinsics.fx = uses_p ? info.p[0] : info.k[0];
  intrinsics.fy = uses_p ? info.p[5] : info.k[4];
  intrinsics.cx = uses_p ? info.p[2] : info.k[2];
  intrinsics.cy = uses_p ? info.p[6] : info.k[5];
  if (info.width > 0 && info.height > 0 && info.binning_x <= 1 && info.binning_y <= 1 && info.roi.width == 0 &&
      info.width <= static_cast<std::uint32_t>(kMaxImageEdge) &&
      info.height <= static_cast<std::uint32_t>(kMaxImageEdge)) {
    intrinsics.width = static_cast<int>(info.width);
    intrinsics.height = static_cast<int>(info.height);
  }
  // The image is a part of the sensor's, or every n-th of its pixels: pixel u is the sensor's n·u + (n − 1) / 2 +
  // offset.
  const double n_x = std::max(1U, info.binning_x);
  const double n_y = std::max(1U, info.binning_y);
  intrinsics.cx = (intrinsics.cx - info.roi.x_offset - 0.5 * (n_x - 1.0)) / n_x;
  intrinsics.cy = (intrinsics.cy - info.roi.y_offset - 0.5 * (n_y - 1.0)) / n_y;
  intrinsics.fx /= n_x;
  intrinsics.fy /= n_y;
  const auto is_zero = [](double d) { return d == 0.0; };
  if (uses_p || std::ranges::all_of(info.d, is_zero)) return intrinsics;
  const bool is_brown_conrady = info.distortion_model == "plumb_bob" ||
                                info.distortion_model == "rational_polynomial" || info.distortion_model.empty();
  const auto lens = Distortion::from_coefficients(info.d);
  if (!is_brown_conrady || info.d.size() < 4 || !lens) {
    return Error{Errc::unsupported,
                 "the lens model \"" + info.distortion_model.substr(0, 40) +
                     "\" is not undone here; use rectified images, or say --intrinsics and --distortion",
                 {}};
  }
  intrinsics.distortion = *lens;
  return intrinsics;
}

}  // namespace saccade::internal::io_bags

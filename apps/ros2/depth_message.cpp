// SPDX-License-Identifier: Apache-2.0
#include "depth_message.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

namespace saccade::ros2 {
namespace {

std::string size_text(std::uint64_t width, std::uint64_t height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

}  // namespace

const char* depth_format(const messages::Image& image) {
  if (image.encoding == "16UC1" || image.encoding == "mono16") return "uint16_mm";
  if (image.encoding == "32FC1") return "float32_m";
  throw std::runtime_error{"images of encoding '" + image.encoding +
                           "' are no depth; 16UC1, mono16 and 32FC1 are read. Is it the topic of the depth image?"};
}

std::string depth_bytes(const messages::Image& image) {
  const std::size_t pixel = depth_format(image) == std::string{"uint16_mm"} ? 2 : 4;
  const std::size_t row = pixel * image.width;
  if (image.width == 0 || image.height == 0 || image.step < row ||
      image.data.size() / image.step < image.height) {  // the last row may not lack its padding: ROS says step × height
    throw std::runtime_error{"an image of " + size_text(image.width, image.height) + " pixels with " +
                             std::to_string(image.step) + " bytes a row has " + std::to_string(image.data.size()) +
                             " bytes"};
  }
  std::string bytes(row * image.height, '\0');
  for (std::size_t v = 0; v < image.height; ++v) {
    const auto* from = reinterpret_cast<const char*>(image.data.data() + v * image.step);
    std::copy_n(from, row, bytes.data() + v * row);
  }
  if (image.is_bigendian != 0) {
    for (auto at = bytes.begin(); at != bytes.end(); at += static_cast<std::ptrdiff_t>(pixel)) {
      std::reverse(at, at + static_cast<std::ptrdiff_t>(pixel));
    }
  }
  return bytes;
}

Intrinsics intrinsics_of(const messages::CameraInfo& info, const messages::Image& image, bool rectified) {
  const bool distorted = std::any_of(info.d.begin(), info.d.end(), [](double d) { return d != 0.0; });
  if (distorted && !rectified) {
    throw std::runtime_error{"its camera info has distortion (" + info.distortion_model +
                             "); take the topic of rectified images (depth_image_proc, image_proc), with --rectified"};
  }
  const auto& m = rectified ? std::array{info.p[0], info.p[5], info.p[2], info.p[6]}
                            : std::array{info.k[0], info.k[4], info.k[2], info.k[5]};
  const bool finite = std::all_of(m.begin(), m.end(), [](double x) { return std::isfinite(x); });
  if (!finite || m[0] <= 0.0 || m[1] <= 0.0) {
    throw std::runtime_error{std::string{"its camera info has no focal length in "} + (rectified ? "P" : "K") +
                             "; is the camera calibrated?"};
  }
  const double bin_x = std::max<std::uint32_t>(info.binning_x, 1);
  const double bin_y = std::max<std::uint32_t>(info.binning_y, 1);
  const bool whole = info.roi.width == 0 || info.roi.height == 0;
  const double width = std::floor((whole ? info.width : info.roi.width) / bin_x);
  const double height = std::floor((whole ? info.height : info.roi.height) / bin_y);
  if (width != image.width || height != image.height) {
    throw std::runtime_error{"its images have " + size_text(image.width, image.height) +
                             " pixels, its camera info says " +
                             size_text(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height)) +
                             "; do the two topics belong together?"};
  }
  const double x0 = whole ? 0.0 : info.roi.x_offset;
  const double y0 = whole ? 0.0 : info.roi.y_offset;
  return {m[0] / bin_x, m[1] / bin_y, (m[2] - x0 + 0.5) / bin_x - 0.5, (m[3] - y0 + 0.5) / bin_y - 0.5};
}

}  // namespace saccade::ros2

// SPDX-License-Identifier: Apache-2.0
// Feeds the readers of calibrations of recordings: YAML of OpenCV, info.txt of BundleFusion, scene_camera.json of BOP,
// calibration.json of an Azure Kinect, and the order of frames' names.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "saccade/io/frames/internal/azure_kinect.hpp"
#include "saccade/io/frames/internal/calibration.hpp"
#include "saccade/io/frames/internal/layout_files.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text{reinterpret_cast<const char*>(data), size};
  if (const auto camera = saccade::parse_opencv_camera(text)) {
    if (!std::isfinite(camera->fx) || camera->fx == 0.0) std::abort();
  }
  static_cast<void>(saccade::parse_local_transform(text));
  if (const auto info = saccade::parse_sensor_info(text)) {
    if (info->depth.depth_units_per_m && !(*info->depth.depth_units_per_m > 0.0)) std::abort();
  }
  static_cast<void>(saccade::parse_bop_cameras(text));
  if (const auto azure = saccade::parse_azure_kinect_calibration(text)) {
    const auto depth = azure->of_depth_images(640, 576);
    if (!depth || !std::isfinite(depth->cx) || !(depth->fx > 0.0)) std::abort();
    static_cast<void>(depth->distortion->regular_at({0.5, 0.5}));
  }
  const std::string_view first = text.substr(0, size / 2);
  const std::string_view second = text.substr(size / 2);
  if (saccade::comes_before(first, second) && saccade::comes_before(second, first)) std::abort();
  static_cast<void>(saccade::number_in(text));
  return 0;
}

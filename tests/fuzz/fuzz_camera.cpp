// SPDX-License-Identifier: Apache-2.0
// Feeds the readers of intrinsics (text, matrix, JSON), cam.info files and mask polygons.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "saccade/io/frames/camera_io.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text{reinterpret_cast<const char*>(data), size};
  constexpr int kWidth{64};
  constexpr int kHeight{48};
  if (const auto intrinsics = saccade::parse_intrinsics(text)) {
    const auto camera = intrinsics->camera(intrinsics->width.value_or(kWidth), intrinsics->height.value_or(kHeight));
    if (camera && !camera->validate()) std::abort();
    if (camera && intrinsics->distortion && camera->width * camera->height <= kWidth * kHeight) {
      static_cast<void>(saccade::Undistorter::create(*camera, *intrinsics->distortion));
    }
  }
  static_cast<void>(saccade::parse_cam_info(text));
  if (const auto polygons = saccade::parse_polygons(text)) {
    static_cast<void>(saccade::mask_from_polygons(kWidth, kHeight, *polygons));
  }
  return 0;
}

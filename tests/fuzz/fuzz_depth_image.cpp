// SPDX-License-Identifier: Apache-2.0
// Feeds the readers of depth images and colours in PGM, PPM, TIFF and NPY; accepted depths are finite and not negative.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "saccade/io/frames/depth_io.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = std::as_bytes(std::span{data, size});
  const auto depth = saccade::decode_depth_image(file, {{1000.0, false}, saccade::UnitsSource::given});
  if (depth) {
    for (const float value : depth->pixels()) {
      if (!(value >= 0.0F)) std::abort();
    }
  }
  static_cast<void>(saccade::decode_color(file));
  return 0;
}

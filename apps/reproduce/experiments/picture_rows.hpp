// SPDX-License-Identifier: Apache-2.0
#pragma once
// picture_rows: pictures in rows and columns, such as one column for each view.

#include <string>
#include <vector>

#include "saccade/sensor/image.hpp"

namespace saccade::reproduce {

struct PictureRow {
  std::string title;
  std::vector<ColorImage> pictures;
};

/// Sets the rows below each other on white, each with its title; pictures of a row are numbered from `first`. Rows
/// without pictures are left out; without any, one white pixel.
[[nodiscard]] ColorImage picture_rows(const std::vector<PictureRow>& rows, std::size_t first = 1);

}  // namespace saccade::reproduce

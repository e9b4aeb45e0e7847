// SPDX-License-Identifier: Apache-2.0
#include "experiments/picture_rows.hpp"

#include <algorithm>

#include "saccade/report/sheet.hpp"

namespace saccade::reproduce {

ColorImage picture_rows(const std::vector<PictureRow>& rows, std::size_t first) {
  std::vector<ColorImage> sheets;
  int width = 1, height = 0;
  for (const PictureRow& row : rows) {
    if (row.pictures.empty()) continue;
    Sheet sheet;
    for (std::size_t i = 0; i < row.pictures.size(); ++i) {
      sheet.panels.push_back({row.pictures[i], row.title + " " + std::to_string(first + i), {}, {}, {}});
    }
    sheets.push_back(compose(sheet));
    width = std::max(width, sheets.back().width());
    height += sheets.back().height();
  }
  ColorImage page{width, std::max(1, height), Rgb8{255, 255, 255}};
  int y = 0;
  for (const ColorImage& sheet : sheets) {
    paste(page, 0, y, sheet);
    y += sheet.height();
  }
  return page;
}

}  // namespace saccade::reproduce

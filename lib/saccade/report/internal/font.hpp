// SPDX-License-Identifier: Apache-2.0
#pragma once
// draw_text, text_width: captions and labels in DejaVu Sans.

#include <string_view>

#include "saccade/sensor/image.hpp"

namespace saccade {

enum class TextAnchor { left, center, right };

struct TextStyle {
  double size_px{12.0};  ///< height of capitals
  Rgb8 color{40, 44, 52};
  TextAnchor anchor{TextAnchor::left};
};

/// Width of the text in pixels.
[[nodiscard]] double text_width(std::string_view text, const TextStyle& style);

/// Draws one line of UTF-8 text; (x, y) is the left end, centre or right end of its base line. What the font lacks
/// shows as a box. What falls outside the image is cut.
void draw_text(ColorImage& image, double x, double y, std::string_view text, const TextStyle& style);

}  // namespace saccade

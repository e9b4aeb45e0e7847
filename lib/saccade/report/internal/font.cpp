// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/internal/font.hpp"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <string>

#include "saccade/core/result.hpp"
#include "saccade/report/internal/blend.hpp"

/// The file of the font, embedded by font_data.cpp.
extern "C" const unsigned char saccade_font_begin[];
extern "C" const unsigned char saccade_font_end[];

namespace saccade {
namespace {

constexpr double kPer26Dot6{64.0};       // fractions of a pixel that FreeType counts in
constexpr double kCapitalsPerEm{0.729};  // DejaVu Sans
constexpr char32_t kUnreadable{0xFFFD};

/// The face of the embedded font. One thread at a time.
class Face {
 public:
  Face() {
    SACCADE_EXPECTS(FT_Init_FreeType(&library_) == 0);
    SACCADE_EXPECTS(
        FT_New_Memory_Face(library_, saccade_font_begin, saccade_font_end - saccade_font_begin, 0, &face_) == 0);
  }
  Face(const Face&) = delete;
  Face& operator=(const Face&) = delete;
  ~Face() {
    FT_Done_Face(face_);
    FT_Done_FreeType(library_);
  }

  void set_size(double capitals_px) {
    const auto em = static_cast<FT_F26Dot6>(std::lround(kPer26Dot6 * capitals_px / kCapitalsPerEm));
    constexpr FT_UInt kPixelsPerInch{72};  // a point is a pixel
    FT_Set_Char_Size(face_, 0, std::max<FT_F26Dot6>(em, 1), kPixelsPerInch, kPixelsPerInch);
  }
  /// Loads the outline of a character and returns its advance in pixels.
  double load(char32_t code) {
    if (FT_Load_Char(face_, code, FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP) != 0) return 0.0;
    return static_cast<double>(face_->glyph->advance.x) / kPer26Dot6;
  }
  /// Draws the loaded outline with its origin at (x, y).
  void draw(ColorImage& image, double x, double y, const Rgb8& color) {
    const double left = std::floor(x);
    const double base = std::ceil(y);
    FT_Outline_Translate(&face_->glyph->outline, std::lround(kPer26Dot6 * (x - left)),
                         std::lround(kPer26Dot6 * (base - y)));
    if (FT_Render_Glyph(face_->glyph, FT_RENDER_MODE_NORMAL) != 0) return;
    const FT_Bitmap& covers = face_->glyph->bitmap;
    const int u0 = static_cast<int>(left) + face_->glyph->bitmap_left;
    const int v0 = static_cast<int>(base) - face_->glyph->bitmap_top;
    for (int row = 0; row < static_cast<int>(covers.rows); ++row) {
      for (int column = 0; column < static_cast<int>(covers.width); ++column) {
        const int u = u0 + column;
        const int v = v0 + row;
        const std::uint8_t cover = covers.buffer[row * covers.pitch + column];
        if (cover == 0 || u < 0 || v < 0 || u >= image.width() || v >= image.height()) continue;
        constexpr double kMost{255.0};
        image(u, v) = blend(image(u, v), color, cover / kMost);
      }
    }
  }

 private:
  FT_Library library_{nullptr};
  FT_Face face_{nullptr};
};

std::mutex face_mutex;

Face& face() {
  static Face only;
  return only;
}

/// Returns the characters of UTF-8 text; bytes that are none become the replacement character.
std::u32string decode(std::string_view text) {
  std::u32string codes;
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t bytes = lead < 0x80 ? 1 : lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
    char32_t code = bytes == 1 ? lead : lead & (0x7FU >> bytes);
    bool whole = (lead < 0x80 || lead >= 0xC2) && lead < 0xF5 && i + bytes <= text.size();
    for (std::size_t k = 1; whole && k < bytes; ++k) {
      const auto next = static_cast<unsigned char>(text[i + k]);
      whole = (next & 0xC0U) == 0x80U;
      code = code << 6U | (next & 0x3FU);
    }
    codes += whole ? code : kUnreadable;
    i += whole ? bytes : 1;
  }
  return codes;
}

double width_of(const std::u32string& codes) {
  double width{0.0};
  for (const char32_t code : codes) width += face().load(code);
  return width;
}

}  // namespace

double text_width(std::string_view text, const TextStyle& style) {
  const std::lock_guard lock{face_mutex};
  face().set_size(style.size_px);
  return width_of(decode(text));
}

void draw_text(ColorImage& image, double x, double y, std::string_view text, const TextStyle& style) {
  const std::lock_guard lock{face_mutex};
  face().set_size(style.size_px);
  const std::u32string codes = decode(text);
  if (style.anchor != TextAnchor::left) x -= width_of(codes) * (style.anchor == TextAnchor::center ? 0.5 : 1.0);
  for (const char32_t code : codes) {
    const double advance = face().load(code);
    face().draw(image, x, y, style.color);
    x += advance;
  }
}

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/internal/font.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "saccade/report/internal/blend.hpp"

namespace saccade {
namespace {

/// Strokes separated by spaces; a stroke is a list of points, each two digits: x from the left, y from the top.
/// Capitals reach from y = 0 to the base line at y = 6, small letters start at y = 2, tails end at y = 8.
struct Glyph {
  char32_t code;
  int width;
  const char* strokes;
};

constexpr std::array kGlyphs{
    Glyph{U' ', 2, ""},
    Glyph{U'!', 0, "0004 0606"},
    Glyph{U'"', 1, "0001 1011"},
    Glyph{U'#', 4, "1016 3036 0242 0444"},
    Glyph{U'$', 4, "4110010213334445361605 2027"},
    Glyph{U'%', 4, "4006 0010110100 3545463635"},
    Glyph{U'&', 4, "46011020310405163643"},
    Glyph{U'\'', 0, "0001"},
    Glyph{U'(', 1, "10020416"},
    Glyph{U')', 1, "00121406"},
    Glyph{U'*', 4, "2125 0244 4204"},
    Glyph{U'+', 4, "2226 0444"},
    Glyph{U',', 1, "1607"},
    Glyph{U'-', 2, "0424"},
    Glyph{U'.', 0, "0606"},
    Glyph{U'/', 2, "2006"},
    Glyph{U'0', 4, "103041453616050110"},
    Glyph{U'1', 4, "112026 1636"},
    Glyph{U'2', 4, "01103041420646"},
    Glyph{U'3', 4, "01103041423323 334445361605"},
    Glyph{U'4', 4, "36300444"},
    Glyph{U'5', 4, "400002324345361605"},
    Glyph{U'6', 4, "413010010516364544331304"},
    Glyph{U'7', 4, "004016"},
    Glyph{U'8', 4, "13020110304142331304051636454433"},
    Glyph{U'9', 4, "051636454130100102133342"},
    Glyph{U':', 0, "0303 0606"},
    Glyph{U';', 1, "1313 1607"},
    Glyph{U'<', 3, "320436"},
    Glyph{U'=', 3, "0333 0535"},
    Glyph{U'>', 3, "023406"},
    Glyph{U'?', 3, "01102031322324 2626"},
    Glyph{U'@', 5, "4434324222131526344554514010010516 36"},
    Glyph{U'A', 4, "062046 1434"},
    Glyph{U'B', 4, "033342413000063645443303"},
    Glyph{U'C', 4, "4130100105163645"},
    Glyph{U'D', 4, "00062644422000"},
    Glyph{U'E', 4, "40000646 0333"},
    Glyph{U'F', 4, "400006 0333"},
    Glyph{U'G', 4, "41301001051636454323"},
    Glyph{U'H', 4, "0006 4046 0343"},
    Glyph{U'I', 0, "0006"},
    Glyph{U'J', 3, "3035261605"},
    Glyph{U'K', 4, "0006 400346"},
    Glyph{U'L', 3, "000636"},
    Glyph{U'M', 4, "0600244046"},
    Glyph{U'N', 4, "06004640"},
    Glyph{U'O', 4, "103041453616050110"},
    Glyph{U'P', 4, "06003041423303"},
    Glyph{U'Q', 4, "103041453616050110 2446"},
    Glyph{U'R', 4, "06003041423303 2346"},
    Glyph{U'S', 4, "413010010213334445361605"},
    Glyph{U'T', 4, "0040 2026"},
    Glyph{U'U', 4, "000516364540"},
    Glyph{U'V', 4, "002640"},
    Glyph{U'W', 6, "0016315660"},
    Glyph{U'X', 4, "0046 4006"},
    Glyph{U'Y', 4, "002340 2326"},
    Glyph{U'Z', 4, "00400646"},
    Glyph{U'[', 1, "10000616"},
    Glyph{U'\\', 2, "0026"},
    Glyph{U']', 1, "00101606"},
    Glyph{U'^', 4, "022042"},
    Glyph{U'_', 4, "0747"},
    Glyph{U'`', 1, "0011"},
    Glyph{U'a', 3, "0222333616051434"},
    Glyph{U'b', 3, "00062635332202"},
    Glyph{U'c', 3, "321203051636"},
    Glyph{U'd', 3, "30361605031232"},
    Glyph{U'e', 3, "043433221203051636"},
    Glyph{U'f', 2, "201116 0222"},
    Glyph{U'g', 3, "361605031232372808"},
    Glyph{U'h', 3, "0006 0312223336"},
    Glyph{U'i', 0, "0206 0000"},
    Glyph{U'j', 1, "121708 1010"},
    Glyph{U'k', 3, "0006 320436"},
    Glyph{U'l', 1, "000516"},
    Glyph{U'm', 4, "0602 03122326 23324346"},
    Glyph{U'n', 3, "0602 0312223336"},
    Glyph{U'o', 3, "122233352616050312"},
    Glyph{U'p', 3, "08022233352606"},
    Glyph{U'q', 3, "38321203051636"},
    Glyph{U'r', 2, "0602 031222"},
    Glyph{U's', 3, "3212031424352606"},
    Glyph{U't', 2, "101526 0222"},
    Glyph{U'u', 3, "02051636 3236"},
    Glyph{U'v', 4, "022642"},
    Glyph{U'w', 4, "0216233642"},
    Glyph{U'x', 3, "0236 3206"},
    Glyph{U'y', 3, "02051636 32372808"},
    Glyph{U'z', 3, "02320636"},
    Glyph{U'{', 2, "2011120314152627"},
    Glyph{U'|', 0, "0007"},
    Glyph{U'}', 2, "0011122314150607"},
    Glyph{U'~', 4, "0413243544"},
    Glyph{U'°', 2, "1021120110"},
    Glyph{U'±', 4, "2125 0343 0646"},
    Glyph{U'²', 2, "0020210323"},
    Glyph{U'µ', 3, "0208 051636 3236"},
    Glyph{U'·', 0, "0404"},
    Glyph{U'×', 3, "0336 3306"},
    Glyph{U'–', 4, "0444"},
    Glyph{U'→', 5, "0454 325436"},
};
constexpr Glyph kUnknown{U'?', 3, "0030360600"};
constexpr double kGlyphGap{1.9};  ///< units between glyphs
constexpr double kCapitalUnits{6.0};

const Glyph& glyph_of(char32_t code) {
  const auto it = std::find_if(kGlyphs.begin(), kGlyphs.end(), [code](const Glyph& g) { return g.code == code; });
  return it == kGlyphs.end() ? kUnknown : *it;
}

/// Code points of UTF-8 text; a malformed byte counts as a character of its own.
std::vector<char32_t> decode(std::string_view text) {
  std::vector<char32_t> codes;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const std::size_t length = byte < 0x80U ? 1 : byte >= 0xE0U && byte < 0xF0U ? 3 : byte >= 0xC0U ? 2 : 1;
    char32_t code = length == 1 ? byte : length == 2 ? byte & 0x1FU : byte & 0x0FU;
    std::size_t used{1};
    while (used < length && i + used < text.size()) {
      code = (code << 6U) | (static_cast<unsigned char>(text[i + used]) & 0x3FU);
      ++used;
    }
    codes.push_back(code);
    i += used;
  }
  return codes;
}

struct Segment {
  double x0, y0, x1, y1;
  [[nodiscard]] double distance(double x, double y) const {
    const double dx = x1 - x0;
    const double dy = y1 - y0;
    const double length2 = dx * dx + dy * dy;
    const double t = length2 > 0.0 ? std::clamp(((x - x0) * dx + (y - y0) * dy) / length2, 0.0, 1.0) : 0.0;
    return std::hypot(x - x0 - t * dx, y - y0 - t * dy);
  }
};

std::vector<Segment> segments_of(const Glyph& glyph, double x, double y, double unit_px) {
  std::vector<Segment> segments;
  const auto px = [&](char c) { return x + (c - '0') * unit_px; };
  const auto py = [&](char c) { return y + (c - '0' - kCapitalUnits) * unit_px; };
  const std::string_view all{glyph.strokes};
  for (std::size_t start = 0; start < all.size();) {
    const std::size_t end = std::min(all.find(' ', start), all.size());
    const std::string_view s = all.substr(start, end - start);
    for (std::size_t i = 0; i + 3 < s.size(); i += 2) {
      segments.push_back({px(s[i]), py(s[i + 1]), px(s[i + 2]), py(s[i + 3])});
    }
    start = end + 1;
  }
  return segments;
}

/// Covers each pixel by its distance to the nearest stroke, so joints are not drawn twice.
void draw_strokes(ColorImage& image, const std::vector<Segment>& segments, double width_px, const Rgb8& color) {
  if (segments.empty()) return;
  double x0{1e9}, y0{1e9}, x1{-1e9}, y1{-1e9};
  for (const Segment& s : segments) {
    x0 = std::min({x0, s.x0, s.x1});
    y0 = std::min({y0, s.y0, s.y1});
    x1 = std::max({x1, s.x0, s.x1});
    y1 = std::max({y1, s.y0, s.y1});
  }
  const double reach = width_px / 2.0 + 1.0;
  const int u0 = std::max(0, static_cast<int>(std::floor(x0 - reach)));
  const int v0 = std::max(0, static_cast<int>(std::floor(y0 - reach)));
  const int u1 = std::min(image.width() - 1, static_cast<int>(std::ceil(x1 + reach)));
  const int v1 = std::min(image.height() - 1, static_cast<int>(std::ceil(y1 + reach)));
  for (int v = v0; v <= v1; ++v) {
    for (int u = u0; u <= u1; ++u) {
      double nearest{1e9};
      for (const Segment& s : segments) nearest = std::min(nearest, s.distance(u, v));
      const double cover = std::clamp(width_px / 2.0 + 0.5 - nearest, 0.0, 1.0);
      if (cover > 0.0) image(u, v) = blend(image(u, v), color, cover);
    }
  }
}

}  // namespace

double text_width(std::string_view text, const TextStyle& style) {
  double units{0.0};
  for (const char32_t code : decode(text)) units += glyph_of(code).width + kGlyphGap;
  return std::max(0.0, units - kGlyphGap) * style.size_px / kCapitalUnits;
}

void draw_text(ColorImage& image, double x, double y, std::string_view text, const TextStyle& style) {
  const double unit_px = style.size_px / kCapitalUnits;
  const double width_px = std::max(1.1, 0.13 * style.size_px);
  if (style.anchor != TextAnchor::left) x -= text_width(text, style) * (style.anchor == TextAnchor::center ? 0.5 : 1.0);
  for (const char32_t code : decode(text)) {
    const Glyph& glyph = glyph_of(code);
    draw_strokes(image, segments_of(glyph, x, y, unit_px), width_px, style.color);
    x += (glyph.width + kGlyphGap) * unit_px;
  }
}

}  // namespace saccade

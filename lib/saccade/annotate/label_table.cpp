// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/label_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

namespace saccade {
namespace {

using Color = std::array<std::uint8_t, 3>;

constexpr std::size_t kWellApart{256};
constexpr int kChannelStep{17};  // 16 levels per channel
constexpr double kLeastChroma{30.0};
constexpr double kLeastLightness{54.0};
constexpr double kMostLightness{78.0};

/// Colour in units of 1/256: integers, so that the order of colours does not depend on rounding.
using WholeLab = std::array<std::int64_t, 3>;

WholeLab whole_lab(const Color& color) {
  const std::array<double, 3> lab = cielab(color);
  return {std::llround(256.0 * lab[0]), std::llround(256.0 * lab[1]), std::llround(256.0 * lab[2])};
}

std::int64_t squared_distance(const WholeLab& a, const WholeLab& b) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

bool is_colorful(const Color& color) {
  const std::array<double, 3> lab = cielab(color);
  return lab[0] >= kLeastLightness && lab[0] <= kMostLightness && std::hypot(lab[1], lab[2]) >= kLeastChroma;
}

std::vector<Color> colorful_grid() {
  std::vector<Color> colors;
  for (int r = 0; r < 256; r += kChannelStep) {
    for (int g = 0; g < 256; g += kChannelStep) {
      for (int b = 0; b < 256; b += kChannelStep) {
        const Color color{static_cast<std::uint8_t>(r), static_cast<std::uint8_t>(g), static_cast<std::uint8_t>(b)};
        if (is_colorful(color)) colors.push_back(color);
      }
    }
  }
  return colors;
}

/// Returns well mixed bits of a number (the finaliser of SplitMix64).
std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31U);
}

/// Returns the bytes of the UTF-8 character at the start of a text; 0 where there is none.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const auto follows = [&](std::size_t i) { return (byte(i) & 0xC0U) == 0x80U; };
  const unsigned first = byte(0);
  if (first < 0x80U) return 1;
  if (first >= 0xC2U && first <= 0xDFU) return follows(1) ? 2 : 0;
  if ((first & 0xF0U) == 0xE0U) {
    const bool overlong = first == 0xE0U && byte(1) < 0xA0U;
    const bool surrogate = first == 0xEDU && byte(1) > 0x9FU;
    return follows(1) && follows(2) && !overlong && !surrogate ? 3 : 0;
  }
  if (first >= 0xF0U && first <= 0xF4U) {
    const bool outside = (first == 0xF0U && byte(1) < 0x90U) || (first == 0xF4U && byte(1) > 0x8FU);
    return follows(1) && follows(2) && follows(3) && !outside ? 4 : 0;
  }
  return 0;
}

Status check_text(std::string_view text, const char* what) {
  const auto wrong = [what](const std::string& why) {
    return Error{Errc::invalid_argument, std::string{"the "} + what + " of a label " + why, {}};
  };
  if (text.size() > kMaxLabelBytes) return wrong("has more than " + std::to_string(kMaxLabelBytes) + " bytes");
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text.substr(i));
    if (length == 0) return wrong("is not UTF-8");
    const auto first = static_cast<unsigned char>(text[i]);
    if (first < 0x20U || first == 0x7FU) return wrong("holds a control character");
    i += length;
  }
  return {};
}

}  // namespace

std::array<double, 3> cielab(const std::array<std::uint8_t, 3>& color) {
  std::array<double, 3> linear{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double c = color[i] / 255.0;
    linear[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  }
  const auto [r, g, b] = linear;
  const auto f = [](double t) { return t > 216.0 / 24389.0 ? std::cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0; };
  const double x = f((0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / 0.95047);
  const double y = f(0.2126729 * r + 0.7151522 * g + 0.0721750 * b);
  const double z = f((0.0193339 * r + 0.1191920 * g + 0.9503041 * b) / 1.08883);
  return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

DistinctColors::DistinctColors() : colors_{colorful_grid()} {
  std::vector<WholeLab> labs(colors_.size());
  std::transform(colors_.begin(), colors_.end(), labs.begin(), whole_lab);
  std::vector<std::int64_t> nearest(colors_.size(), std::numeric_limits<std::int64_t>::max());
  const auto keep_away_from = [&](const WholeLab& taken, std::size_t first) {
    for (std::size_t i = first; i < labs.size(); ++i) {
      nearest[i] = std::min(nearest[i], squared_distance(labs[i], taken));
    }
  };
  for (const Color& grey : {Color{0, 0, 0}, Color{128, 128, 128}, Color{255, 255, 255}})
    keep_away_from(whole_lab(grey), 0);
  for (std::size_t next = 0; next < kWellApart; ++next) {
    const auto farthest = std::max_element(nearest.begin() + static_cast<std::ptrdiff_t>(next), nearest.end());
    const auto chosen = static_cast<std::size_t>(farthest - nearest.begin());
    std::swap(colors_[next], colors_[chosen]);
    std::swap(labs[next], labs[chosen]);
    std::swap(nearest[next], nearest[chosen]);
    keep_away_from(labs[next], next + 1);
  }
}

std::array<std::uint8_t, 3> DistinctColors::operator()(std::uint32_t label) const {
  if (label >= 1 && label <= kWellApart) return colors_[label - 1];
  return colors_[mixed(label) % colors_.size()];
}

Status LabelInfo::validate() const {
  SACCADE_CHECK(check_text(name, "name"));
  return check_text(class_name, "class");
}

LabelInfo LabelTable::info(std::uint32_t label) const {
  const auto found = defined_.find(label);
  return found != defined_.end() ? found->second : LabelInfo{{}, generated_(label), {}, 0};
}

std::array<std::uint8_t, 3> LabelTable::color(std::uint32_t label) const {
  const auto found = defined_.find(label);
  return found != defined_.end() ? found->second.color : generated_(label);
}

void LabelTable::define(std::uint32_t label, LabelInfo info) {
  SACCADE_EXPECTS(label != kNoLabel && label <= kMaxLabel);
  defined_.insert_or_assign(label, std::move(info));
}

}  // namespace saccade

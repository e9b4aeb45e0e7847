// SPDX-License-Identifier: Apache-2.0
#pragma once
// LabelInfo, NumberedLabel: what is known of a label. DistinctColors: colours that are well apart. LabelTable.

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade {

/// The label of a point that has none.
inline constexpr std::uint32_t kNoLabel{0};
/// Labels are 1 to this; the number above stands for points without a segment in clouds (kUnlabelled).
inline constexpr std::uint32_t kMaxLabel{0xFFFFFFFEU};
/// Of a label's name and of its class.
inline constexpr std::size_t kMaxLabelBytes{256};

/// One line each of UTF-8; both may be empty.
struct LabelInfo {
  std::string name;
  std::array<std::uint8_t, 3> color{};  ///< red, green, blue; sRGB
  std::string class_name;               ///< for semantic labels: what kind of thing it is
  std::uint32_t instance{0};            ///< which of its class
  [[nodiscard]] bool operator==(const LabelInfo&) const = default;

  /// invalid_argument for text that is longer than kMaxLabelBytes, holds control characters or is no UTF-8.
  [[nodiscard]] Status validate() const;
};

struct NumberedLabel {
  std::uint32_t number{1};
  LabelInfo info;
  [[nodiscard]] bool operator==(const NumberedLabel&) const = default;
};

/// A colour for every label, always the same. Each of the first 256 is as far as can be, in CIELAB, from those before
/// it and from greys; further labels share some 3000 colours by a hash of their number. Made in some milliseconds.
class DistinctColors {
 public:
  DistinctColors();
  [[nodiscard]] std::array<std::uint8_t, 3> operator()(std::uint32_t label) const;

 private:
  std::vector<std::array<std::uint8_t, 3>> colors_;  ///< those of labels 1 to 256, then the others
};

/// L*, a*, b* of an sRGB colour under D65.
[[nodiscard]] std::array<double, 3> cielab(const std::array<std::uint8_t, 3>& color);

/// Labels by number. One that was not defined has a generated colour and nothing else.
class LabelTable {
 public:
  [[nodiscard]] LabelInfo info(std::uint32_t label) const;
  [[nodiscard]] std::array<std::uint8_t, 3> color(std::uint32_t label) const;
  [[nodiscard]] const std::map<std::uint32_t, LabelInfo>& defined() const { return defined_; }
  /// Expects a label that is one.
  void define(std::uint32_t label, LabelInfo info);
  void undefine(std::uint32_t label) { defined_.erase(label); }

 private:
  DistinctColors generated_;
  std::map<std::uint32_t, LabelInfo> defined_;
};

}  // namespace saccade

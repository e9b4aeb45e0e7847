// SPDX-License-Identifier: Apache-2.0
#pragma once
// LabelInfo, NumberedLabel: definition of a label. DistinctColors: clearly different colours. LabelTable.

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade {

/// Label of a point without one.
inline constexpr std::uint32_t kNoLabel{0};
/// Labels are 1 to this; the number above stands for points without a segment in clouds (kUnlabelled).
inline constexpr std::uint32_t kMaxLabel{0xFFFFFFFEU};
/// Limit of a label's name and of its class.
inline constexpr std::size_t kMaxLabelBytes{256};

/// One line each of UTF-8; both may be empty.
struct LabelInfo {
  std::string name;
  std::array<std::uint8_t, 3> color{};  ///< red, green, blue; sRGB
  std::string class_name;               ///< for semantic labels: the kind of object
  std::uint32_t instance{0};            ///< number within the class
  [[nodiscard]] bool operator==(const LabelInfo&) const = default;

  /// Answers invalid_argument for text that is longer than kMaxLabelBytes, holds control characters or is not UTF-8.
  [[nodiscard]] Status validate() const;
};

struct NumberedLabel {
  std::uint32_t number{1};
  LabelInfo info;
  [[nodiscard]] bool operator==(const NumberedLabel&) const = default;
};

/// Fixed colour for every label. Each of the first 256 is as far as possible, in CIELAB, from the previous ones and
/// from greys; further labels share some 3000 colours by a hash of their number. Computed in some milliseconds.
class DistinctColors {
 public:
  DistinctColors();
  [[nodiscard]] std::array<std::uint8_t, 3> operator()(std::uint32_t label) const;

 private:
  std::vector<std::array<std::uint8_t, 3>> colors_;  ///< those of labels 1 to 256, then the others
};

/// Returns L*, a*, b* of an sRGB colour under D65.
[[nodiscard]] std::array<double, 3> cielab(const std::array<std::uint8_t, 3>& color);

/// Labels by number. A label that was not defined has only a generated colour.
class LabelTable {
 public:
  [[nodiscard]] LabelInfo info(std::uint32_t label) const;
  [[nodiscard]] std::array<std::uint8_t, 3> color(std::uint32_t label) const;
  [[nodiscard]] const std::map<std::uint32_t, LabelInfo>& defined() const { return defined_; }
  /// Defines a label. Expects a valid number.
  void define(std::uint32_t label, LabelInfo info);
  void undefine(std::uint32_t label) { defined_.erase(label); }

 private:
  DistinctColors generated_;
  std::map<std::uint32_t, LabelInfo> defined_;
};

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#pragma once
// LabelCensus: how many points and control points each label has, and of which labels that changed. Rows and colours.

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <unordered_map>

#include "saccade/annotate/annotation.hpp"

namespace saccade::server {

class LabelCensus {
 public:
  explicit LabelCensus(const Annotation& annotation);

  /// The labels whose row is another one now. O(changes + labels).
  std::set<std::uint32_t> update(const Annotation& annotation, const Applied& applied);
  /// Those that are defined, or that points or control points have.
  [[nodiscard]] std::set<std::uint32_t> known(const Annotation& annotation) const;
  [[nodiscard]] std::size_t points(std::uint32_t label) const;
  [[nodiscard]] std::size_t control_points(std::uint32_t label) const;
  /// Of all labels.
  [[nodiscard]] std::size_t control_points() const { return label_of_.size(); }

 private:
  std::map<std::uint32_t, std::size_t> points_;
  std::map<std::uint32_t, std::size_t> control_points_;
  std::unordered_map<std::uint32_t, std::uint32_t> label_of_;  ///< by control point
};

/// "#rrggbb"
[[nodiscard]] std::string color_text(const std::array<std::uint8_t, 3>& color);
/// Of labels 1, 2 and so on, as long as nobody chose others.
[[nodiscard]] nlohmann::json well_apart_colors();
[[nodiscard]] nlohmann::json label_rows(const std::set<std::uint32_t>& labels, const Annotation& annotation,
                                        const LabelCensus& census);

}  // namespace saccade::server

// SPDX-License-Identifier: Apache-2.0
#pragma once
// LabelCensus: numbers of points and control points per label, and the labels whose numbers changed. Rows and colours.

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

  /// Returns the labels whose row changed. O(changes + labels).
  std::set<std::uint32_t> update(const Annotation& annotation, const Applied& applied);
  /// Returns the labels that are defined or in use by points or control points.
  [[nodiscard]] std::set<std::uint32_t> known(const Annotation& annotation) const;
  [[nodiscard]] std::size_t points(std::uint32_t label) const;
  [[nodiscard]] std::size_t control_points(std::uint32_t label) const;
  /// Returns the number of control points of all labels.
  [[nodiscard]] std::size_t control_points() const { return label_of_.size(); }

 private:
  std::map<std::uint32_t, std::size_t> points_;
  std::map<std::uint32_t, std::size_t> control_points_;
  std::unordered_map<std::uint32_t, std::uint32_t> label_of_;  ///< by control point
};

/// Returns "#rrggbb".
[[nodiscard]] std::string color_text(const std::array<std::uint8_t, 3>& color);
/// Returns the default colours of labels 1, 2 and so on.
[[nodiscard]] nlohmann::json well_apart_colors();
[[nodiscard]] nlohmann::json label_rows(const std::set<std::uint32_t>& labels, const Annotation& annotation,
                                        const LabelCensus& census);

}  // namespace saccade::server

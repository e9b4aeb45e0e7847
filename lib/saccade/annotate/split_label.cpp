// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/split_label.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "saccade/cloud/disjoint_sets.hpp"

namespace saccade {
namespace {

/// Share of the cut edges that may contradict the side of their part: noise where the stroke ends at a border.
constexpr double kMostContrary{0.05};

Error no_split(std::string why) { return {Errc::invalid_argument, std::move(why), "split"}; }

double cross(const ScreenPoint& a, const ScreenPoint& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Segments of the stroke by rows of pixels, to be met by short edges.
class StrokeRows {
 public:
  StrokeRows(std::span<const ScreenPoint> line, int height) : line_{line} {
    rows_.resize(static_cast<std::size_t>(height / kRow_px) + 1);
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const auto [first, last] = rows_of(line[i], line[i + 1]);
      for (std::size_t row = first; row <= last; ++row) rows_[row].push_back(i);
    }
  }

  /// Returns how an edge from p to q crosses the stroke: 0 not, or an even number of times; 1 with p to the right of
  /// its direction as one looks at the image, −1 with p to the left.
  [[nodiscard]] int side(const ScreenPoint& p, const ScreenPoint& q) const {
    int crossings{0};
    int found{0};
    const auto [first, last] = rows_of(p, q);
    for (std::size_t row = first; row <= last; ++row) {
      for (const std::size_t i : rows_[row]) {
        const ScreenPoint& a = line_[i];
        const ScreenPoint& b = line_[i + 1];
        if (row != std::max(first, rows_of(a, b).first)) continue;  // met before
        const bool p_right = cross(b - a, p - a) > 0.0;
        const bool q_right = cross(b - a, q - a) > 0.0;
        if (p_right == q_right || (cross(q - p, a - p) > 0.0) == (cross(q - p, b - p) > 0.0)) continue;
        ++crossings;
        found = p_right ? 1 : -1;
      }
    }
    return crossings % 2 == 1 ? found : 0;
  }

 private:
  static constexpr int kRow_px{16};

  [[nodiscard]] std::pair<std::size_t, std::size_t> rows_of(const ScreenPoint& a, const ScreenPoint& b) const {
    const auto row = [&](double v_px) {
      return static_cast<std::size_t>(std::clamp(v_px / kRow_px, 0.0, static_cast<double>(rows_.size() - 1)));
    };
    return {row(std::min(a.y(), b.y())), row(std::max(a.y(), b.y()))};
  }

  std::span<const ScreenPoint> line_;
  std::vector<std::vector<std::size_t>> rows_;
};

/// Rectangle around a stroke with some room for the edges that cross it.
ScreenRectangle around(const ScreenStroke& stroke) {
  constexpr double kRoom_px{64.0};
  ScreenRectangle rectangle{stroke.line.front(), stroke.line.front()};
  for (const ScreenPoint& point : stroke.line) {
    rectangle.corner = rectangle.corner.cwiseMin(point);
    rectangle.opposite = rectangle.opposite.cwiseMax(point);
  }
  rectangle.corner.array() -= kRoom_px;
  rectangle.opposite.array() += kRoom_px;
  return rectangle;
}

/// Returns the label whose edges on the seen surface the stroke crosses most; kNoLabel where it crosses none but
/// those of `given`.
Result<std::uint32_t> crossed_label(const Annotation& annotation, std::span<const Eigen::Vector3f> positions_m,
                                    const SelectionView& view, const ScreenStroke& stroke, const StrokeRows& rows,
                                    std::uint32_t given, const Executor& executor) {
  SACCADE_TRY(const auto seen, select_points(positions_m, view, around(stroke), kOnSurface_m, executor));
  const Neighbourhood& graph = annotation.forest().neighbourhood();
  const ScreenProjection project{view};
  std::map<std::uint32_t, std::size_t> counts;
  for (const std::uint32_t p : seen) {
    const std::uint32_t label = annotation.label_of(p);
    if (label == kNoLabel || label == given) continue;
    const ScreenPosition at_p = project(positions_m[p]);
    for (const Neighbourhood::Edge& edge : graph.edges(graph.node_of(p))) {
      const std::uint32_t q = graph.point_of(edge.node);
      if (q <= p || annotation.label_of(q) != label || !std::binary_search(seen.begin(), seen.end(), q)) continue;
      const ScreenPosition at_q = project(positions_m[q]);
      if (rows.side({at_p.u_px, at_p.v_px}, {at_q.u_px, at_q.v_px}) != 0) ++counts[label];
    }
  }
  const auto most =
      std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == counts.end() ? kNoLabel : most->first;
}

struct CutEdge {
  std::uint32_t right;
  std::uint32_t left;
};

/// Joins the label's points along the edges that the stroke does not cross. Returns the others.
std::vector<CutEdge> cut(const Annotation& annotation, std::span<const Eigen::Vector3f> positions_m,
                         const SelectionView& view, const StrokeRows& stroke, std::uint32_t label,
                         DisjointSets& joined) {
  const Neighbourhood& graph = annotation.forest().neighbourhood();
  const ScreenProjection project{view};
  std::vector<CutEdge> edges;
  const auto takes_part = [&](std::uint32_t point) {
    return annotation.label_of(point) == label && positions_m[point].allFinite() && view.is_inside(positions_m[point]);
  };
  for (std::uint32_t p = 0; p < positions_m.size(); ++p) {
    if (!takes_part(p)) continue;
    const ScreenPosition at_p = project(positions_m[p]);
    for (const Neighbourhood::Edge& edge : graph.edges(graph.node_of(p))) {
      const std::uint32_t q = graph.point_of(edge.node);
      if (q <= p || !takes_part(q)) continue;
      const ScreenPosition at_q = project(positions_m[q]);
      const bool in_view = at_p.in_view() && at_q.in_view();
      const int side = in_view ? stroke.side({at_p.u_px, at_p.v_px}, {at_q.u_px, at_q.v_px}) : 0;
      if (side == 0) {
        joined.join(p, q);
      } else {
        edges.push_back(side > 0 ? CutEdge{p, q} : CutEdge{q, p});
      }
    }
  }
  return edges;
}

}  // namespace

Result<LabelSplit> split_label(const Annotation& annotation, std::span<const Eigen::Vector3f> positions_m,
                               const SelectionView& view, const ScreenStroke& stroke, SplitPart part,
                               std::uint32_t given, const Executor& executor) {
  SACCADE_EXPECTS(positions_m.size() == annotation.labels().size());
  if (stroke.line.size() < 2) return no_split("a stroke across a label has two points at least");
  LabelSplit split;
  SACCADE_CHECK(view.validate());
  SACCADE_CHECK(validate(ScreenShape{stroke}));
  const StrokeRows rows{stroke.line, view.height};
  SACCADE_TRY(split.label, crossed_label(annotation, positions_m, view, stroke, rows, given, executor));
  if (split.label == kNoLabel) return no_split("nothing is selected: the stroke crosses no other label");
  DisjointSets joined{positions_m.size()};
  const std::vector<CutEdge> edges = cut(annotation, positions_m, view, rows, split.label, joined);
  std::map<std::uint32_t, std::pair<std::size_t, std::size_t>> ends;  // by part: cut edges that end there
  for (const CutEdge& edge : edges) {
    ++ends[joined.root(edge.right)].first;
    ++ends[joined.root(edge.left)].second;
  }
  std::size_t contrary{0};
  for (const auto& [root, of] : ends) contrary += std::min(of.first, of.second);
  const std::string name = "label " + std::to_string(split.label);
  const Error apart = no_split("the stroke does not part " + name + " in two: draw it from border to border");
  if (edges.empty() || static_cast<double>(contrary) > kMostContrary * static_cast<double>(edges.size())) return apart;
  std::vector<std::uint32_t> right;
  std::vector<std::uint32_t> left;
  for (std::uint32_t point = 0; point < positions_m.size(); ++point) {
    if (annotation.label_of(point) != split.label) continue;
    const auto found = ends.find(joined.root(point));
    if (found == ends.end()) continue;
    (found->second.first > found->second.second ? right : left).push_back(point);
  }
  if (right.empty() || left.empty()) return apart;
  const bool takes_right = (right.size() < left.size()) == (part == SplitPart::smaller);
  split.points = std::move(takes_right ? right : left);
  return split;
}

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#pragma once
// SegmentedScan: a simulated table after its initial scan, in segments; Judgement: what a saliency makes of them. For
// Figs. 3.8 and 3.9.

#include <optional>
#include <string>
#include <vector>

#include "reproduced_table.hpp"
#include "saccade/attention/saliency.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/core/progress.hpp"
#include "saccade/map/mesh.hpp"
#include "saccade/report/segment_picture.hpp"
#include "table_options.hpp"

namespace saccade::reproduce {

constexpr double kBetweenVertices_m{0.006};  // about a voxel

/// Kind of object that a segment belongs to.
enum class SegmentOf : std::uint8_t { object, support, scrap };

/// The table as the initial scan left it, in segments.
struct SegmentedScan {
  TriangleMesh mesh;
  Viewpoint view;
  std::vector<std::uint32_t> labels;
  SegmentedPoints points;
  std::vector<SegmentMeasures> measures;  ///< with the default B_th
  std::vector<SegmentOf> kinds;

  [[nodiscard]] DrawnSegments drawn() const {
    return {mesh.vertices, mesh.normals, labels, mesh.triangles, kBetweenVertices_m};
  }
  [[nodiscard]] std::size_t count(SegmentOf kind) const {
    return static_cast<std::size_t>(std::count(kinds.begin(), kinds.end(), kind));
  }
};

/// Scans and segments the table unless that was done. cancelled; errors of the simulation and of segmentation.
[[nodiscard]] Status carry_out_scan(const TableOptions& options, const Executor& executor, const Progress& progress,
                                    std::optional<SegmentedScan>& scan);

/// Segments as a saliency scores them.
struct Judgement {
  std::string name;
  std::vector<double> values;

  [[nodiscard]] double mean_of(const SegmentedScan& scan, SegmentOf kind) const {
    double sum{0.0};
    for (std::size_t s = 0; s < values.size(); ++s) sum += scan.kinds[s] == kind ? values[s] : 0.0;
    return sum / static_cast<double>(std::max<std::size_t>(1, scan.count(kind)));
  }
  /// Segments of objects that come before the first other one.
  [[nodiscard]] std::size_t objects_first(const SegmentedScan& scan) const {
    double most_other{0.0};
    for (std::size_t s = 0; s < values.size(); ++s) {
      if (scan.kinds[s] != SegmentOf::object) most_other = std::max(most_other, values[s]);
    }
    return count_objects(scan, [&](double value) { return value > most_other; });
  }
  [[nodiscard]] std::size_t objects_at_zero(const SegmentedScan& scan) const {
    return count_objects(scan, [](double value) { return value == 0.0; });
  }

 private:
  template <class Condition>
  [[nodiscard]] std::size_t count_objects(const SegmentedScan& scan, const Condition& condition) const {
    std::size_t count{0};
    for (std::size_t s = 0; s < values.size(); ++s) {
      count += scan.kinds[s] == SegmentOf::object && condition(values[s]) ? 1 : 0;
    }
    return count;
  }
};

[[nodiscard]] Judgement judge(const std::string& name, const SaliencyHeuristic& heuristic,
                              const MeasuredSegments& segments);
/// The rows and notes; the caption is the caller's.
[[nodiscard]] ReproducedTable table_of(const SegmentedScan& scan, const std::vector<Judgement>& judgements,
                                       const std::string& first_column);
[[nodiscard]] double most_of(const Judgement& judgement);
/// The segments, the more salient the brighter, on a scale up to `most`.
[[nodiscard]] Panel panel_of(const SegmentedScan& scan, const Judgement& judgement, double most,
                             const Executor& executor);
[[nodiscard]] std::string picture_note();

}  // namespace saccade::reproduce

// SPDX-License-Identifier: Apache-2.0
#include "tables/thesis_table.hpp"

#include <algorithm>
#include <array>

namespace saccade::cli {
namespace {

constexpr std::array kTables{
    ThesisTable{"2.1", "objects rebuilt with tracked poses and with the robot's, and the drift (takes minutes)",
                reproduce_table_2_1, false, true, true},
    ThesisTable{"2.2", "where hands acted, by GMM-AS, ZVC-like and ours: precision and recall (with --hands)",
                reproduce_table_2_2, true},
    ThesisTable{"2.3", "the same at a quarter to four times the speed (with --hands)", reproduce_table_2_3, true},
    ThesisTable{"2.4", "the same under noise of 0.1 to 5 cm (with --hands)", reproduce_table_2_4, true},
    ThesisTable{"2.5", "saliency of the Gaussians of a placement (with --hands)", reproduce_table_2_5, true},
    ThesisTable{"2.6", "saliency of the Gaussians of a pick-and-place task (with --hands)", reproduce_table_2_6, true},
    ThesisTable{"2.7", "error, completeness, views and time of updates after a user's task, in simulation",
                reproduce_table_2_7, false, false, true},
    ThesisTable{"2.8", "seconds of their phases", reproduce_table_2_8, false, false, true},
    ThesisTable{"2.9", "time to evaluate the views of a region: ours, PCL's octree, a fixed step (takes minutes)",
                reproduce_table_2_9},
    ThesisTable{"2.10", "what it costs to keep unknown and empty apart while the map moves", reproduce_table_2_10},
    ThesisTable{"3.1", "seconds of each phase of five views, attention and standard (takes minutes)",
                reproduce_table_3_1},
    ThesisTable{"3.2", "saliency and view poses of segments before the third view", reproduce_table_3_2},
    ThesisTable{"3.3", "which views point towards objects (takes minutes)", reproduce_table_3_3},
    ThesisTable{"3.4", "points and outliers that filters leave of a Kinect v2's depth images", reproduce_table_3_4},
    ThesisTable{"3.5", "good points that its filter of shadow points removes", reproduce_table_3_5, false, true},
    ThesisTable{"3.8", "figure: saliency of segments by roundness, by isolation, and by both", reproduce_figure_3_8,
                false, true},
    ThesisTable{"3.9", "figure: saliency for five distances of isolation", reproduce_figure_3_9, false, true},
    ThesisTable{"3.17", "figure: unknown voxels near the objects over five views (takes minutes)",
                reproduce_figure_3_17, false, true},
    ThesisTable{"4.1", "scenes of surfels: frames, points, labels (takes half an hour)", reproduce_table_4_1, false,
                false, true},
    ThesisTable{"4.2", "parameters of surfels and mode filter", reproduce_table_4_2},
    ThesisTable{"4.3", "errors of segmented surfels, with and without the mode filter (takes half an hour)",
                reproduce_table_4_3, false, false, true},
    ThesisTable{"fig-4.5", "figure: surfels of small tools, coloured and segmented (takes minutes)",
                reproduce_figure_4_5, false, true, true},
    ThesisTable{"fig-4.6", "figure: the same of the second workshop", reproduce_figure_4_6, false, true, true},
    ThesisTable{"fig-4.7", "figure: the same of magazines, by supervoxels and LCCP", reproduce_figure_4_7, false, true,
                true},
    ThesisTable{"fig-4.8", "figure: the same of magazines, by flood fill", reproduce_figure_4_8, false, true, true},
    ThesisTable{"fig-4.9", "figure: a panel and the wall behind it, with and without enhanced depth",
                reproduce_figure_4_9, false, true, true},
    ThesisTable{"4.10", "figure: boundary precision and recall of flood fill on surfels (takes half an hour)",
                reproduce_figure_4_10, false, true, true},
    ThesisTable{"4.11", "figure: the same of supervoxels and LCCP", reproduce_figure_4_11, false, true, true},
    ThesisTable{"4.gain", "ours: what automatic gain costs surfels, and its remedy (takes an hour)",
                reproduce_table_4_gain},
    ThesisTable{"4.4", "parameters of annotation", reproduce_table_4_4},
    ThesisTable{"4.5", "errors of annotation by control points and by rectangles, simulated (also with --clouds)",
                reproduce_table_4_5},
    ThesisTable{"4.6", "the same of the second scenario", reproduce_table_4_6},
    ThesisTable{"4.7", "what users thought of annotation (quoted)", reproduce_table_4_7},
    ThesisTable{"4.8", "milliseconds of the steps of annotation (also with --clouds)", reproduce_table_4_8},
};

/// Characters, not bytes, of UTF-8.
std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

void print_row(std::ostream& out, const std::vector<std::string>& cells, const std::vector<std::size_t>& widths) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    out << "| " << cells[i] << std::string(widths[i] - width_of(cells[i]) + 1, ' ');
  }
  out << "|\n";
}

}  // namespace

std::span<const ThesisTable> thesis_tables() { return kTables; }

const ThesisTable* find_thesis_table(std::string_view number) {
  const auto found =
      std::find_if(kTables.begin(), kTables.end(), [&](const ThesisTable& table) { return table.number == number; });
  return found == kTables.end() ? nullptr : &*found;
}

void print(std::ostream& out, const ReproducedTable& table) {
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    std::size_t width = width_of(table.columns[i]);
    for (const auto& row : table.rows) width = std::max(width, width_of(row[i]));
    widths.push_back(width);
  }
  out << table.caption << "\n\n";
  print_row(out, table.columns, widths);
  for (const std::size_t width : widths) out << '|' << std::string(width + 2, '-');
  out << "|\n";
  for (const auto& row : table.rows) print_row(out, row, widths);
  out << '\n';
  for (const std::string& note : table.notes) out << "- " << note << '\n';
}

}  // namespace saccade::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once
// ReproducedTable: a table of the thesis with our figures beside its own; thesis_tables: those that there are.
// A further table is a source of its own here, with a line in thesis_table.cpp.

#include <array>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/progress.hpp"
#include "saccade/core/result.hpp"
#include "saccade/sensor/image.hpp"

namespace saccade::cli {

struct AnnotationExperiments;
struct ExplorationExperiments;
struct SurfelExperiments;

struct ReproduceOptions {
  std::size_t poses{0};  ///< view poses that are evaluated, evenly spread; 0: all that the thesis has
  std::uint64_t seed{1};
  std::filesystem::path hands;   ///< folder of the thesis' recorded hands; see hand_data.hpp
  std::size_t noise_seeds{20};   ///< that noise on them is averaged over
  std::filesystem::path clouds;  ///< folder of labelled clouds for Tables 4.5, 4.6 and 4.8; empty: made ones
  int image_width_px{0};  ///< of the simulated camera of Tables 2.7, 2.8, 3.1 to 3.3 and of made clouds; 0: as it has
  std::size_t frames{0};  ///< of the beginning of the scan of Table 2.1, and of each scene of Table 4.1; 0: all
  std::string surfel_scene;    ///< the only one of Tables 4.1, 4.3, 4.gain and Figs. 4.10, 4.11; empty: all
  std::size_t placements{16};  ///< of the grid of SV-LCCP's seeds, for the same
  /// Without what is ours: the updates of Tables 2.7 and 2.8 (docs/update.md), and the mode filter of Tables 4.1, 4.3
  /// and their figures (decision 18).
  bool as_printed{false};
  /// Those of Tables 3.1 and 3.3 and Fig. 3.17, carried out by the first of them.
  mutable std::shared_ptr<const ExplorationExperiments> experiments{};
  mutable std::shared_ptr<const AnnotationExperiments> annotations{};  ///< the same of Tables 4.5 and 4.6
  mutable std::shared_ptr<SurfelExperiments> surfels{};                ///< of Tables 4.1 and 4.3 and Figs. 4.5 to 4.11
};

/// Files that tables' plots go to, all there are.
constexpr std::array<std::string_view, 17> kTablePlotFiles{
    "fig-2-12-translation.svg", "fig-2-12-rotation.svg",    "table-3-5.svg",
    "fig-3-17-tabletop-1.svg",  "fig-3-17-tabletop-2.svg",  "fig-3-17-tabletop-3.svg",
    "fig-3-17-tabletop-4.svg",  "fig-4-10-workshop-1.svg",  "fig-4-10-workshop-2.svg",
    "fig-4-10-desk.svg",        "fig-4-10-magazines-1.svg", "fig-4-10-magazines-2.svg",
    "fig-4-11-workshop-1.svg",  "fig-4-11-workshop-2.svg",  "fig-4-11-desk.svg",
    "fig-4-11-magazines-1.svg", "fig-4-11-magazines-2.svg"};
constexpr std::size_t kFirstSurfelPlot{7};  ///< of Fig. 4.10, a file per scene; then those of Fig. 4.11

struct TablePlot {
  std::string_view file;
  std::string svg;
};

/// The same of pictures.
constexpr std::array<std::string_view, 7> kTablePictureFiles{"fig-3-8.png", "fig-3-9.png", "fig-4-5.png", "fig-4-6.png",
                                                             "fig-4-7.png", "fig-4-8.png", "fig-4-9.png"};

struct TablePicture {
  std::string_view file;
  ColorImage image;
};

struct ReproducedTable {
  std::string caption;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> notes;  ///< what was done here, and what differs from the thesis
  nlohmann::json figures;
  std::vector<TablePlot> plots{};  ///< figures of the thesis that go with it
  std::vector<TablePicture> pictures{};
  bool complete{true};  ///< false: interrupted; rows are missing, and a note says which
};

/// A table of the thesis, by its number.
struct ThesisTable {
  std::string_view number;
  std::string_view title;
  Result<ReproducedTable> (*reproduce)(const ReproduceOptions&, const Executor&, const Progress&);
  bool needs_hands{false};  ///< ReproduceOptions::hands
  bool has_plots{false};    ///< or pictures
  bool has_printed{false};  ///< heeds ReproduceOptions::as_printed
};

/// In the thesis' order.
[[nodiscard]] std::span<const ThesisTable> thesis_tables();
/// nullptr: there is none.
[[nodiscard]] const ThesisTable* find_thesis_table(std::string_view number);

/// As Markdown: the caption, the table with aligned columns, and the notes as a list.
void print(std::ostream& out, const ReproducedTable& table);

[[nodiscard]] Result<ReproducedTable> reproduce_table_2_1(const ReproduceOptions& options, const Executor& executor,
                                                          const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_table_2_2(const ReproduceOptions& options, const Executor& executor,
                                                          const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_table_2_3(const ReproduceOptions& options, const Executor& executor,
                                                          const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_table_2_4(const ReproduceOptions& options, const Executor& executor,
                                                          const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_table_2_5(const ReproduceOptions& options, const Executor& executor,
                                                          const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_table_2_6(const ReproduceOptions& options, const Executor& executor,
                                                          const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_table_2_7(const ReproduceOptions& options, const Executor& executor,
                                                          const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_table_2_8(const ReproduceOptions& options, const Executor& executor,
                                                          const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_table_2_9(const ReproduceOptions& options, const Executor& executor,
                                                          const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_table_2_10(const ReproduceOptions& options, const Executor& executor,
                                                           const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_table_3_1(const ReproduceOptions& options, const Executor& executor,
                                                          const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_table_3_2(const ReproduceOptions& options, const Executor& executor,
                                                          const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_table_3_3(const ReproduceOptions& options, const Executor& executor,
                                                          const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_figure_3_17(const ReproduceOptions& options, const Executor& executor,
                                                            const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_table_3_4(const ReproduceOptions& options, const Executor& executor,
                                                          const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_table_3_5(const ReproduceOptions& options, const Executor& executor,
                                                          const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_figure_3_8(const ReproduceOptions& options, const Executor& executor,
                                                           const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_figure_3_9(const ReproduceOptions& options, const Executor& executor,
                                                           const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_table_4_1(const ReproduceOptions& options, const Executor& executor,
                                                          const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_table_4_2(const ReproduceOptions& options, const Executor& executor,
                                                          const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_table_4_3(const ReproduceOptions& options, const Executor& executor,
                                                          const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_figure_4_5(const ReproduceOptions& options, const Executor& executor,
                                                           const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_figure_4_6(const ReproduceOptions& options, const Executor& executor,
                                                           const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_figure_4_7(const ReproduceOptions& options, const Executor& executor,
                                                           const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_figure_4_8(const ReproduceOptions& options, const Executor& executor,
                                                           const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_figure_4_9(const ReproduceOptions& options, const Executor& executor,
                                                           const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_figure_4_10(const ReproduceOptions& options, const Executor& executor,
                                                            const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_figure_4_11(const ReproduceOptions& options, const Executor& executor,
                                                            const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_table_4_gain(const ReproduceOptions& options, const Executor& executor,
                                                             const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_table_4_4(const ReproduceOptions& options, const Executor& executor,
                                                          const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_table_4_5(const ReproduceOptions& options, const Executor& executor,
                                                          const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_table_4_6(const ReproduceOptions& options, const Executor& executor,
                                                          const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_table_4_7(const ReproduceOptions& options, const Executor& executor,
                                                          const Progress& progress);
[[nodiscard]] Result<ReproducedTable> reproduce_table_4_8(const ReproduceOptions& options, const Executor& executor,
                                                          const Progress& progress);

}  // namespace saccade::cli

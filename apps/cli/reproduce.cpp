// SPDX-License-Identifier: Apache-2.0
// saccade reproduce TABLE…: tables and figures of the thesis, ours beside theirs.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>

#include "add_value.hpp"
#include "command.hpp"
#include "exit_status.hpp"
#include "interrupt.hpp"
#include "json_output.hpp"
#include "options.hpp"
#include "progress_bar.hpp"
#include "run_folder.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/scene/rendered_sequence.hpp"
#include "tables/hand_data.hpp"
#include "tables/thesis_table.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

Result<int> list_tables(const GlobalOptions& global) {
  const Stopwatch clock;
  SACCADE_CHECK(check_json_output(global));
  json tables = json::array();
  for (const ThesisTable& table : thesis_tables()) {
    tables.push_back({{"table", table.number}, {"title", table.title}});
    if (!global.json_to_stdout()) std::cout << std::left << std::setw(8) << table.number << table.title << '\n';
  }
  SACCADE_CHECK(
      write_result("reproduce", global, global.executor(), {{"total", clock.elapsed_ms()}}, {{"known", tables}}));
  return static_cast<int>(ExitStatus::done);
}

json json_of(const std::string& number, const ReproducedTable& table) {
  json entry = table.figures;
  entry["table"] = number;
  entry["caption"] = table.caption;
  entry["notes"] = table.notes;
  entry["complete"] = table.complete;
  return entry;
}

struct PlotOptions {
  std::string folder;  ///< empty: no plots
  bool force{false};
};

constexpr std::string_view kMarkdownHeading{"# Tables of the thesis, ours beside theirs"};

/// Fails early where --markdown names a file that cannot be written, or one that is none of ours.
Status check_markdown_output(const fs::path& file) {
  if (file.empty()) return {};
  SACCADE_TRY(const AtomicFile probe, AtomicFile::create(file));
  std::ifstream existing{file};
  std::string line;
  if (std::getline(existing, line) && line != kMarkdownHeading) {
    return Error{Errc::invalid_argument, "holds something else than tables; name another file", file.string()};
  }
  return {};
}

Status write_markdown_output(const fs::path& file, const std::vector<ReproducedTable>& tables,
                             const GlobalOptions& global, const Executor& executor) {
  if (file.empty()) return {};
  std::ostringstream text;
  text << kMarkdownHeading << "\n\nBy `saccade reproduce`, version " << SACCADE_VERSION << ", seed " << global.seed
       << ", " << executor.threads() << (executor.threads() == 1 ? " thread.\n" : " threads.\n");
  for (const ReproducedTable& table : tables) {
    text << "\n## ";
    print(text, table);
  }
  return write_file_atomically(file, text.str());
}

/// Prints one table after the other as they are done. After a failure `tables` has those before it.
Status reproduce_each(const std::vector<std::string>& numbers, const ReproduceOptions& options,
                      const std::optional<RunFolder>& out, const GlobalOptions& global, const Executor& executor,
                      std::vector<ReproducedTable>& tables, TimingsMs& timings_ms) {
  ProgressBar bar{global.quiet};
  Progress progress{
      [&bar](std::string_view stage, std::size_t done, std::size_t total) { bar.update(stage, done, total); }};
  const CancelOnInterrupt cancel{progress};
  for (const std::string& number : numbers) {
    const Stopwatch of_table;
    const ThesisTable& entry = *find_thesis_table(number);
    SACCADE_TRY(ReproducedTable table, entry.reproduce(options, executor, progress));
    if (options.as_printed && !entry.has_printed) table.notes.emplace_back("--as-printed changes nothing here.");
    timings_ms["table " + number] = of_table.elapsed_ms();
    bar.finish();
    if (!global.json_to_stdout()) {
      if (!tables.empty()) std::cout << '\n';
      print(std::cout, table);
      std::cout << std::flush;
    }
    tables.push_back(std::move(table));
    for (const TablePlot& plot : tables.back().plots) {
      if (out) SACCADE_CHECK(write_file_atomically(*out / plot.file, plot.svg));
    }
    for (const TablePicture& picture : tables.back().pictures) {
      if (out) SACCADE_CHECK(write_png(*out / picture.file, picture.image));
    }
  }
  return {};
}

/// What can be said before the work.
Status check_reproduce(const std::vector<std::string>& numbers, const ReproduceOptions& options,
                       const fs::path& markdown, const GlobalOptions& global) {
  SACCADE_CHECK(check_json_output(global));
  SACCADE_CHECK(check_markdown_output(markdown));
  const bool needs_hands = std::any_of(
      numbers.begin(), numbers.end(), [](const std::string& number) { return find_thesis_table(number)->needs_hands; });
  return needs_hands ? check_hand_data(options.hands) : Status{};
}

Result<int> run_reproduce(const std::vector<std::string>& numbers, const ReproduceOptions& options,
                          const fs::path& markdown, const PlotOptions& plots, const GlobalOptions& global) {
  if (numbers.empty()) return list_tables(global);
  const Stopwatch clock;
  const Executor executor = global.executor();
  SACCADE_CHECK(check_reproduce(numbers, options, markdown, global));
  std::optional<RunFolder> out;
  if (!plots.folder.empty()) {
    std::vector<std::string_view> files(kTablePlotFiles.begin(), kTablePlotFiles.end());
    files.insert(files.end(), kTablePictureFiles.begin(), kTablePictureFiles.end());
    SACCADE_TRY(RunFolder opened, RunFolder::open(plots.folder, files, "", plots.force));
    out.emplace(std::move(opened));
  }
  TimingsMs timings_ms;
  std::vector<ReproducedTable> done;
  const Status status = reproduce_each(numbers, options, out, global, executor, done, timings_ms);
  if (done.empty()) return status.error();
  timings_ms["total"] = clock.elapsed_ms();
  json tables = json::array();
  for (std::size_t i = 0; i < done.size(); ++i) tables.push_back(json_of(numbers[i], done[i]));
  const Status markdown_status = write_markdown_output(markdown, done, global, executor);
  SACCADE_CHECK(write_result("reproduce", global, executor, timings_ms, {{"tables", std::move(tables)}}));
  if (!markdown_status) return markdown_status.error();
  const auto complete = std::count_if(done.begin(), done.end(), [](const auto& table) { return table.complete; });
  if (complete == std::ssize(numbers)) return static_cast<int>(ExitStatus::done);
  if (!status && status.error().code != Errc::cancelled) return status.error();
  std::string where = "on standard output";
  if (!global.json.empty() && !global.json_to_stdout()) where += ", in " + global.json;
  if (!markdown.empty()) where += ", in " + markdown.string();
  print_error("reproduce", "interrupted after " + std::to_string(complete) + " of " + std::to_string(numbers.size()) +
                               " tables; what is done is " + where);
  return interrupt_status();
}

/// Throws a usage error for a table that is not there, that is named twice, or that lacks its data.
void check_numbers(const std::vector<std::string>& numbers, const ReproduceOptions& options) {
  for (auto number = numbers.begin(); number != numbers.end(); ++number) {
    if (std::find(numbers.begin(), number, *number) != number) usage_error("TABLE", *number + " is named twice");
    if (const ThesisTable* table = find_thesis_table(*number)) {
      if (!table->needs_hands || !options.hands.empty()) continue;
      usage_error("--hands", "Table " + *number + " is made from recorded hands: get them from " + kHandDataAddress +
                                 ", and name their folder with --hands DIR");
    }
    usage_error("TABLE",
                "there is no table \"" + *number + "\"; known: " + joined(thesis_tables(), ", ", &ThesisTable::number));
  }
}

void check_markdown_option(const std::string& markdown, const std::vector<std::string>& numbers,
                           const GlobalOptions& global) {
  if (markdown.empty()) return;
  if (numbers.empty()) usage_error("--markdown", "name tables too");
  if (markdown == "-") usage_error("--markdown", "needs a file; what is on standard output is Markdown already");
  std::error_code ignored;
  if (fs::weakly_canonical(markdown, ignored) == fs::weakly_canonical(global.json, ignored)) {
    usage_error("--markdown", "needs another file than --json");
  }
}

void check_plots_option(const std::string& plots, const std::vector<std::string>& numbers) {
  const auto has_plots = [](const std::string& number) { return find_thesis_table(number)->has_plots; };
  if (plots.empty() || std::any_of(numbers.begin(), numbers.end(), has_plots)) return;
  std::string with_plots;
  for (const ThesisTable& table : thesis_tables()) {
    if (table.has_plots) with_plots += (with_plots.empty() ? "" : ", ") + std::string{table.number};
  }
  usage_error("--out", "is for plots and pictures, which these have: " + with_plots);
}

}  // namespace

void add_reproduce(CLI::App& program, const GlobalOptions& global, Action& action) {
  CLI::App* command = program.add_subcommand("reproduce", "tables of the thesis, ours beside theirs");
  auto numbers = std::make_shared<std::vector<std::string>>();
  auto options = std::make_shared<ReproduceOptions>();
  auto markdown = std::make_shared<std::string>();
  auto plots = std::make_shared<PlotOptions>();
  add_value(*command, "tables", *numbers, "TABLE",
            "tables, and figures, by their number (fig-4.5 where there is a table of that number too); none: lists "
            "those that there are");
  add_value(
      *command, "--poses", options->poses, "N",
      "evaluate only so many of the view poses of Table 2.9: quicker, but no longer what the thesis did (default: all)")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1000000}));
  add_value(*command, "--image-width", options->image_width_px, "PIXELS",
            "images of Tables 2.7, 2.8, 3.1 to 3.3, 4.1, 4.3, Figs. 3.17, 4.5 to 4.11 and of made clouds so many "
            "pixels wide: quicker, but no longer what the thesis did (default: 640, and 512 in chapter 3)")
      ->check(CLI::Range(16, 640));
  add_value(*command, "--hands", options->hands, "DIR",
            std::string{"Tables 2.2 to 2.6: folder of the thesis' recorded hands, from "} + kHandDataAddress);
  add_value(*command, "--clouds", options->clouds, "DIR",
            "Tables 4.5, 4.6 and 4.8: folder of clouds that hold labels or have files of labels beside them, such as "
            "mOSD (default: made ones)")
      ->check(CLI::ExistingDirectory);
  add_value(*command, "--noise-seeds", options->noise_seeds, "N",
            "Table 2.4: seeds of the noise that it is averaged over, from --seed on")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1000000}));
  add_value(*command, "--frames", options->frames, "N",
            "scan of Table 2.1: only so many of its first frames; scenes of Tables 4.1, 4.3 and Figs. 4.5 to 4.11: so "
            "many along the same way; for a quick look (default: all)")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1000000}));
  const auto take_scene = [options](const std::string& name) { options->surfel_scene = name; };
  add_words(*command, "--scene", kSurfelScenes, take_scene,
            "Tables 4.1, 4.3, 4.gain and Figs. 4.10, 4.11: this scene alone; all frames of one take minutes");
  add_value(*command, "--placements", options->placements, "N",
            "Tables 4.1, 4.3, 4.gain and Figs. 4.10, 4.11: SV-LCCP with the grid of seeds in so many places; its "
            "figures depend on them, and are taken together")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1000}));
  command->add_flag("--as-printed", options->as_printed,
                    "without what is ours: the updates of Tables 2.7 and 2.8 as the thesis prints them, and the mode "
                    "filter of Tables 4.1, 4.3 and Figs. 4.5 to 4.11");
  add_value(*command, "--out", plots->folder, "DIR",
            "folder for the plots of Tables 2.1 (Fig. 2.12) and 3.5 and of Figs. 3.17, 4.10, 4.11, and the pictures of "
            "Figs. 3.8, 3.9, 4.5 to 4.9");
  command->add_flag("--force", plots->force, "let --out write among other files");
  add_value(*command, "--markdown", *markdown, "FILE", "write the tables as Markdown to a file");
  command->callback([numbers, options, markdown, plots, &global, &action] {
    check_numbers(*numbers, *options);
    check_markdown_option(*markdown, *numbers, global);
    check_plots_option(plots->folder, *numbers);
    options->seed = global.seed;
    action = [numbers, options, markdown, plots, &global] {
      return run_reproduce(*numbers, *options, *markdown, *plots, global);
    };
  });
}

}  // namespace saccade::cli

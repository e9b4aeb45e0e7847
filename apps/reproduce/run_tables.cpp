// SPDX-License-Identifier: Apache-2.0
// Makes the tables one after the other: prints each as it is done, and writes JSON, Markdown, plots and pictures.
#include <algorithm>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <optional>
#include <sstream>

#include "estimate.hpp"
#include "exit_status.hpp"
#include "experiments/experiments.hpp"
#include "experiments/hand_data.hpp"
#include "interrupt.hpp"
#include "options.hpp"
#include "progress_bar.hpp"
#include "reproduce.hpp"
#include "run_folder.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "server/report_file.hpp"
#include "tables.hpp"
#include "text.hpp"

namespace saccade::reproduce {
namespace {

namespace fs = std::filesystem;
using cli::ExitStatus;
using cli::GlobalOptions;
using cli::ReproduceArguments;
using nlohmann::json;

constexpr const char* kTablesSchema{"saccade-tables/1"};
constexpr std::string_view kReportFile{"report.html"};
constexpr const char* kHandDataFolder{"hand-polhemus-dataset"};
constexpr std::string_view kMarkdownHeading{"# Tables of the thesis beside those of Saccade"};

Result<int> list_tables(const GlobalOptions& global) {
  const Stopwatch clock;
  SACCADE_CHECK(check_json_output(global));
  const Executor executor = global.executor();
  const double factor = machine_factor(executor);
  json tables = json::array();
  for (const TableEntry& table : thesis_tables()) {
    const double full_s = factor * table.cost.full_s;
    const double quick_s = factor * table.cost.quick_s;
    tables.push_back({{"table", table.number},
                      {"title", table.title},
                      {"seconds", full_s},
                      {"quick_seconds", quick_s},
                      {"draws", table.draws},
                      {"needs_hands", table.needs_hands}});
    if (global.json_to_stdout()) continue;
    std::cout << std::left << std::setw(9) << table.number << std::right << std::setw(10) << duration_text(full_s)
              << std::setw(7) << duration_text(quick_s) << "  " << table.title
              << (table.needs_hands ? " (with --hands)" : "") << '\n';
  }
  if (!global.json_to_stdout() && !global.quiet) {
    std::cerr << "Times: in full and with --quick, as expected on this machine. Tables of one experiment share it.\n";
  }
  SACCADE_CHECK(
      write_result("reproduce", global, executor, {{"total", clock.elapsed_ms()}}, {{"known", std::move(tables)}}));
  return static_cast<int>(ExitStatus::done);
}

json json_of(const TableEntry& entry, const ReproducedTable& table, bool quick) {
  json made = table.figures;
  made["table"] = entry.number;
  made["title"] = entry.title;
  made["caption"] = table.caption;
  made["columns"] = table.columns;
  made["cells"] = table.rows;
  made["notes"] = table.notes;
  made["complete"] = table.complete;
  made["quick"] = quick;
  json drawings = json::array();
  for (const TablePlot& plot : table.plots) drawings.push_back(plot.file);
  for (const TablePicture& picture : table.pictures) drawings.push_back(picture.file);
  made["drawings"] = std::move(drawings);
  return made;
}

/// Fails early where --markdown names a file that cannot be written, or a file of something else.
Status check_markdown_output(const fs::path& file) {
  if (file.empty()) return {};
  SACCADE_TRY(const AtomicFile probe, AtomicFile::create(file));
  std::ifstream existing{file};
  std::string line;
  if (std::getline(existing, line) && line != kMarkdownHeading) {
    return Error{Errc::invalid_argument, "holds something other than tables; name another file", file.string()};
  }
  return {};
}

/// The tables, and what belongs to all of them.
struct TableRun {
  const ReproduceArguments& arguments;
  const GlobalOptions& global;
  const Executor& executor;
  std::vector<const TableEntry*> entries;
  std::optional<cli::RunFolder> out;
  std::vector<ReproducedTable> done;
  cli::TimingsMs timings_ms;
};

Status write_markdown_output(const TableRun& run) {
  const fs::path& file = run.arguments.markdown;
  if (file.empty()) return {};
  std::ostringstream text;
  text << kMarkdownHeading << "\n\nBy `saccade reproduce`, version " << SACCADE_VERSION << ", seed " << run.global.seed
       << ", " << run.executor.threads() << (run.executor.threads() == 1 ? " thread.\n" : " threads.\n");
  for (const ReproducedTable& table : run.done) {
    text << "\n## ";
    print(text, table);
  }
  return write_file_atomically(file, text.str());
}

/// Returns the names of the plots, the pictures and the page that an earlier run left.
std::vector<std::string> results_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code failed;
  for (fs::directory_iterator entry{folder, failed}; !failed && entry != fs::directory_iterator{};
       entry.increment(failed)) {
    std::string name = entry->path().filename().string();
    const bool is_named = name.starts_with("fig-") || name.starts_with("table-");
    const bool is_drawing = is_named && (name.ends_with(".svg") || name.ends_with(".png"));
    if (is_drawing || name == kReportFile) names.push_back(std::move(name));
  }
  return names;
}

Status write_drawings(const cli::RunFolder& out, const ReproducedTable& table) {
  for (const TablePlot& plot : table.plots) SACCADE_CHECK(write_file_atomically(out / plot.file, plot.svg));
  for (const TablePicture& picture : table.pictures) SACCADE_CHECK(write_png(out / picture.file, picture.image));
  return {};
}

/// Writes all tables as a page, and says where it is.
Status write_report(const TableRun& run, const json& document) {
  const fs::path file = *run.out / kReportFile;
  SACCADE_CHECK(server::write_report(file, document));
  if (!run.global.quiet) std::cerr << "The tables as a page: " << file.string() << '\n';
  return {};
}

/// Whether less is made than the times of TableEntry are of, other than by --quick.
bool is_reduced(const TableOptions& options) {
  const TableOptions full = options.quick ? quick_options({}) : TableOptions{};
  return options.poses != full.poses || options.image_width_px != full.image_width_px ||
         options.noise_seeds != full.noise_seeds || options.frames != full.frames ||
         options.placements != full.placements || !options.surfel_scene.empty();
}

/// Says how long the tables take before they are begun.
void announce(const TableRun& run, const Estimate& estimate, cli::ProgressBar& bar) {
  constexpr double kWorthSaying_s{5.0};
  if (estimate.total_s() < kWorthSaying_s) return;
  std::string text = (run.entries.size() == 1 ? std::string{"One table, which takes "}
                                              : std::to_string(run.entries.size()) + " tables, which take ") +
                     "about " + duration_text(estimate.total_s()) + " on this machine";
  if (is_reduced(run.arguments.options)) text += " in full, and less with the options given";
  if (!run.arguments.options.quick) text += "; --quick takes about a minute a table";
  bar.note(text + ". Ctrl-C keeps the tables that are complete.");
}

/// Notes from time to time how long the rest takes.
class RemainingTime {
 public:
  RemainingTime(const Estimate& estimate, cli::ProgressBar& bar) : estimate_{estimate}, bar_{bar} {}

  void begin_table() { table_ = Stopwatch{}; }
  void tell() {
    constexpr double kEvery_s{60.0};
    if (since_told_.elapsed_ms() < 1e3 * kEvery_s) return;
    since_told_ = Stopwatch{};
    const double left_s = estimate_.left_s(1e-3 * table_.elapsed_ms());
    bar_.note(left_s > 0.0 ? "about " + duration_text(left_s) + " left" : "it takes longer than expected");
  }

 private:
  const Estimate& estimate_;
  cli::ProgressBar& bar_;
  Stopwatch table_;
  Stopwatch since_told_;
};

void mark_quick(ReproducedTable& table) {
  table.caption += " (quick)";
  table.notes.push_back(quick_note());
}

/// Makes one table, prints it, and draws its figures.
Status make_table(TableRun& run, const TableEntry& entry, Experiments& experiments, const Progress& progress,
                  cli::ProgressBar& bar) {
  const TableOptions& options = run.arguments.options;
  const Stopwatch clock;
  SACCADE_TRY(ReproducedTable table, entry.reproduce(options, experiments, run.executor, progress));
  if (options.as_printed && !entry.has_printed) table.notes.emplace_back("--as-printed changes nothing here.");
  if (options.quick) mark_quick(table);
  run.timings_ms["table " + std::string{entry.number}] = clock.elapsed_ms();
  bar.finish();
  if (!run.global.json_to_stdout()) {
    if (!run.done.empty()) std::cout << '\n';
    print(std::cout, table);
    std::cout << std::flush;
  }
  run.done.push_back(std::move(table));
  return run.out ? write_drawings(*run.out, run.done.back()) : Status{};
}

/// After a failure `run.done` has the tables before it.
Status make_tables(TableRun& run) {
  cli::ProgressBar bar{run.global.quiet};
  const double factor = run.global.quiet ? 1.0 : machine_factor(run.executor);
  Estimate estimate{run.entries, run.arguments.options.quick, factor};
  RemainingTime remaining{estimate, bar};
  const bool tells_rest = !is_reduced(run.arguments.options);
  Progress progress{[&](std::string_view stage, std::size_t done, std::size_t total) {
    bar.update(stage, done, total);
    if (tells_rest) remaining.tell();
  }};
  const cli::CancelOnInterrupt cancel{progress};
  announce(run, estimate, bar);
  Experiments experiments;
  for (std::size_t i = 0; i < run.entries.size(); ++i) {
    const Stopwatch clock;
    remaining.begin_table();
    SACCADE_CHECK(make_table(run, *run.entries[i], experiments, progress, bar));
    estimate.done(i, 1e-3 * clock.elapsed_ms());
  }
  return {};
}

/// Checks, before the work, everything that can be checked then.
Status check_run(const TableRun& run) {
  SACCADE_CHECK(check_json_output(run.global));
  SACCADE_CHECK(check_markdown_output(run.arguments.markdown));
  const bool needs_hands =
      std::any_of(run.entries.begin(), run.entries.end(), [](const TableEntry* table) { return table->needs_hands; });
  return needs_hands ? check_hand_data(run.arguments.options.hands) : Status{};
}

/// Says where those are that were done before an interruption.
int tell_interruption(const TableRun& run, std::ptrdiff_t complete) {
  std::string where = "on standard output";
  if (!run.global.json.empty() && !run.global.json_to_stdout()) where += ", in " + run.global.json;
  if (!run.arguments.markdown.empty()) where += ", in " + run.arguments.markdown.string();
  cli::print_error("reproduce", "interrupted after " + std::to_string(complete) + " of " +
                                    std::to_string(run.entries.size()) + " tables; what is done is " + where);
  return cli::interrupt_status();
}

Result<int> run_tables(const ReproduceArguments& arguments, const GlobalOptions& global) {
  const Stopwatch clock;
  const Executor executor = global.executor();
  TableRun run{arguments, global, executor, {}, {}, {}, {}};
  for (const std::string& number : arguments.numbers) run.entries.push_back(find_table(number));
  SACCADE_CHECK(check_run(run));
  if (!arguments.out.empty()) {
    const std::vector<std::string> own = results_in(arguments.out);
    const std::vector<std::string_view> files{own.begin(), own.end()};
    SACCADE_TRY(cli::RunFolder opened, cli::RunFolder::open(arguments.out, files, "", arguments.force));
    run.out.emplace(std::move(opened));
  }
  const Status status = make_tables(run);
  if (run.done.empty()) return status.error();
  run.timings_ms["total"] = clock.elapsed_ms();
  json tables = json::array();
  for (std::size_t i = 0; i < run.done.size(); ++i) {
    tables.push_back(json_of(*run.entries[i], run.done[i], arguments.options.quick));
  }
  const Status markdown = write_markdown_output(run);
  const json document =
      json_envelope("reproduce", global, executor, run.timings_ms,
                    {{"schema", kTablesSchema}, {"quick", arguments.options.quick}, {"tables", std::move(tables)}});
  if (run.out) SACCADE_CHECK(write_report(run, document));
  SACCADE_CHECK(write_json_output(global, document));
  if (!markdown) return markdown.error();
  const auto complete =
      std::count_if(run.done.begin(), run.done.end(), [](const auto& table) { return table.complete; });
  if (complete == std::ssize(run.entries)) return static_cast<int>(ExitStatus::done);
  if (!status && status.error().code != Errc::cancelled) return status.error();
  return tell_interruption(run, complete);
}

std::string known_numbers() { return joined(thesis_tables(), ", ", &TableEntry::number); }

/// Throws a usage error for a table that is not there, or that is named twice.
void check_numbers(const std::vector<std::string>& numbers) {
  std::vector<const TableEntry*> named;
  for (const std::string& number : numbers) {
    const TableEntry* table = find_table(number);
    if (table == nullptr) {
      cli::usage_error("TABLE", "there is no table \"" + number + "\"; known: " + known_numbers() +
                                    " (docs/thesis/paper-map.md says why others are not there)");
    }
    if (std::find(named.begin(), named.end(), table) != named.end()) {
      cli::usage_error("TABLE", number + " is named twice");
    }
    named.push_back(table);
  }
}

/// Takes the data set from where it was cloned to, if that is here.
void find_hands(ReproduceArguments& arguments) {
  fs::path& hands = arguments.options.hands;
  std::error_code ignored;
  if (hands.empty() && fs::is_directory(kHandDataFolder, ignored)) hands = kHandDataFolder;
  if (!hands.empty()) return;
  for (const std::string& number : arguments.numbers) {
    const TableEntry* table = find_table(number);
    if (!table->needs_hands) continue;
    cli::usage_error("--hands", "Table " + std::string{table->number} +
                                    " is made from recorded hands, which are not part of Saccade and not in ./" +
                                    kHandDataFolder + ": get them by git clone " + kHandDataAddress +
                                    ", and name their folder with --hands DIR");
  }
}

void check_markdown_option(const ReproduceArguments& arguments, const GlobalOptions& global) {
  const fs::path& markdown = arguments.markdown;
  if (markdown.empty()) return;
  if (arguments.numbers.empty()) cli::usage_error("--markdown", "name tables too");
  if (markdown == "-") cli::usage_error("--markdown", "needs a file; what is on standard output is Markdown already");
  std::error_code ignored;
  if (fs::weakly_canonical(markdown, ignored) == fs::weakly_canonical(global.json, ignored)) {
    cli::usage_error("--markdown", "needs another file than --json");
  }
}

}  // namespace
}  // namespace saccade::reproduce

namespace saccade::cli {

void check_reproduce(ReproduceArguments& arguments, const GlobalOptions& global) {
  using namespace reproduce;
  if (arguments.list && (arguments.all || !arguments.numbers.empty())) {
    usage_error("--list", "lists all tables; name none besides");
  }
  check_numbers(arguments.numbers);
  if (arguments.all) {
    if (!arguments.numbers.empty()) usage_error("--all", "makes all tables; name none besides");
    find_hands(arguments);
    for (const TableEntry& table : thesis_tables()) {
      if (!table.needs_hands || !arguments.options.hands.empty()) arguments.numbers.emplace_back(table.number);
    }
  }
  find_hands(arguments);
  check_markdown_option(arguments, global);
  if (!arguments.out.empty() && arguments.numbers.empty()) usage_error("--out", "name tables too");
  if (arguments.options.quick) arguments.options = quick_options(arguments.options);
  arguments.options.draws = !arguments.out.empty();
}

Result<int> run_reproduce(const ReproduceArguments& arguments, const GlobalOptions& global) {
  return arguments.numbers.empty() ? reproduce::list_tables(global) : reproduce::run_tables(arguments, global);
}

}  // namespace saccade::cli

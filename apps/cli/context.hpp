// SPDX-License-Identifier: Apache-2.0
#pragma once
// Context: what the scaffold hands to a command that runs: threads, seed, progress that ends with Ctrl-C, the folder of
// results, and the times of its phases.

#include <optional>
#include <string>

#include "command.hpp"
#include "declaration.hpp"
#include "interrupt.hpp"
#include "json_output.hpp"
#include "progress_bar.hpp"
#include "run_folder.hpp"
#include "saccade/core/clock.hpp"

namespace saccade::cli {

class Context {
 public:
  Context(const GlobalOptions& global, std::string result_name, const FolderRequest& folder);
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  [[nodiscard]] const GlobalOptions& global() const { return global_; }
  [[nodiscard]] const Executor& executor() const { return executor_; }
  [[nodiscard]] std::uint64_t seed() const { return global_.seed; }
  [[nodiscard]] bool quiet() const { return global_.quiet; }
  [[nodiscard]] ProgressBar& bar() { return bar_; }
  /// Shows a phase of the work. What the returned progress reports is shown under its name; Ctrl-C cancels it.
  Progress& stage(std::string name);
  [[nodiscard]] Progress& progress() { return progress_; }
  /// cancelled after Ctrl-C.
  [[nodiscard]] Status stop_if_interrupted() const;

  /// Notes the time since the last lap as that of a phase.
  void lap(const std::string& phase) { timings_ms_[phase] = since_lap_.lap_ms(); }

  /// The folder of --out; null where none was given, or before it is open.
  [[nodiscard]] const RunFolder* folder() const { return folder_ ? &*folder_ : nullptr; }
  [[nodiscard]] const std::filesystem::path& out() const { return request_.path; }
  [[nodiscard]] bool force() const { return request_.force; }
  /// Opens the folder of --out, where one was given. The scaffold does so before the work, unless the declaration says
  /// that the command does.
  /// @param marker  file by which an earlier run is known; empty: as it was declared
  [[nodiscard]] Status open_folder(std::string_view marker = {});

  /// The result in its envelope, with the times up to now, which stay those of the run from now on.
  [[nodiscard]] nlohmann::json document(nlohmann::json result);
  /// The result so far in its envelope, for files that a run writes while it goes on.
  [[nodiscard]] nlohmann::json document_so_far(nlohmann::json result) const;
  /// Writes document(result) to its file in the folder, before what may still fail or what it makes unnecessary: a
  /// page, the end of a journal. Otherwise the scaffold writes it after the command. io_failure.
  [[nodiscard]] Result<nlohmann::json> write_document(nlohmann::json result);
  [[nodiscard]] bool document_is_written() const { return document_is_written_; }

 private:
  const GlobalOptions& global_;
  std::string result_name_;
  const FolderRequest& request_;
  Executor executor_;
  ProgressBar bar_;
  std::string stage_;
  Progress progress_;
  CancelOnInterrupt cancel_;
  Stopwatch total_;
  Stopwatch since_lap_;
  TimingsMs timings_ms_;
  std::optional<RunFolder> folder_;
  bool document_is_written_{false};
};

}  // namespace saccade::cli

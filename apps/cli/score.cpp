// SPDX-License-Identifier: Apache-2.0
// saccade score: how well the labels of clouds match true ones, by overlap of segments and objects.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <map>
#include <memory>

#include "command.hpp"
#include "exit_status.hpp"
#include "interrupt.hpp"
#include "json_output.hpp"
#include "options.hpp"
#include "progress_bar.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/io/cloud_io.hpp"
#include "saccade/io/file_io.hpp"
#include "saccade/segment/overlap.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Labels of mOSD: 1–9 are parts of the table, ten labels from 20 on are parts of one object each.
constexpr std::uint32_t kLabelsPerObject{10};
constexpr std::uint32_t kFirstObjectOfTens{20};

struct ScoreOptions {
  std::vector<fs::path> paths;  ///< predicted, true, predicted, true…: clouds, or folders of them
  std::optional<std::uint32_t> objects_from;
  bool merge_tens{false};

  /// The least of the labels in the files that are objects.
  [[nodiscard]] std::uint32_t first_object() const {
    return objects_from.value_or(merge_tens ? kFirstObjectOfTens : 1);
  }
};

struct CloudPair {
  fs::path predicted;
  fs::path truth;
};

struct ScoredPair {
  CloudPair files;
  SegmentOverlap all;
  SegmentOverlap objects;
};

/// The clouds of a folder, by their names without extension.
Result<std::map<std::string, fs::path>> clouds_in(const fs::path& folder) {
  std::error_code code;
  std::map<std::string, fs::path> clouds;
  for (const fs::directory_entry& entry : fs::directory_iterator{folder, code}) {
    const fs::path extension = entry.path().extension();
    if (extension != ".pcd" && extension != ".ply") continue;
    const auto [before, is_new] = clouds.emplace(entry.path().stem().string(), entry.path());
    if (!is_new) {
      return Error{Errc::invalid_argument, "there are two clouds of this name, PCD and PLY",
                   (folder / before->first).string()};
    }
  }
  if (code) return Error{Errc::io_failure, "cannot be listed: " + code.message(), folder.string()};
  if (clouds.empty()) return Error{Errc::not_found, "there are no clouds (PCD, PLY) in this folder", folder.string()};
  return clouds;
}

Result<std::vector<CloudPair>> pairs_of_folders(const fs::path& predicted, const fs::path& truth) {
  SACCADE_TRY(const auto predicted_clouds, clouds_in(predicted));
  SACCADE_TRY(const auto true_clouds, clouds_in(truth));
  std::vector<CloudPair> pairs;
  for (const auto& [name, file] : predicted_clouds) {
    const auto found = true_clouds.find(name);
    if (found == true_clouds.end()) {
      return Error{Errc::not_found, "there is no cloud " + name + " in " + truth.string(), file.string()};
    }
    pairs.push_back({file, found->second});
  }
  for (const auto& [name, file] : true_clouds) {
    if (predicted_clouds.count(name) == 0) {
      return Error{Errc::not_found, "there is no cloud " + name + " in " + predicted.string(), file.string()};
    }
  }
  return pairs;
}

Result<std::vector<CloudPair>> pairs_of(const ScoreOptions& options) {
  std::error_code ignored;
  std::vector<CloudPair> pairs;
  for (std::size_t i = 0; i + 1 < options.paths.size(); i += 2) {
    const fs::path& predicted = options.paths[i];
    const fs::path& truth = options.paths[i + 1];
    if (fs::is_directory(predicted, ignored) && fs::is_directory(truth, ignored)) {
      SACCADE_TRY(const std::vector<CloudPair> found, pairs_of_folders(predicted, truth));
      pairs.insert(pairs.end(), found.begin(), found.end());
    } else {
      pairs.push_back({predicted, truth});
    }
  }
  return pairs;
}

Result<std::vector<std::uint32_t>> read_labels(const fs::path& path) {
  SACCADE_TRY(const CloudFile cloud, read_cloud(path));
  auto labels = labels_from_fields(cloud.fields());
  if (!labels) return in_file(labels.error(), path);
  return std::move(*labels);
}

/// One label per object: 1 for the table, the tens and one for the others, which keeps 10–19 apart from the table.
std::uint32_t merged(std::uint32_t label) { return label == kUnlabelled ? label : label / kLabelsPerObject + 1; }

Result<ScoredPair> score(const CloudPair& files, const ScoreOptions& options) {
  SACCADE_TRY(const std::vector<std::uint32_t> predicted, read_labels(files.predicted));
  SACCADE_TRY(std::vector<std::uint32_t> truth, read_labels(files.truth));
  if (predicted.size() != truth.size()) {
    return Error{Errc::size_mismatch,
                 "has " + std::to_string(predicted.size()) + " points, " + files.truth.string() + " has " +
                     std::to_string(truth.size()) + "; they must be the same points in the same order",
                 files.predicted.string()};
  }
  std::uint32_t first_object = options.first_object();
  if (options.merge_tens) {
    std::transform(truth.begin(), truth.end(), truth.begin(), merged);
    first_object = merged(first_object);
  }
  ScoredPair scored{files, {}, {}};
  SACCADE_TRY(scored.all, score_segments(predicted, truth));
  SACCADE_TRY(scored.objects, score_segments(predicted, truth, first_object));
  return scored;
}

/// Means over the clouds in which there is anything to score.
struct Means {
  std::size_t clouds{0}, clouds_with_objects{0};
  double fos{0.0}, fus{0.0}, wov{0.0}, wov_objects{0.0};

  explicit Means(const std::vector<ScoredPair>& pairs) {
    for (const ScoredPair& pair : pairs) {
      clouds += pair.all.objects > 0 ? 1 : 0;
      clouds_with_objects += pair.objects.objects > 0 ? 1 : 0;
      fos += pair.all.over_segmentation;
      fus += pair.all.under_segmentation;
      wov += pair.all.weighted_overlap;
      wov_objects += pair.objects.weighted_overlap;
    }
    for (double* sum : {&fos, &fus, &wov}) *sum /= std::max(1.0, static_cast<double>(clouds));
    wov_objects /= std::max(1.0, static_cast<double>(clouds_with_objects));
  }
};

json pair_json(const ScoredPair& pair) {
  const bool any = pair.all.objects > 0;
  return {{"predicted", pair.files.predicted.string()},
          {"truth", pair.files.truth.string()},
          {"points", pair.all.points},
          {"labels", pair.all.objects},
          {"objects", pair.objects.objects},
          {"fos", any ? json(pair.all.over_segmentation) : json(nullptr)},
          {"fus", any ? json(pair.all.under_segmentation) : json(nullptr)},
          {"wov", any ? json(pair.all.weighted_overlap) : json(nullptr)},
          {"wov_objects", pair.objects.objects > 0 ? json(pair.objects.weighted_overlap) : json(nullptr)}};
}

json score_json(const ScoreOptions& options, const std::vector<ScoredPair>& pairs) {
  const Means means{pairs};
  json clouds = json::array();
  for (const ScoredPair& pair : pairs) clouds.push_back(pair_json(pair));
  const auto value = [](double mean, std::size_t count) { return count > 0 ? json(mean) : json(nullptr); };
  return {{"fos", value(means.fos, means.clouds)},
          {"fus", value(means.fus, means.clouds)},
          {"wov", value(means.wov, means.clouds)},
          {"wov_objects", value(means.wov_objects, means.clouds_with_objects)},
          {"objects_from", options.first_object()},
          {"merge_tens", options.merge_tens},
          {"clouds", std::move(clouds)}};
}

void print_scores(const std::vector<ScoredPair>& pairs) {
  const Means means{pairs};
  std::cout << "WOv objects    WOv    F_os    F_us  cloud\n";
  const auto row = [](const SegmentOverlap& objects, const SegmentOverlap& all, const std::string& name) {
    const auto shown = [](double value, const SegmentOverlap& of) {
      return of.objects > 0 ? fixed(value, 3) : "    -";
    };
    std::cout << "      " << shown(objects.weighted_overlap, objects) << "  " << shown(all.weighted_overlap, all)
              << "   " << shown(all.over_segmentation, all) << "   " << shown(all.under_segmentation, all) << "  "
              << name << '\n';
  };
  for (const ScoredPair& pair : pairs) row(pair.objects, pair.all, pair.files.predicted.filename().string());
  if (pairs.size() > 1) {
    row({means.clouds_with_objects, 0, 0.0, 0.0, means.wov_objects}, {means.clouds, 0, means.fos, means.fus, means.wov},
        "mean of " + std::to_string(means.clouds) + " clouds");
  }
}

Result<int> run_score(const ScoreOptions& options, const GlobalOptions& global) {
  const Stopwatch clock;
  const Executor executor = global.executor();
  ProgressBar bar{global.quiet};
  SACCADE_CHECK(check_json_output(global));
  SACCADE_TRY(const std::vector<CloudPair> pairs, pairs_of(options));
  std::vector<ScoredPair> scored;
  for (const CloudPair& pair : pairs) {
    if (interrupted()) return Error{Errc::cancelled, "interrupted", {}};
    bar.update("scoring", scored.size(), pairs.size());
    SACCADE_TRY(ScoredPair found, score(pair, options));
    scored.push_back(std::move(found));
  }
  bar.finish();
  SACCADE_CHECK(write_json_output(
      global, json_envelope("score", global, executor, {{"total", clock.elapsed_ms()}}, score_json(options, scored))));
  if (Means{scored}.clouds == 0) {
    print_error("score", "no point has a true label above 0; there is nothing to score");
    return static_cast<int>(ExitStatus::no_result);
  }
  if (!global.json_to_stdout()) print_scores(scored);
  return static_cast<int>(ExitStatus::done);
}

void check_score_options(const ScoreOptions& options) {
  if (options.paths.size() % 2 != 0) {
    usage_error("PREDICTED TRUTH", "needs pairs: each predicted cloud is followed by its true one");
  }
  if (options.merge_tens && options.first_object() % kLabelsPerObject != 0) {
    usage_error("--objects-from", "must be a multiple of 10 with --merge-tens, which makes ten labels one object");
  }
}

}  // namespace

void add_score(CLI::App& program, const GlobalOptions& global, Action& action) {
  CLI::App* command = program.add_subcommand("score", "how well labels of clouds match true ones");
  auto options = std::make_shared<ScoreOptions>();
  command
      ->add_option("clouds", options->paths,
                   "clouds with a field label each, of the same points; two folders: the clouds of the same names")
      ->required()
      ->type_name("PREDICTED TRUTH...");
  command
      ->add_option("--objects-from", options->objects_from,
                   "of the true labels these and larger ones are objects (default: 1, all; 20 with --merge-tens)")
      ->check(CLI::Range(std::uint32_t{1}, kUnlabelled - 1))
      ->type_name("LABEL");
  command->add_flag("--merge-tens", options->merge_tens,
                    "the true labels are mOSD's: 1 to 9 are the table, each ten from 20 on are parts of one object");
  command->callback([options, &global, &action] {
    check_score_options(*options);
    action = [options, &global] { return run_score(*options, global); };
  });
}

}  // namespace saccade::cli

// SPDX-License-Identifier: Apache-2.0
// saccade score: how well the labels of clouds match true ones, by overlap of segments and objects, by boundaries, and
// by BCE.
#include <algorithm>
#include <map>
#include <sstream>

#include "context.hpp"
#include "saccade/io/clouds/cloud_io.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/segment/overlap.hpp"
#include "score_json.hpp"
#include "summary.hpp"
#include "surfel_input.hpp"

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
  TruthOptions truth;

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
  std::optional<SegmentationScore> surfels;  ///< where the truth has places
  std::optional<double> bce;                 ///< where it has labels
  std::size_t true_segments{0};              ///< after they were split, if they were
};

/// The clouds of a folder, by their names without extension.
Result<std::map<std::string, fs::path>> clouds_in(const fs::path& folder) {
  std::error_code code;
  std::map<std::string, fs::path> clouds;
  for (const fs::directory_entry& entry : fs::directory_iterator{folder, code}) {
    const fs::path extension = entry.path().extension();
    if (extension != ".pcd" && extension != ".ply") continue;
    if (entry.path().filename().string().front() == '.') continue;  // hidden: what other systems leave behind
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

struct LabelledFile {
  CloudFile cloud;
  std::vector<std::uint32_t> labels;
};

Result<LabelledFile> read_labelled(const fs::path& path) {
  SACCADE_TRY(CloudFile cloud, read_cloud(path));
  auto labels = labels_from_fields(cloud.fields());
  if (!labels) return in_file(labels.error(), path);
  return LabelledFile{std::move(cloud), std::move(*labels)};
}

bool has_places(const ColumnTable& fields) {
  return fields.find("x") != nullptr && fields.find("y") != nullptr && fields.find("z") != nullptr;
}

/// Boundaries and BCE. Without places, or where these are too far apart, there is only BCE, of the truth as it is.
Status score_surfels(const ColumnTable& fields, std::span<const std::uint32_t> predicted,
                     std::span<const std::uint32_t> truth, const TruthOptions& options, const Executor& executor,
                     ProgressBar& bar, ScoredPair& scored) {
  SACCADE_TRY(const ConsistencyError error, consistency_error(predicted, truth));
  if (error.points == 0) return {};
  scored.bce = error.bidirectional;
  scored.true_segments = scored.all.objects;
  if (!has_places(fields)) return {};
  const auto surfels = surfel_truth(fields, truth, options, executor);
  if (!surfels) {
    bar.note(scored.files.truth.string() + ": boundaries are not scored: " + surfels.error().to_string());
    return {};
  }
  if (surfels->points() == 0) return {};
  SACCADE_TRY(scored.surfels, surfels->score(predicted, executor));
  scored.bce = scored.surfels->bce;
  scored.true_segments = surfels->segments();
  return {};
}

/// One label per object: 1 for the table, the tens and one for the others, which keeps 10–19 apart from the table.
std::uint32_t merged(std::uint32_t label) { return label == kUnlabelled ? label : label / kLabelsPerObject + 1; }

Result<ScoredPair> score(const CloudPair& files, const ScoreOptions& options, const Executor& executor,
                         ProgressBar& bar) {
  SACCADE_TRY(const LabelledFile predicted_file, read_labelled(files.predicted));
  SACCADE_TRY(const LabelledFile truth_file, read_labelled(files.truth));
  const std::vector<std::uint32_t>& predicted = predicted_file.labels;
  std::vector<std::uint32_t> truth = truth_file.labels;
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
  ScoredPair scored{files, {}, {}, {}, {}, 0};
  SACCADE_TRY(scored.all, score_segments(predicted, truth));
  SACCADE_TRY(scored.objects, score_segments(predicted, truth, first_object));
  SACCADE_CHECK(score_surfels(truth_file.cloud.fields(), predicted, truth, options.truth, executor, bar, scored));
  return scored;
}

/// Mean of the numbers that are known.
class Mean {
 public:
  void add(const std::optional<double>& number) {
    sum_ += number.value_or(0.0);
    count_ += number ? 1 : 0;
  }
  [[nodiscard]] std::optional<double> value() const {
    return count_ == 0 ? std::nullopt : std::optional<double>{sum_ / static_cast<double>(count_)};
  }

 private:
  double sum_{0.0};
  std::size_t count_{0};
};

/// Scores of one cloud, or means over the clouds in which there is anything to score.
struct Figures {
  std::optional<double> fos, fus, wov, wov_objects, precision, recall, f, bce;

  explicit Figures(const ScoredPair& pair) : bce{pair.bce} {
    if (pair.all.objects > 0) {
      fos = pair.all.over_segmentation;
      fus = pair.all.under_segmentation;
      wov = pair.all.weighted_overlap;
    }
    if (pair.objects.objects > 0) wov_objects = pair.objects.weighted_overlap;
    if (!pair.surfels) return;
    precision = pair.surfels->precision();
    recall = pair.surfels->recall();
    f = pair.surfels->f();
  }
  explicit Figures(const std::vector<ScoredPair>& pairs) {
    for (const auto figure : {&Figures::fos, &Figures::fus, &Figures::wov, &Figures::wov_objects, &Figures::precision,
                              &Figures::recall, &Figures::f, &Figures::bce}) {
      Mean mean;
      for (const ScoredPair& pair : pairs) mean.add(Figures{pair}.*figure);
      this->*figure = mean.value();
    }
  }
};

json figures_json(const Figures& figures) {
  return {{"fos", optional_json(figures.fos)},
          {"fus", optional_json(figures.fus)},
          {"wov", optional_json(figures.wov)},
          {"wov_objects", optional_json(figures.wov_objects)},
          {"boundary_precision", optional_json(figures.precision)},
          {"boundary_recall", optional_json(figures.recall)},
          {"boundary_f", optional_json(figures.f)},
          {"bce", optional_json(figures.bce)}};
}

json pair_json(const ScoredPair& pair, const ScoreOptions& options) {
  json made = figures_json(Figures{pair});
  if (pair.surfels) made.update(score_json(*pair.surfels));
  made.update({{"predicted", pair.files.predicted.string()},
               {"truth", pair.files.truth.string()},
               {"points", pair.all.points},
               {"labels", pair.all.objects},
               {"objects", pair.objects.objects},
               {"true_segments", pair.true_segments},
               {"split", pair.surfels.has_value() && options.truth.config.split}});
  return made;
}

json scores_json(const ScoreOptions& options, const std::vector<ScoredPair>& pairs) {
  json clouds = json::array();
  for (const ScoredPair& pair : pairs) clouds.push_back(pair_json(pair, options));
  json made = figures_json(Figures{pairs});
  made.update({{"objects_from", options.first_object()},
               {"merge_tens", options.merge_tens},
               {"tolerance_m", options.truth.config.matching.tolerance_m},
               {"clouds", std::move(clouds)}});
  return made;
}

std::string table_of(const std::vector<ScoredPair>& pairs) {
  std::ostringstream text;
  text << "WOv objects    WOv    F_os    F_us  boundary P       R       F     BCE  cloud\n";
  const auto row = [&text](const Figures& figures, const std::string& name) {
    text << "      " << fixed_or_dash(figures.wov_objects) << "  " << fixed_or_dash(figures.wov) << "   "
         << fixed_or_dash(figures.fos) << "   " << fixed_or_dash(figures.fus) << "       "
         << fixed_or_dash(figures.precision) << "   " << fixed_or_dash(figures.recall) << "   "
         << fixed_or_dash(figures.f) << "   " << fixed_or_dash(figures.bce) << "  " << name << '\n';
  };
  for (const ScoredPair& pair : pairs) row(Figures{pair}, pair.files.predicted.filename().string());
  const auto scored = std::count_if(pairs.begin(), pairs.end(), [](const auto& pair) { return pair.all.objects > 0; });
  if (pairs.size() > 1) row(Figures{pairs}, "mean of " + std::to_string(scored) + " clouds");
  return text.str();
}

class Score final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override { return {"score", "scores labels of clouds against true ones"}; }

  void declare(Options& options) override {
    options
        .value("clouds", score_.paths, "PREDICTED TRUTH...",
               "clouds with a field label each, of the same points; two folders: the clouds of the same names")
        .required();
    options
        .value("--objects-from", score_.objects_from, "LABEL",
               "smallest true label of an object (default: 1; 20 with --merge-tens)")
        .range(std::uint32_t{1}, kUnlabelled - 1);
    options.flag("--merge-tens", score_.merge_tens,
                 "the true labels are mOSD's: 1 to 9 are the table, each ten from 20 on are parts of one object");
    add_truth_options(options.group(), score_.truth);
    options.value(
        "--radius", score_.truth.radius_m, "METRES",
        "radius of all surfels, metres (default: the cloud's field radius, else from the distance to neighbours)");
  }

  void check(const GlobalOptions& /*global*/) override {
    if (score_.paths.size() % 2 != 0) {
      usage_error("PREDICTED TRUTH", "needs pairs: each predicted cloud is followed by its true one");
    }
    if (score_.merge_tens && score_.first_object() % kLabelsPerObject != 0) {
      usage_error("--objects-from", "must be a multiple of 10 with --merge-tens, which makes ten labels one object");
    }
    check_truth_options(score_.truth);
  }

  [[nodiscard]] Result<Outcome> run(Context& context) override {
    SACCADE_TRY(const std::vector<CloudPair> pairs, pairs_of(score_));
    std::vector<ScoredPair> scored;
    for (const CloudPair& pair : pairs) {
      SACCADE_CHECK(context.stop_if_interrupted());
      context.bar().update("scoring", scored.size(), pairs.size());
      SACCADE_TRY(ScoredPair found, score(pair, score_, context.executor(), context.bar()));
      scored.push_back(std::move(found));
    }
    json result = scores_json(score_, scored);
    if (!Figures{scored}.wov) {
      return Outcome{.result = std::move(result),
                     .empty = "no point has a true label above 0; there is nothing to score"};
    }
    return Outcome{.result = std::move(result), .text = table_of(scored)};
  }

 private:
  ScoreOptions score_;
};

}  // namespace

void add_score(CLI::App& program, const GlobalOptions& global, Action& action) {
  add_command<Score>(program, global, action);
}

}  // namespace saccade::cli

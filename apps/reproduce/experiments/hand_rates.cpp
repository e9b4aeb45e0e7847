// SPDX-License-Identifier: Apache-2.0
#include "experiments/hand_rates.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <set>
#include <utility>

#include "attend_methods.hpp"
#include "text.hpp"

namespace saccade::reproduce {
namespace {

using nlohmann::json;

constexpr long kNearTenths{30};       ///< figures that differ by more tenths of a point are named in a note
constexpr std::size_t kFewFound{30};  ///< a precision of fewer points of interest says nothing
constexpr std::size_t kMostUsers{4};
constexpr std::size_t kThesisTrajectories{330};

using HandFilter = std::function<bool(const RecordedHand&)>;

/// The recorded hands and what belongs to all rows.
struct RatedHands {
  std::vector<RecordedHand> hands;
  std::vector<std::string> users;  ///< two to four, where the figures of each are worth showing; otherwise none
  std::uint64_t first_seed{1};
  std::size_t noise_seeds{1};

  [[nodiscard]] std::size_t seeds(const HandRatesRow& row) const { return row.sigma_m > 0.0 ? noise_seeds : 1; }
};

/// Counts of one row, per hand, summed over seeds; those of hands that the row leaves out are empty.
using HandCounts = std::vector<DetectionCounts>;

std::vector<std::string> users_of(const std::vector<RecordedHand>& hands) {
  std::set<std::string> users;
  for (const RecordedHand& hand : hands) users.insert(hand.user);
  if (users.size() < 2 || users.size() > kMostUsers) return {};
  return {users.begin(), users.end()};
}

HandActionDetector detector_of(const HandAlgorithm& algorithm) {
  const cli::AttendMethod* method = cli::find_attend_method(algorithm.method);
  SACCADE_EXPECTS(method != nullptr);
  return [detect =
              method->make(algorithm.as_printed)](const HandTrajectory& trajectory) -> Result<std::vector<HandAction>> {
    SACCADE_TRY(AttentionFindings findings, detect(trajectory));
    return std::move(findings.actions);
  };
}

/// One seed of one row.
Status count_detections(const RatedHands& rated, const HandRatesRow& row, std::uint64_t seed, const Executor& executor,
                        const Progress& progress, HandCounts& counts) {
  const HandActionDetector detector = detector_of(row.algorithm);
  std::vector<Status> statuses(rated.hands.size());
  executor.parallel_for(rated.hands.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const RecordedHand& hand = rated.hands[i];
      if (progress.cancelled() || hand.tasks != row.tasks.value_or(hand.tasks)) continue;
      const EvaluationConditions conditions{.speed = row.speed, .sigma_m = row.sigma_m, .seed = seed, .first_index = i};
      const auto evaluation = evaluate_detector(detector, {&hand.labelled, 1}, conditions);
      if (evaluation) {
        counts[i] += evaluation->counts;
      } else {
        statuses[i] = evaluation.error();
      }
    }
  });
  if (progress.cancelled()) return Error{Errc::cancelled, "cancelled", "detecting hand actions"};
  for (const Status& status : statuses) SACCADE_CHECK(status);
  return {};
}

Result<std::vector<HandCounts>> count_rows(const RatedHands& rated, const std::vector<HandRatesRow>& rows,
                                           const Executor& executor, const Progress& progress) {
  std::size_t total{0};
  std::size_t done{0};
  for (const HandRatesRow& row : rows) total += rated.seeds(row);
  std::vector<HandCounts> counts(rows.size(), HandCounts(rated.hands.size()));
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t s = 0; s < rated.seeds(rows[r]); ++s) {
      progress.report("detecting hand actions", done++, total);
      SACCADE_CHECK(count_detections(rated, rows[r], rated.first_seed + s, executor, progress, counts[r]));
    }
  }
  return counts;
}

DetectionCounts sum_of(const RatedHands& rated, const HandCounts& counts, const HandFilter& takes) {
  DetectionCounts sum;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (takes(rated.hands[i])) sum += counts[i];
  }
  return sum;
}

bool every(const RecordedHand& /*hand*/) { return true; }
bool sound(const RecordedHand& hand) { return hand.is_sound; }
HandFilter of_user(const std::string& user) {
  return [user](const RecordedHand& hand) { return hand.user == user; };
}

std::string percent_text(const std::optional<double>& share) { return share ? fixed(100.0 * *share, 1) : "none"; }

std::string rates_text(const DetectionCounts& counts) {
  return percent_text(counts.precision()) + " / " + percent_text(counts.recall());
}

/// Tenths of a point between the figures as they are shown.
long tenths_above(double share, double thesis) { return std::lround(1000.0 * share) - std::lround(10.0 * thesis); }

std::string difference_text(const std::optional<double>& share, double thesis) {
  if (!share) return "none";
  const long tenths = tenths_above(*share, thesis);
  return (tenths > 0 ? "+" : tenths < 0 ? "−" : "") + fixed(0.1 * static_cast<double>(std::abs(tenths)), 1);
}

std::vector<std::string> cells_of(const RatedHands& rated, const HandRatesRow& row, const HandCounts& counts) {
  const DetectionCounts here = sum_of(rated, counts, every);
  std::vector<std::string> cells{row.condition,
                                 std::string{row.algorithm.name} + (row.algorithm.as_printed ? ", as printed" : "")};
  if (row.thesis) {
    cells.push_back(fixed(row.thesis->precision, 1) + " / " + fixed(row.thesis->recall, 1));
    cells.push_back(rates_text(here));
    cells.push_back(difference_text(here.precision(), row.thesis->precision) + " / " +
                    difference_text(here.recall(), row.thesis->recall));
  } else {
    cells.insert(cells.end(), {"–", rates_text(here), "–"});
  }
  for (const std::string& user : rated.users) cells.push_back(rates_text(sum_of(rated, counts, of_user(user))));
  cells.push_back(rates_text(sum_of(rated, counts, sound)));
  return cells;
}

json json_of(const DetectionCounts& counts) {
  return {{"ground_truth", counts.labels},
          {"true_positives", counts.true_positives},
          {"false_positives", counts.false_positives},
          {"precision", optional_json(counts.precision())},
          {"recall", optional_json(counts.recall())}};
}

json difference_json(const std::optional<double>& share, double thesis) {
  return share ? json(100.0 * *share - thesis) : json(nullptr);
}

json json_of(const RatedHands& rated, const HandRatesRow& row, const HandCounts& counts) {
  const DetectionCounts here = sum_of(rated, counts, every);
  json figures = row.conditions;
  figures["algorithm"] = row.algorithm.name;
  figures["as_printed"] = row.algorithm.as_printed;
  figures["here"] = json_of(here);
  figures["sound"] = json_of(sum_of(rated, counts, sound));
  figures["users"] = json::object();
  for (const std::string& user : rated.users) figures["users"][user] = json_of(sum_of(rated, counts, of_user(user)));
  figures["seeds"] = rated.seeds(row);
  figures["thesis"] = nullptr;
  figures["difference_points"] = nullptr;
  if (row.thesis) {
    figures["thesis"] = {{"precision", row.thesis->precision / 100.0}, {"recall", row.thesis->recall / 100.0}};
    figures["difference_points"] = {{"precision", difference_json(here.precision(), row.thesis->precision)},
                                    {"recall", difference_json(here.recall(), row.thesis->recall)}};
  }
  return figures;
}

/// Labels, and how many of them are farther than 0.2 m from every sample.
struct LabelCount {
  std::size_t labels{0};
  std::size_t unreachable{0};
  std::size_t trajectories{0};
  std::size_t unsound{0};

  [[nodiscard]] std::optional<double> recall_ceiling() const {
    if (labels == 0) return std::nullopt;
    return static_cast<double>(labels - unreachable) / static_cast<double>(labels);
  }
};

LabelCount count_labels(const std::vector<RecordedHand>& hands, std::optional<HandTasks> tasks = std::nullopt) {
  LabelCount count;
  for (const RecordedHand& hand : hands) {
    if (hand.tasks != tasks.value_or(hand.tasks)) continue;
    ++count.trajectories;
    count.labels += hand.labelled.labels_m.size();
    if (hand.is_sound) continue;
    ++count.unsound;
    for (const Eigen::Vector3d& label : hand.labelled.labels_m) {
      count.unreachable += is_mislabelled({{}, hand.labelled.trajectory, {label}}) ? 1 : 0;
    }
  }
  return count;
}

std::string labels_note(const RatedHands& rated, const LabelCount& count) {
  std::string users;
  for (const std::string& user : rated.users) users += (users.empty() ? ", of " : " and ") + user;
  std::string note = "Here: " + std::to_string(count.trajectories) + " trajectories with " +
                     std::to_string(count.labels) + " labels" + users +
                     "; the thesis: " + std::to_string(kThesisTrajectories) + " of four users. ";
  if (count.unreachable == 0) return note + "No label is farther than 20 cm from every sample.";
  const double placements =
      count_labels(rated.hands, HandTasks::placements_and_removals).recall_ceiling().value_or(0.0);
  const double pick_and_place = count_labels(rated.hands, HandTasks::pick_and_place).recall_ceiling().value_or(0.0);
  return note + std::to_string(count.unreachable) + " labels, in " + std::to_string(count.unsound) +
         " trajectories, are farther than 20 cm from every sample. They bound recall by " +
         percent_text(count.recall_ceiling()) + " % (placements and removals: " + percent_text(placements) +
         ", pick-and-place: " + percent_text(pick_and_place) +
         "), and what is found in their place counts as false. “Sound” leaves these trajectories out.";
}

using Figure = std::optional<double> (DetectionCounts::*)() const;

/// Explains from the data why a figure is far from the thesis'; empty where the data do not explain it.
std::string reason_text(const RatedHands& rated, const HandCounts& counts, Figure figure, double thesis) {
  const DetectionCounts here = sum_of(rated, counts, every);
  const std::size_t found = here.true_positives + here.false_positives;
  if (figure == &DetectionCounts::precision && found < kFewFound) return std::to_string(found) + " found in all";
  std::vector<double> of_users;
  std::string users;
  for (const std::string& user : rated.users) {
    const std::optional<double> share = (sum_of(rated, counts, of_user(user)).*figure)();
    if (share) of_users.push_back(100.0 * *share);
    users += (users.empty() ? "" : ", ") + user + ": " + percent_text(share);
  }
  const auto [least, most] = std::minmax_element(of_users.begin(), of_users.end());
  if (!of_users.empty() && *least <= thesis && thesis <= *most) return "between the users' own, " + users;
  const std::optional<double> among_sound = (sum_of(rated, counts, sound).*figure)();
  const bool here_is_less = 100.0 * (here.*figure)().value_or(0.0) < thesis;
  if (here_is_less && among_sound && tenths_above(*among_sound, thesis) >= -kNearTenths) {
    return percent_text(among_sound) + " where labels are sound";
  }
  return users;
}

/// ", GMM-AS: recall 80.4, not 86.1 (reason)" where it is not near the thesis' figure.
std::string text_if_far(const RatedHands& rated, const HandRatesRow& row, const HandCounts& counts, const char* what,
                        Figure figure, double thesis) {
  const std::optional<double> here = (sum_of(rated, counts, every).*figure)();
  if (here && std::abs(tenths_above(*here, thesis)) <= kNearTenths) return {};
  const std::string reason = reason_text(rated, counts, figure, thesis);
  return ", " + std::string{row.algorithm.name} + ": " + what + " " + percent_text(here) + ", not " + fixed(thesis, 1) +
         (reason.empty() ? "" : " (" + reason + ")");
}

std::string differences_note(const RatedHands& rated, const HandRatesSpec& spec,
                             const std::vector<HandCounts>& counts) {
  std::string far;
  for (std::size_t r = 0; r < spec.rows.size(); ++r) {
    const HandRatesRow& row = spec.rows[r];
    if (!row.thesis || row.algorithm.as_printed) continue;
    for (const std::string& text :
         {text_if_far(rated, row, counts[r], "precision", &DetectionCounts::precision, row.thesis->precision),
          text_if_far(rated, row, counts[r], "recall", &DetectionCounts::recall, row.thesis->recall)}) {
      if (!text.empty()) far += (far.empty() ? "" : "; ") + spec.condition + " " + row.condition + text;
    }
  }
  if (far.empty()) return "All figures of GMM-AS and ZVC-like are within 3 points of the thesis'.";
  return "Farther than 3 points from the thesis: " + far + ". See docs/design/attention.md.";
}

}  // namespace

void add_rows(std::vector<HandRatesRow>& rows, HandRatesRow row, const thesis::Rates& zvc, const thesis::Rates& gmm) {
  row.algorithm = kZvcLike;
  row.thesis = zvc;
  rows.push_back(row);
  row.algorithm = kGmmAs;
  row.thesis = gmm;
  rows.push_back(row);
  row.algorithm = kOurDetector;
  row.thesis = std::nullopt;
  rows.push_back(std::move(row));
}

Result<ReproducedTable> hand_rates_table(HandRatesSpec spec, const TableOptions& options, const Executor& executor,
                                         const Progress& progress) {
  RatedHands rated;
  SACCADE_TRY(rated.hands, read_hand_data(options.hands));
  rated.users = users_of(rated.hands);
  rated.first_seed = options.seed;
  rated.noise_seeds = options.noise_seeds;
  SACCADE_TRY(const std::vector<HandCounts> counts, count_rows(rated, spec.rows, executor, progress));

  ReproducedTable table;
  table.caption = std::move(spec.caption);
  table.columns = {spec.condition, "algorithm", "thesis", "here", "difference"};
  table.columns.insert(table.columns.end(), rated.users.begin(), rated.users.end());
  table.columns.push_back("sound");
  json rows = json::array();
  for (std::size_t r = 0; r < spec.rows.size(); ++r) {
    table.rows.push_back(cells_of(rated, spec.rows[r], counts[r]));
    rows.push_back(json_of(rated, spec.rows[r], counts[r]));
  }
  const LabelCount labels = count_labels(rated.hands);
  table.notes = {
      "Precision / recall in %, and their differences in points. A label is found with a point of interest within 20 "
      "cm; "
      "a point farther than 20 cm from every label is false. Precision: found / (found + false).",
      labels_note(rated, labels),
      "GMM-AS has the denominator of eq. 2.13 cubed and POITh = 2.2; ZVC-like has ZVCTh = 1.385, the ends of its "
      "filter "
      "repeated, and nothing found at the ends: so the thesis' figures come out, as printed they do not (Table 2.2; "
      "docs/design/attention.md). Ours: docs/design/dip-detector.md."};
  table.notes.insert(table.notes.end(), spec.notes.begin(), spec.notes.end());
  table.notes.push_back(differences_note(rated, spec, counts));
  table.figures = {{"trajectories", labels.trajectories},
                   {"users", rated.users},
                   {"ground_truth", labels.labels},
                   {"mislabelled", {{"labels", labels.unreachable}, {"trajectories", labels.unsound}}},
                   {"recall_ceiling", optional_json(labels.recall_ceiling())},
                   {"match_radius_m", EvaluationConditions{}.match_radius_m},
                   {"rows", std::move(rows)}};
  return table;
}

}  // namespace saccade::reproduce

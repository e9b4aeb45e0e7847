// SPDX-License-Identifier: Apache-2.0
// hand_actions DATA [SEEDS]: the tables of docs/attention.md and docs/dip-detector.md as Markdown, from the recorded
// hands in DATA; 20 seeds by default. Exit status 77 where there are no hands.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "saccade/core/clock.hpp"
#include "saccade/io/hand_trajectory_io.hpp"
#include "support/bad_samples.hpp"
#include "support/dip_reports.hpp"
#include "support/hand_detectors.hpp"

namespace {

using namespace saccade;
using Reports = std::vector<test::DipReport>;

struct Hand {
  LabelledTrajectory labelled;
  bool user1{false};
  bool pick_and_place{false};
  bool sound{false};  ///< no mislabelled place
};

using Group = bool (*)(const Hand&);
bool all(const Hand& /*hand*/) { return true; }
bool user1(const Hand& hand) { return hand.user1; }
bool user2(const Hand& hand) { return !hand.user1; }
bool sound(const Hand& hand) { return hand.sound; }
bool sound_user1(const Hand& hand) { return hand.sound && hand.user1; }
bool sound_user2(const Hand& hand) { return hand.sound && !hand.user1; }
bool pick_and_place(const Hand& hand) { return hand.pick_and_place; }
bool placements_removals(const Hand& hand) { return !hand.pick_and_place; }

/// In the order of `saccade attend DATA`, so that noise is the same.
std::vector<Hand> read_hands(const std::filesystem::path& data) {
  std::vector<Hand> hands;
  if (!std::filesystem::is_directory(data)) return hands;
  const auto files = find_hand_trajectories(data);
  if (!files) return hands;
  for (const std::filesystem::path& file : *files) {
    Hand hand{read_labelled_trajectory(file).value()};
    hand.user1 = hand.labelled.name.starts_with("user1");
    hand.pick_and_place = file.parent_path().filename() == "pick_and_place";
    hand.sound = !is_mislabelled(hand.labelled);
    hands.push_back(std::move(hand));
  }
  return hands;
}

/// What a detector reports of a hand, the one that takes whole trajectories with the last sample.
using Detector = Reports (*)(const HandTrajectory&);

template <auto kDetect>
Reports whole(const HandTrajectory& hand) {
  std::vector<HandAction> actions = kDetect(hand).value();
  Reports reports;
  for (HandAction& action : actions) reports.push_back({std::move(action), hand.back().time_s});
  return reports;
}

struct Condition {
  double speed{1.0};
  double sigma_m{0.0};
  test::BadSamples bad{};
};

/// Sums over trajectories and seeds.
struct Tally {
  DetectionCounts wide{};  ///< within 20 cm
  DetectionCounts near{};  ///< within 5 cm
  std::vector<double> ms{};
  std::vector<double> latencies_s{};

  Tally& operator+=(const Tally& other) {
    wide += other.wide;
    near += other.near;
    ms.insert(ms.end(), other.ms.begin(), other.ms.end());
    latencies_s.insert(latencies_s.end(), other.latencies_s.begin(), other.latencies_s.end());
    return *this;
  }
};

Tally tally_of(const Hand& hand, std::size_t index, const Condition& condition, std::uint64_t seed, Detector detector) {
  Tally tally;
  const std::vector<Eigen::Vector3d>& labels_m = hand.labelled.labels_m;
  const HandActionDetector detect = [&](const HandTrajectory& given) -> Result<std::vector<HandAction>> {
    const HandTrajectory worse = test::with_bad_samples(given, condition.bad, 1000 * seed + index);
    const Stopwatch stopwatch;
    const Reports reports = detector(worse);
    tally.ms.push_back(stopwatch.elapsed_ms());
    tally.latencies_s = test::latencies_s(reports, worse, labels_m);
    const std::vector<HandAction> actions = test::actions_of(reports);
    tally.near = score(actions, labels_m, 0.05).counts;
    return actions;
  };
  const EvaluationConditions conditions{
      .speed = condition.speed, .sigma_m = condition.sigma_m, .seed = seed, .first_index = index};
  tally.wide = evaluate_detector(detect, {&hand.labelled, 1}, conditions).value().counts;
  return tally;
}

/// One per hand.
std::vector<Tally> tallies_of(const std::vector<Hand>& hands, const Condition& condition, std::uint64_t seeds,
                              Detector detector) {
  if (condition.sigma_m == 0.0 && !condition.bad.any()) seeds = 1;
  std::vector<Tally> tallies(hands.size());
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    for (std::size_t i = 0; i < hands.size(); ++i) tallies[i] += tally_of(hands[i], i, condition, seed, detector);
  }
  return tallies;
}

Tally sum_of(const std::vector<Hand>& hands, const std::vector<Tally>& tallies, Group group) {
  Tally sum;
  for (std::size_t i = 0; i < hands.size(); ++i) {
    if (group(hands[i])) sum += tallies[i];
  }
  return sum;
}

double percent(const std::optional<double>& share) { return 100.0 * share.value_or(0.0); }

/// A precision of nothing is none.
std::string precision_text(const std::optional<double>& precision) {
  if (!precision) return "none";
  char text[16];
  std::snprintf(text, sizeof text, "%.1f", 100.0 * *precision);
  return text;
}

void print_rates(const test::Rates& rates) { std::printf(" %.1f / %.1f |", rates.precision, rates.recall); }

void print_rates(const std::vector<Hand>& hands, const std::vector<Tally>& tallies, Group group) {
  const DetectionCounts counts = sum_of(hands, tallies, group).wide;
  std::printf(" %s / %.1f |", precision_text(counts.precision()).c_str(), percent(counts.recall()));
}

/// Of one row of Tables 2.3 and 2.4.
struct ThreeDetectors {
  std::vector<Tally> gmm;
  std::vector<Tally> zvc;
  std::vector<Tally> dips;
};

void print_condition(const test::ThesisHandRow& row) {
  if (row.sigma_m > 0.0) {
    std::printf("| noise %g cm |", 100.0 * row.sigma_m);
  } else {
    std::printf("| speed %g |", row.speed);
  }
}

void print_thesis_tables(const std::vector<Hand>& hands, std::uint64_t seeds) {
  std::vector<ThreeDetectors> rows;
  for (const test::ThesisHandRow& row : test::kThesisHandRows) {
    const Condition condition{.speed = row.speed, .sigma_m = row.sigma_m};
    rows.push_back({tallies_of(hands, condition, seeds, whole<test::by_gmm>),
                    tallies_of(hands, condition, seeds, whole<test::by_zvc>),
                    tallies_of(hands, condition, seeds, whole<test::by_dips>)});
  }
  std::printf("### Beside the thesis: Tables 2.3 and 2.4\n\n");
  std::printf("| condition | GMM-AS: thesis | ours | user 1 | user 2 | sound | ZVC: thesis | ours | user 1 | user 2 ");
  std::printf("| sound |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const test::ThesisHandRow& row = test::kThesisHandRows[i];
    print_condition(row);
    print_rates(row.gmm);
    for (const Group group : {all, user1, user2, sound}) print_rates(hands, rows[i].gmm, group);
    print_rates(row.zvc);
    for (const Group group : {all, user1, user2, sound}) print_rates(hands, rows[i].zvc, group);
    std::printf("\n");
  }
  std::printf("\n### Beside the thesis: Table 2.2\n\n");
  std::printf("| tasks | GMM-AS: thesis | ours | ZVC: thesis | ours |\n|---|---|---|---|---|\n");
  const ThreeDetectors& plain = rows[2];
  struct Tasks {
    const char* name;
    Group group;
    test::Rates gmm;
    test::Rates zvc;
  };
  for (const Tasks& tasks :
       {Tasks{"placements and removals", placements_removals, test::kThesisPlacementsGmm, test::kThesisPlacementsZvc},
        Tasks{"pick and place", pick_and_place, test::kThesisPickAndPlaceGmm, test::kThesisPickAndPlaceZvc}}) {
    std::printf("| %s |", tasks.name);
    print_rates(tasks.gmm);
    print_rates(hands, plain.gmm, tasks.group);
    print_rates(tasks.zvc);
    print_rates(hands, plain.zvc, tasks.group);
    std::printf("\n");
  }
  std::printf("\n### The three detectors\n\n");
  std::printf("| condition | all: GMM-AS | ZVC | ours | sound: GMM-AS | ZVC | ours |\n|---|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    print_condition(test::kThesisHandRows[i]);
    for (const Group group : {all, sound}) {
      for (const auto* tallies : {&rows[i].gmm, &rows[i].zvc, &rows[i].dips}) print_rates(hands, *tallies, group);
    }
    std::printf("\n");
  }
}

struct DipRow {
  const char* disturbance;
  Condition condition;
};

std::vector<DipRow> dip_rows() {
  std::vector<DipRow> rows;
  for (const double speed : {0.25, 0.5, 1.0, 2.0, 4.0}) {
    rows.push_back({"none", {.speed = speed}});
    rows.push_back({"2.5 cm of noise", {.speed = speed, .sigma_m = 0.025}});
    rows.push_back({"5 cm of noise", {.speed = speed, .sigma_m = 0.05}});
    rows.push_back({"10 cm of noise", {.speed = speed, .sigma_m = 0.10}});
  }
  rows.push_back({"50 % repeats", {.bad = {.repeat_share = 0.5}}});
  rows.push_back({"5 % outliers up to 50 cm, 50 % repeats", {.bad = {.outlier_share = 0.05, .repeat_share = 0.5}}});
  rows.push_back({"5 % outliers of 50 cm, 50 % repeats",
                  {.bad = {.outlier_share = 0.05, .farthest_outliers = true, .repeat_share = 0.5}}});
  return rows;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void print_dip_row(const DipRow& row, const Tally& sum, bool streams) {
  std::printf("| %g | %s | %.2f | %.2f | %.1f | %.1f | %.3f |", row.condition.speed, row.disturbance,
              percent(sum.wide.precision()), percent(sum.wide.recall()), percent(sum.near.precision()),
              percent(sum.near.recall()), quantile(sum.ms, 0.5));
  for (const double share : {0.1, 0.5, 0.9}) {
    if (streams) std::printf(" %.2f |", quantile(sum.latencies_s, share));
  }
  std::printf("\n");
}

void print_dip_tables(const std::vector<Hand>& hands, std::uint64_t seeds) {
  const std::vector<DipRow> rows = dip_rows();
  std::vector<std::vector<Tally>> of_whole;
  std::vector<std::vector<Tally>> of_stream;
  for (const DipRow& row : rows) {
    of_whole.push_back(tallies_of(hands, row.condition, seeds, whole<test::by_dips>));
    of_stream.push_back(tallies_of(hands, row.condition, seeds, test::dip_reports));
  }
  struct Users {
    const char* name;
    Group group;
  };
  for (const Users& users : {Users{"User 1", sound_user1}, Users{"User 2", sound_user2}, Users{"Both users", sound}}) {
    for (const bool streams : {false, true}) {
      std::printf("\n### %s, %s\n\n", users.name, streams ? "streaming" : "whole trajectories");
      std::printf("| speed | disturbance | precision, %% | recall, %% | at 5 cm: precision, %% | recall, %% | ms |%s\n",
                  streams ? " latency, s: 10 % | median | 90 % |" : "");
      std::printf("|---|---|---|---|---|---|---|%s\n", streams ? "---|---|---|" : "");
      for (std::size_t i = 0; i < rows.size(); ++i) {
        print_dip_row(rows[i], sum_of(hands, streams ? of_stream[i] : of_whole[i], users.group), streams);
      }
    }
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2) {
    std::fprintf(stderr, "hand_actions DATA [SEEDS]\n");
    return 2;
  }
  const std::vector<Hand> hands = read_hands(arguments[1]);
  if (hands.empty()) {
    std::fprintf(stderr, "no hands in %s\n", arguments[1]);
    return 77;
  }
  const auto seeds = static_cast<std::uint64_t>(count > 2 ? std::max(1, std::atoi(arguments[2])) : 20);
  print_thesis_tables(hands, seeds);
  print_dip_tables(hands, seeds);
  return 0;
}

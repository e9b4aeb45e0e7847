// SPDX-License-Identifier: Apache-2.0
// hand_actions DATA [SEEDS]: the tables of docs/design/dip-detector.md as Markdown, from the recorded hands in DATA; 20
// seeds by default. Exit status 77 where there are no hands. Tables 2.2 to 2.4 of the thesis: saccade reproduce.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "saccade/attention/detector_evaluation.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/io/frames/trajectory_io.hpp"
#include "support/bad_samples.hpp"
#include "support/dip_reports.hpp"
#include "support/hand_detectors.hpp"

namespace {

using namespace saccade;
using Reports = std::vector<test::DipReport>;

struct Hand {
  LabelledTrajectory labelled;
  bool user1{false};
  bool sound{false};  ///< no mislabelled place
};

using Group = bool (*)(const Hand&);
bool sound(const Hand& hand) { return hand.sound; }
bool sound_user1(const Hand& hand) { return hand.sound && hand.user1; }
bool sound_user2(const Hand& hand) { return hand.sound && !hand.user1; }

/// In the order of `saccade attend DATA`, so that noise is the same.
std::vector<Hand> read_hands(const std::filesystem::path& data) {
  std::vector<Hand> hands;
  if (!std::filesystem::is_directory(data)) return hands;
  const auto files = find_hand_trajectories(data);
  if (!files) return hands;
  for (const std::filesystem::path& file : *files) {
    Hand hand{read_labelled_trajectory(file).value()};
    hand.user1 = hand.labelled.name.starts_with("user1");
    hand.sound = !is_mislabelled(hand.labelled);
    hands.push_back(std::move(hand));
  }
  return hands;
}

/// Reports of a detector about a hand; the one for whole trajectories reports at the last sample.
using Detector = Reports (*)(const HandTrajectory&);

Reports whole(const HandTrajectory& hand) {
  std::vector<HandAction> actions = test::by_dips(hand).value();
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
    of_whole.push_back(tallies_of(hands, row.condition, seeds, whole));
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
  print_dip_tables(hands, seeds);
  return 0;
}

// SPDX-License-Identifier: Apache-2.0
// hand_actions [SEEDS [FOLDER]]: the figures of docs/dip-detector.md as Markdown; 20 seeds and the shared hands by
// default. Exit status 77 where there are no hands.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "saccade/attention/dip_detector.hpp"
#include "saccade/core/clock.hpp"
#include "support/hand_data.hpp"

namespace {

using namespace saccade;

struct Row {
  const char* disturbance;
  test::HandCondition condition;
};

std::vector<Row> rows() {
  std::vector<Row> all;
  for (const double speed : {0.25, 0.5, 1.0, 2.0, 4.0}) {
    all.push_back({"none", {.speed = speed}});
    all.push_back({"2.5 cm of noise", {.speed = speed, .noise_m = 0.025}});
    all.push_back({"5 cm of noise", {.speed = speed, .noise_m = 0.05}});
    all.push_back({"10 cm of noise", {.speed = speed, .noise_m = 0.10}});
  }
  all.push_back({"50 % repeats", {.repeat_share = 0.5}});
  all.push_back({"5 % outliers up to 50 cm, 50 % repeats", {.outlier_share = 0.05, .repeat_share = 0.5}});
  all.push_back(
      {"5 % outliers of 50 cm, 50 % repeats", {.outlier_share = 0.05, .farthest_outliers = true, .repeat_share = 0.5}});
  return all;
}

/// Sums over trajectories and seeds.
struct Figures {
  test::DetectionScore wide{};
  test::DetectionScore near{};
  std::vector<double> ms{};
  std::vector<double> latencies_s{};

  void add(const test::RecordedHand& hand, const std::vector<HandAction>& actions, double took_ms) {
    wide.add(hand.labels_m, actions, 0.2);
    near.add(hand.labels_m, actions, 0.05);
    ms.push_back(took_ms);
  }
};

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

using Detector = void (*)(const test::RecordedHand&, const HandTrajectory&, Figures&);

void in_batch(const test::RecordedHand& hand, const HandTrajectory& samples, Figures& figures) {
  const Stopwatch stopwatch;
  const DipResult result = detect_dips(samples).value();
  figures.add(hand, result.actions, stopwatch.elapsed_ms());
}

void streaming(const test::RecordedHand& hand, const HandTrajectory& samples, Figures& figures) {
  const Stopwatch stopwatch;
  const test::StreamedActions streamed = test::streamed_actions(samples);
  figures.add(hand, streamed.actions, stopwatch.elapsed_ms());
  const std::vector<double> of_hand_s = test::latencies_s(streamed, samples, hand.labels_m);
  figures.latencies_s.insert(figures.latencies_s.end(), of_hand_s.begin(), of_hand_s.end());
}

Figures figures_of(const std::vector<test::RecordedHand>& hands, int user, const test::HandCondition& condition,
                   int seeds, Detector detector) {
  Figures figures;
  for (int seed = 0; seed < (test::is_random(condition) ? seeds : 1); ++seed) {
    for (std::size_t i = 0; i < hands.size(); ++i) {
      if (user != 0 && hands[i].user != user) continue;
      std::mt19937_64 random = test::hand_random(seed, i);
      detector(hands[i], test::disturbed(hands[i].positions_m, condition, random), figures);
    }
  }
  return figures;
}

void print_table(const std::vector<test::RecordedHand>& hands, int user, int seeds, Detector detector) {
  const bool streams = detector == streaming;
  std::printf("| speed | disturbance | precision, %% | recall, %% | at 5 cm: precision, %% | recall, %% | ms |%s\n",
              streams ? " latency, s: 10 % | median | 90 % |" : "");
  std::printf("|---|---|---|---|---|---|---|%s\n", streams ? "---|---|---|" : "");
  for (const Row& row : rows()) {
    const Figures figures = figures_of(hands, user, row.condition, seeds, detector);
    std::printf("| %g | %s | %.2f | %.2f | %.1f | %.1f | %.3f |", row.condition.speed, row.disturbance,
                100.0 * figures.wide.precision(), 100.0 * figures.wide.recall(), 100.0 * figures.near.precision(),
                100.0 * figures.near.recall(), quantile(figures.ms, 0.5));
    for (const double share : {0.1, 0.5, 0.9}) {
      if (streams) std::printf(" %.2f |", quantile(figures.latencies_s, share));
    }
    std::printf("\n");
  }
}

}  // namespace

int main(int count, char** arguments) {
  const int seeds = count > 1 ? std::max(1, std::atoi(arguments[1])) : 20;
  const std::string folder = count > 2 ? arguments[2] : SACCADE_SHARED_DATA "/hand_polhemus";
  const std::vector<test::RecordedHand> hands = test::recorded_hands(folder);
  if (hands.empty()) {
    std::fprintf(stderr, "no hands in %s\n", folder.c_str());
    return 77;
  }
  for (const int user : {1, 2, 0}) {
    const char* const who = user == 0 ? "Both users" : user == 1 ? "User 1" : "User 2";
    std::printf("\n### %s, whole trajectories\n\n", who);
    print_table(hands, user, seeds, in_batch);
    std::printf("\n### %s, streaming\n\n", who);
    print_table(hands, user, seeds, streaming);
  }
  return 0;
}

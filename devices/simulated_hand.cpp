// SPDX-License-Identifier: Apache-2.0
// A simulated hand that changes one scene into another, as its tracker would report it.
//
//   saccade-simulated-hand --scene SCENE --then SCENE [--rate R] [--seed N] [--when FILE]
//
// It moves R times as fast as in reality. FILE is written as soon as the hand has let go of the last object, so that a
// saccade-simulated-camera with the same --then and --when sees the change.
#include <fstream>
#include <thread>

#include "protocol.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "saccade/trial/simulated_task.hpp"

namespace {

using namespace saccade;
using devices::say;

Result<SimulatedHand> hand_of(const devices::Options& options) {
  SACCADE_TRY(const Scene before, find_scene(options.text("--scene")));
  SACCADE_TRY(const Scene after, find_scene(options.text("--then")));
  SACCADE_TRY(const std::vector<SceneChange> changes, scene_changes(before, after));
  return simulated_hand(before, changes, static_cast<std::uint64_t>(options.number("--seed", 1.0)));
}

/// The last sample next to where the hand acted last.
std::size_t let_go(const SimulatedHand& hand) {
  constexpr double kNear_m{0.02};
  for (std::size_t i = hand.trajectory.size(); i-- > 0;) {
    if ((hand.trajectory[i].position_m - hand.places.back().position_m).norm() < kNear_m) return i;
  }
  return hand.trajectory.size();
}

void run(const SimulatedHand& hand, double rate, const std::string& when) {
  const std::size_t last = let_go(hand);
  devices::LineInput input;
  std::size_t next = 0;
  double start_s = 0.0;  // on this machine's clock, of the first sample
  while (!input.ended()) {
    const auto request = input.next(std::chrono::milliseconds{200});
    if (!request) continue;
    const std::string kind = request->at("request");
    if (kind == "hello") {
      say({{"saccade", 1}});
    } else if (kind != "sample") {
      say({{"error", "unknown request " + kind}});
    } else if (next == hand.trajectory.size()) {
      say({{"number", request->at("number")}, {"end", true}});
    } else {
      const HandSample& sample = hand.trajectory[next];
      if (next == 0) start_s = devices::now_s();
      const double wait_s = start_s + (sample.time_s - hand.trajectory[0].time_s) / rate - devices::now_s();
      if (wait_s > 0.0) std::this_thread::sleep_for(std::chrono::duration<double>{wait_s});
      if (next == last && !when.empty()) std::ofstream{when} << "changed\n";
      const Eigen::Vector3d& p = sample.position_m;
      say({{"number", request->at("number")}, {"time_s", sample.time_s}, {"position", {p.x(), p.y(), p.z()}}});
      ++next;
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const devices::Options options{argc, argv};
    const auto hand = hand_of(options);
    if (!hand) throw std::runtime_error{hand.error().to_string()};
    run(*hand, options.number("--rate", 1.0), options.text("--when"));
  } catch (const std::exception& e) {
    std::cerr << "saccade-simulated-hand: " << e.what() << '\n';
    return 1;
  }
  return 0;
}

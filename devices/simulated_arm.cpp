// SPDX-License-Identifier: Apache-2.0
// The joints of a simulated arm, with the delay, the jitter and the faults of a real one.
//
//   saccade-simulated-arm [--state FILE] [--start Q,Q,...] [--delay S] [--jitter RAD] [--clock S] [--rate R] [--seed N]
//                         [--fault none|hang|die|lie|drift|slow|nonsense|error] [--after S] [--log FILE]
//                         [--scene SCENE [--robot ROBOT] [--base LINK] [--base-at X,Y,Z[,DEGREES]] [--tip LINK]
//                         [--camera-frame LINK] [--package NAME=FOLDER]]
//
// --state is where a simulated camera reads the true positions; --rate is how much faster than real time it moves;
// --clock is added to its time stamps; the fault shows when it has been moving for --after seconds; --log gets lines
// with the times when the arm is told to follow a motion and to stop, and of contacts with what truly stands in SCENE.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <thread>

#include "arm_reading.hpp"
#include "arm_state.hpp"
#include "protocol.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "saccade/trial/metrics.hpp"

namespace {

using nlohmann::json;
using namespace saccade::devices;

constexpr double kTellEvery_s{0.01};

/// A motion that was asked for.
struct Motion {
  std::size_t number{0};
  json points;
  double began_s{0.0};

  [[nodiscard]] double duration_s() const { return points.back().at("t_s").get<double>(); }
  /// Cubic between its points, which have positions and speeds.
  [[nodiscard]] std::vector<double> at(double t_s) const {
    std::size_t i = 0;
    while (i + 2 < points.size() && points[i + 1].at("t_s").get<double>() < t_s) ++i;
    const json& a = points[i];
    const json& b = points[std::min(i + 1, points.size() - 1)];
    const double step_s = std::max(b.at("t_s").get<double>() - a.at("t_s").get<double>(), 1e-9);
    const double u = std::clamp((t_s - a.at("t_s").get<double>()) / step_s, 0.0, 1.0);
    std::vector<double> q;
    for (std::size_t k = 0; k < a.at("q").size(); ++k) {
      const double from = a.at("q")[k].get<double>();
      const double to = b.at("q")[k].get<double>();
      const double from_speed = step_s * a.at("dq")[k].get<double>();
      const double to_speed = step_s * b.at("dq")[k].get<double>();
      const double d = to - from;
      q.push_back(from + u * (from_speed +
                              u * (3.0 * d - 2.0 * from_speed - to_speed + u * (from_speed + to_speed - 2.0 * d))));
    }
    return q;
  }
};

/// The arm among what truly stands around it.
struct TrueScene {
  saccade::ArmCollision arm;
  saccade::Solids solids;

  static saccade::Result<TrueScene> open(const std::string& scene_name, const Options& options) {
    SACCADE_TRY(const saccade::UrdfArm read,
                saccade::find_robot(options.text("--robot", "comau"), reading_of(options)));
    SACCADE_TRY(saccade::ArmCollision arm, saccade::ArmCollision::create(read.arm));
    SACCADE_TRY(const saccade::Scene scene, saccade::find_scene(scene_name));
    SACCADE_TRY(const saccade::RayScene rays, saccade::RayScene::build(scene));
    const auto any = [](const saccade::SceneObject& /*object*/) { return true; };
    SACCADE_TRY(saccade::Solids solids, saccade::Solids::build(rays, any));
    return TrueScene{std::move(arm), std::move(solids)};
  }
  [[nodiscard]] bool touched_at(const std::vector<double>& q) const {
    return touches(arm, solids, Eigen::Map<const Eigen::VectorXd>{q.data(), static_cast<Eigen::Index>(q.size())});
  }
};

class SimulatedArm {
 public:
  explicit SimulatedArm(const Options& options)
      : delay_s_{options.number("--delay", 0.0)},
        jitter_{options.number("--jitter", 0.0)},
        clock_s_{options.number("--clock", 0.0)},
        rate_{options.number("--rate", 1.0)},
        fault_{options.text("--fault", "none")},
        after_s_{options.number("--after", 0.0)},
        log_{options.text("--log")},
        q_{options.numbers("--start")},
        random_{static_cast<unsigned>(options.number("--seed", 1.0))} {
    const std::string state = options.text("--state");
    if (!state.empty()) state_.emplace(state);
    if (const std::string scene = options.text("--scene"); !scene.empty()) {
      auto opened = TrueScene::open(scene, options);
      if (!opened) throw std::runtime_error{opened.error().to_string()};
      scene_.emplace(*std::move(opened));
    }
    publish();
  }

  void run() {
    while (!input_.ended()) {
      if (const auto request = input_.next(std::chrono::milliseconds{motion_ ? 2 : 50})) answer(*request);
      if (motion_) move();
    }
  }

 private:
  void answer(const json& request) {
    const std::string kind = request.at("request");
    if (kind == "hello") {
      if (q_.empty()) {
        for (std::size_t i = 0; i < request.at("lower").size(); ++i) {
          const json& low = request.at("lower")[i];
          q_.push_back(low.is_null() ? 0.0 : 0.5 * (low.get<double>() + request.at("upper")[i].get<double>()));
        }
      }
      publish();
      say({{"saccade", 1}});
    } else if (kind == "joints") {
      say({{"number", request.at("number")}, {"q", measured()}, {"time_s", now_s() + clock_s_}});
    } else if (kind == "follow") {
      note("follow");
      motion_ = Motion{request.at("number"), request.at("points"), now_s()};
      told_s_ = 0.0;
    } else if (kind == "stop") {
      note("stop");
      motion_.reset();
      say({{"number", request.at("number")}, {"q", measured()}});
    } else {
      say({{"error", "unknown request " + kind}});
    }
  }

  void move() {
    const double elapsed_s = rate_ * (now_s() - motion_->began_s);
    const bool faulty = fault_ != "none" && moved_s_ + elapsed_s >= after_s_;
    if (faulty) note_fault();
    const double planned_s = faulty && fault_ == "slow" ? 0.5 * elapsed_s : elapsed_s;
    const double t_s = std::max(planned_s - delay_s_, 0.0);
    const bool done = t_s >= motion_->duration_s();
    if (!(faulty && (fault_ == "lie" || fault_ == "hang"))) q_ = motion_->at(t_s);
    if (faulty && fault_ == "drift") q_[0] += 0.3 * std::min(moved_s_ + elapsed_s - after_s_, 1.0);
    publish();
    if (!done && now_s() - told_s_ < kTellEvery_s) return;
    told_s_ = now_s();
    if (faulty && fault_ == "hang") std::this_thread::sleep_for(std::chrono::hours{1});
    if (faulty && fault_ == "die") ::_exit(9);
    if (faulty && fault_ == "error") return say({{"error", "protective stop"}});
    if (faulty && fault_ == "nonsense") return say("moving along nicely");
    const std::vector<double> told = faulty && fault_ == "lie" ? std::vector<double>(q_.size(), 0.1) : measured();
    say({{"number", motion_->number},
         {"done", done},
         {"t_s", std::min(planned_s, motion_->duration_s())},
         {"q", told},
         {"time_s", now_s() + clock_s_}});
    if (!done) return;
    moved_s_ += elapsed_s;
    motion_.reset();
  }

  void note_fault() {
    if (fault_noted_) return;
    fault_noted_ = true;
    note("fault");
  }

  /// Positions as encoders have them.
  [[nodiscard]] std::vector<double> measured() {
    std::vector<double> q = q_;
    if (jitter_ > 0.0) {
      std::normal_distribution<double> noise{0.0, jitter_};
      for (double& value : q) value += noise(random_);
    }
    return q;
  }

  void publish() {
    if (q_.empty()) return;
    if (state_) state_->write(q_);
    const bool touches = scene_ && q_ != looked_at_ && scene_->touched_at(q_);
    looked_at_ = q_;
    if (touches) note("contact");
  }

  void note(const char* what) const {
    if (!log_.empty()) std::ofstream{log_, std::ios::app} << std::to_string(now_s()) << ' ' << what << '\n';
  }

  double delay_s_, jitter_, clock_s_, rate_;
  std::string fault_;
  double after_s_;
  std::string log_;
  std::vector<double> q_;
  std::mt19937 random_;
  std::optional<ArmState> state_;
  std::optional<TrueScene> scene_;
  std::vector<double> looked_at_;  ///< for contacts
  LineInput input_;
  std::optional<Motion> motion_;
  double moved_s_{0.0};
  double told_s_{0.0};
  bool fault_noted_{false};
};

}  // namespace

int main(int argc, char** argv) {
  try {
    SimulatedArm{Options{argc, argv}}.run();
  } catch (const std::exception& e) {
    std::cerr << "saccade-simulated-arm: " << e.what() << '\n';
    return 1;
  }
  return 0;
}

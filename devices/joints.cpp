// SPDX-License-Identifier: Apache-2.0
// The joints of an arm for Saccade (docs/guides/processes.md), in C++. They do exactly what they are told; put your own
// arm in.
//
//   saccade-joints-example [RATE]
//
// To make it yours: connect to the arm at the start of main, read its joints in position(), and send it a set point in
// set_position(), or the whole list of points where your controller takes trajectories. RATE is how much faster than
// real time it moves, for tries without an arm.
#include <cmath>

#include "protocol.hpp"

namespace {

using nlohmann::json;
using namespace saccade::devices;

constexpr std::chrono::milliseconds kPeriod{20};  // positions on the way are told 50 times a second
std::vector<double> q;                            // radians, metres for prismatic joints

std::vector<double> position() { return q; }

void set_position(const std::vector<double>& wanted) { q = wanted; }

/// Returns the joint positions of a trajectory, linear between its points.
std::vector<double> state_at(const json& points, double t_s) {
  std::size_t i = 1;
  while (i + 1 < points.size() && points[i].at("t_s").get<double>() < t_s) ++i;
  const json& a = points[i - 1];
  const json& b = points[std::min(i, points.size() - 1)];
  const double step_s = b.at("t_s").get<double>() - a.at("t_s").get<double>();
  const double share = step_s > 0.0 ? std::clamp((t_s - a.at("t_s").get<double>()) / step_s, 0.0, 1.0) : 1.0;
  std::vector<double> state = a.at("q");
  for (std::size_t k = 0; k < state.size(); ++k) state[k] = std::lerp(state[k], b.at("q")[k].get<double>(), share);
  return state;
}

}  // namespace

int main(int argc, char** argv) {
  const double rate = Options{argc, argv}.number("", 1.0);
  std::optional<json> motion;  // the request that is under way
  double began_s = 0.0;
  for (LineInput input; !input.ended();) {  // ends when Saccade is done, or gone
    const auto wait = std::chrono::duration_cast<std::chrono::milliseconds>(kPeriod / rate);
    const json request = input.next(wait).value_or(json::object());
    const std::string kind = request.value("request", "");
    if (kind == "hello") {
      q.clear();
      for (std::size_t i = 0; i < request.at("lower").size(); ++i) {
        const json& low = request.at("lower")[i];  // null: the joint turns without end
        q.push_back(low.is_null() ? 0.0 : 0.5 * (low.get<double>() + request.at("upper")[i].get<double>()));
      }
      say({{"saccade", 1}});
    } else if (kind == "joints") {
      say({{"number", request.at("number")}, {"q", position()}, {"time_s", now_s()}});
    } else if (kind == "follow") {
      motion = request;
      began_s = now_s();
    } else if (kind == "stop") {  // may come while a motion is not answered: that one gets no more answers
      motion.reset();
      say({{"number", request.at("number")}, {"q", position()}});
    } else if (!kind.empty()) {
      say({{"error", "unknown request " + kind}});
    }
    if (!motion) continue;
    const json& points = motion->at("points");
    const double duration_s = points.back().at("t_s");
    const double t_s = std::min(rate * (now_s() - began_s), duration_s);
    set_position(state_at(points, t_s));
    const bool done = t_s >= duration_s;
    say({{"number", motion->at("number")}, {"done", done}, {"t_s", t_s}, {"q", position()}, {"time_s", now_s()}});
    if (done) motion.reset();
  }
}

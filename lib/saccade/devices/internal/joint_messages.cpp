// SPDX-License-Identifier: Apache-2.0
#include "saccade/devices/internal/joint_messages.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "saccade/devices/internal/process_messages.hpp"

namespace saccade {
namespace {

using nlohmann::json;

json to_list(const Configuration& q) { return json(std::vector<double>{q.begin(), q.end()}); }

Error wrong(std::string what) { return {Errc::corrupt_data, std::move(what), {}}; }

Result<std::optional<double>> number_in(const json& answer, const char* key) {
  const auto value = answer.find(key);
  if (value == answer.end()) return std::optional<double>{};
  if (!value->is_number()) return wrong(std::string{key} + " must be a number");
  return std::optional{value->get<double>()};
}

Result<std::size_t> count_in(const json& answer, const char* key) {
  const auto value = answer.find(key);
  if (value != answer.end() && value->is_number_unsigned()) return value->get<std::size_t>();
  return wrong(std::string{key} + " must be an integer that is not negative");
}

Result<std::vector<double>> numbers_in(const json& answer, const char* key, std::size_t count) {
  const auto value = answer.find(key);
  if (value == answer.end()) return wrong(std::string{"the key "} + key + " is missing");
  const std::string expected = std::string{key} + " must be " + std::to_string(count) + " numbers";
  if (!value->is_array() || value->size() != count) return wrong(expected);
  std::vector<double> numbers;
  for (const json& item : *value) {
    if (!item.is_number() || !std::isfinite(item.get<double>())) return wrong(expected);
    numbers.push_back(item.get<double>());
  }
  return numbers;
}

}  // namespace

std::string joints_hello_request(const ProgramJointsConfig& config) {
  return json{{"saccade", kProcessProtocol},
              {"request", "hello"},
              {"role", "joints"},
              {"joints", config.names},
              {"lower", to_list(config.lower)},
              {"upper", to_list(config.upper)},
              {"speed", to_list(config.speed)},
              {"acceleration", to_list(config.acceleration)}}
      .dump();
}

std::string joints_request(std::size_t number) { return json{{"request", "joints"}, {"number", number}}.dump(); }

std::string stop_request(std::size_t number) { return json{{"request", "stop"}, {"number", number}}.dump(); }

std::string sample_request(std::size_t number) { return json{{"request", "sample"}, {"number", number}}.dump(); }

std::string follow_request(std::size_t number, const Trajectory& trajectory) {
  json points = json::array();
  const double end_s = trajectory.duration_s();
  const auto steps = static_cast<int>(std::ceil(end_s / kFollowStep_s));
  for (int i = 0; i <= steps; ++i) {
    const double t_s = std::min(i * kFollowStep_s, end_s);
    const Trajectory::State state = trajectory.at(t_s);
    points.push_back({{"t_s", t_s}, {"q", to_list(state.q)}, {"dq", to_list(state.speed)}});
  }
  return json{{"request", "follow"}, {"number", number}, {"points", std::move(points)}}.dump();
}

Result<JointAnswer> parse_joint_answer(std::string_view line, Eigen::Index dof) {
  SACCADE_TRY(const json answer, parse_answer(line));
  JointAnswer joints;
  SACCADE_TRY(joints.number, count_in(answer, "number"));
  SACCADE_TRY(const std::vector<double> q, numbers_in(answer, "q", static_cast<std::size_t>(dof)));
  joints.q = Eigen::Map<const Eigen::VectorXd>{q.data(), dof};
  SACCADE_TRY(joints.t_s, number_in(answer, "t_s"));
  SACCADE_TRY(joints.time_s, number_in(answer, "time_s"));
  if (const auto done = answer.find("done"); done != answer.end()) {
    if (!done->is_boolean()) return wrong("done must be true or false");
    joints.done = done->get<bool>();
  }
  return joints;
}

Result<std::optional<HandSample>> parse_sample_answer(std::string_view line, std::size_t number) {
  SACCADE_TRY(const json answer, parse_answer(line));
  SACCADE_TRY(const std::size_t answered, count_in(answer, "number"));
  if (answered != number) {
    return wrong("number must be " + std::to_string(number) + ", not " + std::to_string(answered));
  }
  if (const auto end = answer.find("end"); end != answer.end() && *end == true) return std::optional<HandSample>{};
  HandSample sample;
  SACCADE_TRY(const std::optional<double> time_s, number_in(answer, "time_s"));
  if (!time_s) return wrong("the key time_s is missing");
  sample.time_s = *time_s;
  sample.position_m.setConstant(std::numeric_limits<double>::quiet_NaN());
  const auto position = answer.find("position");
  if (position != answer.end() && !position->is_null()) {
    SACCADE_TRY(const std::vector<double> p, numbers_in(answer, "position", 3));
    sample.position_m = Eigen::Vector3d{p[0], p[1], p[2]};
  }
  return std::optional{sample};
}

}  // namespace saccade

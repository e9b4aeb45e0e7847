// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <sstream>
#include <thread>
#include <utility>

#include "saccade/core/clock.hpp"
#include "saccade/devices/internal/joint_messages.hpp"
#include "saccade/devices/internal/process_messages.hpp"
#include "saccade/devices/internal/program.hpp"
#include "saccade/devices/programs.hpp"

namespace saccade {
namespace {

constexpr std::chrono::milliseconds kWatchStep{10};
constexpr double kStopTimeout_s{0.5};  ///< from the request to the arm's standstill

Error nonsense(std::string what) { return {Errc::corrupt_data, std::move(what), {}}; }

/// Answers corrupt_data for positions outside the limits by more than the tolerance.
Status check_limits(const ProgramJointsConfig& config, const Configuration& q) {
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    if (q[i] >= config.lower[i] - config.tolerance && q[i] <= config.upper[i] + config.tolerance) continue;
    std::ostringstream text;
    text << config.names[static_cast<std::size_t>(i)] << " stands at " << q[i] << ", outside its limits "
         << config.lower[i] << " and " << config.upper[i] << "; radians and metres are meant";
    return nonsense(text.str());
  }
  return {};
}

}  // namespace

Status ProgramJointsConfig::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "joints"}; };
  SACCADE_CHECK(program.validate("joints"));
  const auto dof = static_cast<Eigen::Index>(names.size());
  for (const Configuration* limits : {&lower, &upper, &speed, &acceleration}) {
    if (limits->size() != dof || dof == 0) return fail("each joint needs a name and its limits");
  }
  if (!(tolerance > 0.0)) return fail("the tolerance of positions must be positive");
  if (!(lag_s >= 0.0)) return fail("the lag of positions must not be negative");
  return validate_time_limit(watchdog_s, "joints");
}

/// Supervises one motion from its own thread, so that a slow observer delays no stop.
class ProgramJoints::Drive {
 public:
  Drive(ProgramJoints& joints, const Trajectory& trajectory, std::size_t number)
      : joints_{joints},
        config_{joints.config_},
        trajectory_{trajectory},
        number_{number},
        request_{"follow " + std::to_string(number), trajectory.duration_s() + config_.program.timeout_s} {}

  [[nodiscard]] Result<JointArrival> run(const JointObserver& observer) {
    std::jthread watcher{[this] { watch(); }};
    std::unique_lock lock{mutex_};
    for (;;) {
      changed_.wait(lock, [this] { return sample_ || end_; });
      const std::optional<JointSample> sample = std::exchange(sample_, std::nullopt);
      if (sample && observer && !end_error()) {
        lock.unlock();
        const Advance advance = observer(*sample);
        lock.lock();
        if (advance == Advance::stop) stop_asked_ = true;
      }
      if (end_ && !sample_) return *std::exchange(end_, std::nullopt);
    }
  }

 private:
  [[nodiscard]] bool end_error() const { return end_ && !end_->ok(); }

  void watch() {
    Result<JointArrival> end = follow();
    const std::lock_guard lock{mutex_};
    end_.emplace(std::move(end));
    changed_.notify_one();
  }

  [[nodiscard]] Result<JointArrival> follow() {
    SACCADE_CHECK(process().write_line(request_, follow_request(number_, trajectory_)));
    process().on_failure(stop_request(joints_.asked_));
    Result<JointArrival> end = watch_over();
    process().on_failure({});
    return end;
  }

  [[nodiscard]] Result<JointArrival> watch_over() {
    Stopwatch silence;
    const Stopwatch since_start;
    for (;;) {
      const auto line = process().next_line(request_, kWatchStep);
      if (!line) return told_to_stop(line.error());
      if (*line) {
        silence = Stopwatch{};
        SACCADE_TRY(const bool done, take(**line, 1e-3 * since_start.elapsed_ms()));
        if (done) return JointArrival{q_};
      }
      if (asked_to_stop()) return stop();
      if (1e-3 * silence.elapsed_ms() > config_.watchdog_s) {
        return give_up("it has said nothing for " + std::to_string(std::lround(silence.elapsed_ms())) +
                       " ms on the way, where its watchdog allows " +
                       std::to_string(std::lround(1e3 * config_.watchdog_s)));
      }
      if (request_.left_ms() == 0) return give_up("the motion takes much longer than it was planned");
    }
  }

  [[nodiscard]] bool asked_to_stop() {
    if (config_.program.cancelled && config_.program.cancelled()) return true;
    const std::lock_guard lock{mutex_};
    return stop_asked_;
  }

  /// Handles a line during the motion, or the last one. Returns whether it was the last; any problem with it stops the
  /// arm.
  [[nodiscard]] Result<bool> take(const std::string& line, double since_start_s) {
    const auto answer = parse_joint_answer(line, config_.lower.size());
    if (!answer) return give_up(answer.error());
    if (answer->number != number_) {
      return give_up(nonsense("number must be " + std::to_string(number_) + ", not " + std::to_string(answer->number)));
    }
    q_ = answer->q;
    const double t_s = answer->done ? trajectory_.duration_s() : answer->t_s.value_or(since_start_s);
    if (const double off = distance_to_way(t_s, answer->done ? 0.0 : config_.lag_s); off > config_.tolerance) {
      std::ostringstream text;
      text << "its joints stand " << off << " rad (or m) off the trajectory at " << t_s << " s, more than "
           << config_.tolerance;
      return give_up(nonsense(text.str()));
    }
    const std::lock_guard lock{mutex_};
    sample_ = JointSample{t_s, q_, answer->time_s};
    changed_.notify_one();
    return answer->done;
  }

  /// Returns the largest difference of a joint from the trajectory, at the best instant of the last lag_s.
  [[nodiscard]] double distance_to_way(double t_s, double lag_s) const {
    constexpr double kStep_s{0.01};
    double least = std::numeric_limits<double>::infinity();
    for (double back_s = 0.0; back_s <= lag_s + 0.5 * kStep_s; back_s += kStep_s) {
      least = std::min(least, (q_ - trajectory_.at(t_s - back_s).q).lpNorm<Eigen::Infinity>());
    }
    return least;
  }

  /// Tells the program to stop, and waits for the arm's final positions.
  [[nodiscard]] Result<JointArrival> stop() {
    const std::size_t number = joints_.asked_++;
    const Request request{"stop " + std::to_string(number), kStopTimeout_s};
    process().on_failure({});  // it is told here
    SACCADE_CHECK(process().interject(request, stop_request(number)));
    for (;;) {
      SACCADE_TRY(const auto line, process().next_line(request, kWatchStep));
      if (request.left_ms() == 0) return process().late(request, "it does not say that the arm stands still");
      if (!line) continue;
      const auto answer = parse_joint_answer(*line, config_.lower.size());
      if (!answer) return process().refused(request, answer.error());
      if (answer->number != number || !answer->done) continue;
      if (const Status within = check_limits(config_, answer->q); !within.ok()) {
        return process().refused(request, within.error());
      }
      return JointArrival{answer->q.cwiseMax(config_.lower).cwiseMin(config_.upper), true};
    }
  }

  /// Stops the arm because of an error, which is final.
  [[nodiscard]] Error give_up(const Error& error) {
    const bool stopped = stop().ok();
    Error fault = process().refused(request_, error);
    return stopped ? Error{fault.code, fault.message + "; the arm was told to stop, and has", fault.context}
                   : told_to_stop(std::move(fault));
  }
  [[nodiscard]] static Error told_to_stop(Error fault) {
    fault.message += "; the arm was told to stop";
    return fault;
  }
  [[nodiscard]] Error give_up(const std::string& what) { return give_up(Error{Errc::io_failure, what, {}}); }

  [[nodiscard]] ExternalProcess& process() { return *joints_.process_; }

  ProgramJoints& joints_;
  const ProgramJointsConfig& config_;
  const Trajectory& trajectory_;
  std::size_t number_;
  Request request_;
  Configuration q_;  ///< last positions received by the watcher

  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<JointSample> sample_;  ///< not yet passed to the observer
  std::optional<Result<JointArrival>> end_;
  bool stop_asked_{false};
};

ProgramJoints::ProgramJoints(ProgramJointsConfig config, std::unique_ptr<ExternalProcess> process)
    : config_{std::move(config)}, process_{std::move(process)} {}
ProgramJoints::~ProgramJoints() = default;

Result<std::unique_ptr<ProgramJoints>> ProgramJoints::start(ProgramJointsConfig config) {
  SACCADE_CHECK(config.validate());
  SACCADE_TRY(auto started, start_program<Ready>("joints", config.program, joints_hello_request(config), parse_ready));
  return std::unique_ptr<ProgramJoints>{new ProgramJoints{std::move(config), std::move(started.process)}};
}

Result<Configuration> ProgramJoints::position() {
  const std::size_t number = asked_++;
  const Request request{"joints " + std::to_string(number), config_.program.timeout_s};
  SACCADE_TRY(const std::string line, process_->ask(request, joints_request(number)));
  const auto answer = parse_joint_answer(line, config_.lower.size());
  if (!answer) return process_->refused(request, answer.error());
  if (answer->number != number)
    return process_->refused(request, nonsense("its number is not " + std::to_string(number)));
  if (const Status within = check_limits(config_, answer->q); !within.ok()) {
    return process_->refused(request, within.error());
  }
  return answer->q.cwiseMax(config_.lower).cwiseMin(config_.upper).eval();
}

Result<JointArrival> ProgramJoints::execute(const Trajectory& trajectory, const JointObserver& observer) {
  SACCADE_EXPECTS(!trajectory.empty());
  return Drive{*this, trajectory, asked_++}.run(observer);
}

}  // namespace saccade

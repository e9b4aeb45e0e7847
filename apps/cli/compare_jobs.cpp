// SPDX-License-Identifier: Apache-2.0
#include "compare_jobs.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <mutex>
#include <thread>

#include "interrupt.hpp"
#include "saccade/core/clock.hpp"

namespace saccade::cli {
namespace {

/// "40 s", "12 min", "3.5 h".
std::string duration_text(double seconds) {
  constexpr double kMinute_s{60.0};
  constexpr double kHour_s{3600.0};
  if (seconds < 1.5 * kMinute_s) return std::to_string(std::lround(seconds)) + " s";
  if (seconds < 1.5 * kHour_s) return std::to_string(std::lround(seconds / kMinute_s)) + " min";
  const long tenths = std::lround(10.0 * seconds / kHour_s);
  return std::to_string(tenths / 10) + '.' + std::to_string(tenths % 10) + " h";
}

/// Runs of which each waits for the one before.
using Chain = std::vector<PlannedRun>;

/// With as many views as sphere took: the runs of one scene, noise and seed; else each run alone.
std::vector<Chain> chains_of(const std::vector<PlannedRun>& runs, bool equal_views) {
  std::vector<Chain> chains;
  for (const PlannedRun& run : runs) {
    if (run.found) continue;
    const auto goes_on = [&run](const PlannedRun& last) {
      return last.scene == run.scene && last.noise == run.noise && last.seed == run.seed;
    };
    if (!equal_views || chains.empty() || !goes_on(chains.back().back())) chains.emplace_back();
    chains.back().push_back(run);
  }
  return chains;
}

class Jobs {
 public:
  Jobs(const Comparison& comparison, const std::vector<PlannedRun>& runs, CampaignIndex& index,
       const Campaign& campaign, std::size_t threads, ProgressBar& progress)
      : comparison_{comparison},
        index_{index},
        campaign_{campaign},
        progress_{progress},
        total_{runs.size()},
        chains_{chains_of(runs, comparison.options().equal_views)},
        truths_(comparison.scenes().size()) {
    std::size_t missing = 0;
    for (const Chain& chain : chains_) {
      ++truths_[chain.front().scene].chains_left;
      missing += chain.size();
    }
    found_ = total_ - missing;
    const std::size_t wanted = comparison.options().jobs == 0 ? threads : comparison.options().jobs;
    jobs_ = std::max<std::size_t>(1, std::min(wanted, chains_.size()));
    threads_of_job_ = std::max<std::size_t>(1, threads / jobs_);
  }

  [[nodiscard]] std::size_t found() const { return found_; }

  Result<std::size_t> run() {
    const CancelOnInterrupt guard{cancel_};
    std::vector<std::thread> others;
    for (std::size_t i = 1; i < jobs_; ++i) others.emplace_back([this] { work(); });
    work();
    for (std::thread& other : others) other.join();
    progress_.finish();
    if (thrown_) std::rethrow_exception(thrown_);
    if (error_) return failed_with(*error_);
    return done_;
  }

 private:
  struct SceneTruth {
    std::mutex mutex;  ///< held while it is built
    std::optional<GroundTruth> truth;
    std::size_t chains_left{0};
  };

  void work() {
    const Executor executor = Executor::with_threads(threads_of_job_);  // its own: no job waits for another's loop
    while (const std::optional<std::size_t> next = take()) {
      const Chain& chain = chains_[*next];
      try {
        for (const PlannedRun& run : chain) {
          const Status status = do_run(run, executor);
          if (!status) fail(*next, run, status.error());
          if (!status || cancel_.cancelled()) break;
        }
      } catch (...) {
        const std::lock_guard lock{mutex_};
        if (!thrown_) thrown_ = std::current_exception();
        cancel_.request_cancel();
      }
      let_go(chain.front().scene);
    }
  }

  /// The next chain; none at the end, after an error, or when the user has interrupted.
  std::optional<std::size_t> take() {
    const std::lock_guard lock{mutex_};
    if (cancel_.cancelled() || next_ == chains_.size()) return std::nullopt;
    return next_++;
  }

  /// Goes on with the other chains where the run's scene is at fault, which they may not share.
  void fail(std::size_t chain, const PlannedRun& run, Error error) {
    constexpr std::size_t kAllFail{10};  // without one that succeeds
    const std::lock_guard lock{mutex_};
    --at_work_;
    ++failures_;
    if (error.code == Errc::io_failure || (done_ == 0 && failures_ >= kAllFail)) cancel_.request_cancel();
    if (error_ && failed_ <= chain) return;
    const std::string& scene = comparison_.scenes()[run.scene].name;
    error.context = error.context.empty() || error.context == scene ? scene : scene + ", " + error.context;
    error_ = std::move(error);
    failed_ = chain;
  }

  Status do_run(const PlannedRun& before, const Executor& executor) {
    PlannedRun run = before;
    {
      const std::lock_guard lock{mutex_};
      run = comparison_.plan_again(index_, before);  // sphere has been run by now
      ++at_work_;
      report(run);
    }
    const Stopwatch stopwatch;
    SACCADE_TRY(const GroundTruth truth, truth_of(run.scene, executor));
    CampaignEntry entry{comparison_.key_of(run), {}, 0.0, SACCADE_VERSION, {}};
    SACCADE_TRY(entry.run, run_simulated(truth, comparison_.config_of(run), executor, cancel_));
    entry.seconds = 1e-3 * stopwatch.elapsed_ms();
    const std::lock_guard lock{mutex_};
    if (entry.run.stopped_because != StopReason::cancelled) {
      SACCADE_CHECK(campaign_.add(entry));
      index_.add(entry.key, entry.run.views.size());
      ++done_;
    }
    --at_work_;
    return {};
  }

  /// The first error, and how many more there were.
  [[nodiscard]] Error failed_with(Error error) const {
    if (failures_ > 1) error.message += "; " + std::to_string(failures_ - 1) + " more failed";
    if (done_ > 0)
      error.message += "; " + std::to_string(done_) + (done_ == 1 ? " run was" : " runs were") + " done and kept";
    return error;
  }

  /// Reports that a run begins. The caller holds mutex_.
  void report(const PlannedRun& run) {
    std::string stage = comparison_.scenes()[run.scene].name + ", " + run.strategy.name;
    if (comparison_.options().noises.size() > 1) stage += ", " + run.noise;
    stage += ", seed " + std::to_string(run.seed);
    if (at_work_ > 1) stage += " and " + std::to_string(at_work_ - 1) + " more";
    if (done_ > 0) {
      const double left = static_cast<double>(total_ - found_ - done_);
      stage += ", about " + duration_text(1e-3 * clock_.elapsed_ms() / static_cast<double>(done_) * left) + " left";
    }
    progress_.update(stage, found_ + done_, total_);
  }

  /// Built by the first run that needs it; the others wait.
  Result<GroundTruth> truth_of(std::size_t scene, const Executor& executor) {
    SceneTruth& shared = truths_[scene];
    const std::lock_guard lock{shared.mutex};
    if (!shared.truth) {
      SACCADE_TRY(shared.truth, GroundTruth::build(comparison_.scenes()[scene].rays, kTruthSpacing_m, executor));
    }
    return *shared.truth;
  }

  /// A scene's truth goes with its last chain.
  void let_go(std::size_t scene) {
    SceneTruth& shared = truths_[scene];
    const std::lock_guard lock{shared.mutex};
    if (--shared.chains_left == 0) shared.truth.reset();
  }

  const Comparison& comparison_;
  CampaignIndex& index_;      ///< under mutex_
  const Campaign& campaign_;  ///< under mutex_
  ProgressBar& progress_;
  std::size_t total_;
  std::size_t found_{0};
  std::vector<Chain> chains_;
  std::vector<SceneTruth> truths_;
  std::size_t jobs_{1};
  std::size_t threads_of_job_{1};
  Progress cancel_;
  Stopwatch clock_;

  std::mutex mutex_;
  std::size_t next_{0};
  std::size_t at_work_{0};
  std::size_t done_{0};
  std::optional<Error> error_;
  std::size_t failed_{0};    ///< chain of the error
  std::size_t failures_{0};  ///< chains that ended with an error
  std::exception_ptr thrown_;
};

}  // namespace

Result<std::size_t> run_missing(const Comparison& comparison, const std::vector<PlannedRun>& runs, CampaignIndex& found,
                                const Campaign& campaign, std::size_t threads, ProgressBar& progress) {
  Jobs jobs{comparison, runs, found, campaign, threads, progress};
  if (jobs.found() > 0) {
    progress.note(std::to_string(jobs.found()) + " of " + std::to_string(runs.size()) + " runs found in " +
                  campaign.path().string());
  }
  return jobs.run();
}

}  // namespace saccade::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once
// Stopping: an additional condition for the end of a run. StopRule: ends it after a number of views.

#include <optional>

#include "saccade/explore/run_record.hpp"

namespace saccade {

class Stopping {
 public:
  virtual ~Stopping() = default;
  /// @return why the run ends here; nullopt: it continues. Called before each view.
  [[nodiscard]] virtual std::optional<StopReason> reached(const RunRecord& run) const = 0;
};

class StopRule final : public Stopping {
 public:
  explicit StopRule(std::size_t max_views) : max_views_{max_views} {}
  [[nodiscard]] std::optional<StopReason> reached(const RunRecord& run) const override {
    return run.views.size() < max_views_ ? std::nullopt : std::optional{StopReason::views_used_up};
  }

 private:
  std::size_t max_views_;
};

}  // namespace saccade

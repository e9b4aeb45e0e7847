// SPDX-License-Identifier: Apache-2.0
#pragma once
// Ranking: views worth trying, best first, and the regions that have none left. PlanningScene: the input of planning a
// view: the map, the robot, and earlier attempts.

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "saccade/attention/attention_source.hpp"
#include "saccade/attention/region_of_interest.hpp"
#include "saccade/explore/attempts.hpp"
#include "saccade/explore/run_record.hpp"
#include "saccade/robot/robot.hpp"

namespace saccade {

struct PlanningScene {
  const TsdfSnapshot& map;
  const Executor& executor;
  PhaseTimes* times{nullptr};             ///< nullptr: times are not measured
  const Robot* robot{nullptr};            ///< nullptr: every pose may be taken
  const Attempts* attempts{nullptr};      ///< nullptr: no attempts yet
  std::size_t first_region{0};            ///< regions of a lower index are done
  std::optional<PinholeCamera> sensor{};  ///< field of view and range of a view, tilts included; nullopt: unknown
  ViewDevice* device{nullptr};            ///< computes gains and expected surface; nullptr: the CPU does

  /// Returns the part of it for attention, view generator and gain.
  [[nodiscard]] PlanningContext context(std::size_t region = 0) const {
    PlanningContext context{map, executor, times, region, attempts != nullptr ? attempts->views_of(region) : 0};
    context.sensor = sensor;
    context.device = device;
    if (attempts != nullptr) {
      context.attempted = [tried = attempts, region](const Pose& pose) { return tried->contains(region, pose); };
      context.checked = attempts->checked();
    }
    if (robot != nullptr) {
      context.own_body = [carrier = robot](const PinholeCamera& seen_by) { return carrier->own_body(seen_by); };
    }
    return context;
  }

  /// Keeps the poses that the robot may take, in their order. Returns the reasons of the others. Costs microseconds per
  /// pose, less than casting its rays.
  [[nodiscard]] RefusalCounts remove_unreachable(std::vector<Pose>& T_world_camera) const;
};

/// Result of ranking the views of a map. Regions of one index (RegionOfInterest::index) are counted together.
class Ranking {
 public:
  /// @param min_gain  views that gain less are not worth taking
  explicit Ranking(double min_gain = 0.0) : min_gain_{min_gain} {}

  /// Tells whether views of the region might replace those found so far: a rival must be at least this salient,
  /// relative to the first region with a view worth trying. True while there is none.
  [[nodiscard]] bool competes(const RegionOfInterest& region, double rival_share) const;
  /// Adds the views of a region. The region is chosen if one of them is worth trying and gains more than those chosen
  /// before.
  void add(const RegionOfInterest& region, const ViewCandidates& found, const RefusalCounts& refused,
           RankedViews ranked, const PlanningScene& scene);
  /// Marks the end: all regions were added.
  void end(const PlanningScene& scene);

  /// Tells whether no view is worth trying.
  [[nodiscard]] bool empty() const { return untried_.empty(); }
  /// Returns the best view. Expects one.
  [[nodiscard]] const RankedView& best() const { return untried_.front(); }
  /// Returns the best view and those behind it with at least this share of its gain, at most 64. Returns one view at a
  /// time where views are not ranked by gain. Expects one view.
  [[nodiscard]] std::span<const RankedView> as_good_as_best(double share) const;
  /// Returns the views worth trying, by decreasing gain unless put_first() was called.
  [[nodiscard]] std::span<const RankedView> untried() const { return untried_; }
  /// Moves these views before all others, in their order. From then on views come one by one. Expects each once.
  void put_first(std::span<const std::size_t> views);
  /// Removes the first views, or one view, after they were tried.
  void drop_first(std::size_t count);
  void drop(std::size_t view);

  /// Returns the index of the region being explored.
  [[nodiscard]] std::size_t region() const { return index_; }
  /// Returns the regions that were left, with their results.
  [[nodiscard]] const std::vector<std::pair<std::size_t, RegionResult>>& left() const { return left_; }
  /// Returns the predicted gain of the best view not yet attempted; 0 where there is none.
  [[nodiscard]] double gain_left(const PlanningScene& scene) const;

  // Counts over the regions with the index being explored.
  [[nodiscard]] std::size_t candidates() const;
  [[nodiscard]] std::size_t evaluated() const { return evaluated_; }
  [[nodiscard]] const RefusalCounts& refused() const { return refused_; }

  /// Returns what a view of the chosen region is expected to make known; empty where unknown. Expects a view.
  [[nodiscard]] Promise promise(const Pose& T_world_camera) const;
  [[nodiscard]] bool makes_promises() const { return static_cast<bool>(ranked_.promise); }
  /// Return the choice that the views are part of, and the segment that drew the attention. Expect a view.
  [[nodiscard]] std::shared_ptr<const ViewChoice> choice() const;
  [[nodiscard]] std::optional<ViewAttention> attention() const;

 private:
  void begin(std::size_t index, const PlanningScene& scene);
  [[nodiscard]] bool gains_enough(const RankedView& view, bool by_gain, double least_gain) const {
    return !by_gain || view.gain >= std::max(min_gain_, least_gain);
  }
  [[nodiscard]] RegionResult result_of(const PlanningScene& scene) const;

  double min_gain_;
  bool begun_{false};  ///< a region was added
  std::size_t index_{0};
  std::size_t candidates_{0};
  std::size_t in_all_{0};
  std::size_t evaluated_{0};
  RefusalCounts refused_{};
  RankedViews ranked_{};  ///< views of the chosen region; of all regions of the index while none is chosen
  std::optional<RegionOfInterest> chosen_{};
  std::shared_ptr<const ContourSet> contours_{};
  double first_saliency_{0.0};  ///< saliency of the first region that was chosen
  std::vector<RankedView> untried_{};
  bool one_by_one_{false};  ///< whether the order differs from that of the gains
  std::vector<std::pair<std::size_t, RegionResult>> left_{};
};

}  // namespace saccade

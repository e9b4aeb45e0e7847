// SPDX-License-Identifier: Apache-2.0
#pragma once
// Ranking: views worth trying, the best first, and the regions that have none left; PlanningScene: what a view is
// planned with: the map, the robot, and what was attempted.

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
  PhaseTimes* times{nullptr};             ///< nullptr: times are not taken
  const Robot* robot{nullptr};            ///< nullptr: every pose may be taken
  const Attempts* attempts{nullptr};      ///< nullptr: there were none
  std::size_t first_region{0};            ///< regions of a lower index are done
  std::optional<PinholeCamera> sensor{};  ///< what a look takes in, its tilts included; nullopt: not known

  /// What attention, view generator and gain see of it.
  [[nodiscard]] PlanningContext context(std::size_t region = 0) const {
    PlanningContext context{map, executor, times, region, attempts != nullptr ? attempts->views_of(region) : 0};
    context.sensor = sensor;
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
  /// @param min_gain  views that gain less are not worth going to
  explicit Ranking(double min_gain = 0.0) : min_gain_{min_gain} {}

  /// Whether views of the region might be taken instead of those found so far: of a rival at least so salient, as a
  /// share of the first region that has a view worth trying. True while there is none.
  [[nodiscard]] bool competes(const RegionOfInterest& region, double rival_share) const;
  /// Adds the views of a region. The region is chosen if one of them is worth trying and gains more than those chosen
  /// before.
  void add(const RegionOfInterest& region, const ViewCandidates& found, const RefusalCounts& refused,
           RankedViews ranked, const PlanningScene& scene);
  /// All regions were added that are to be.
  void end(const PlanningScene& scene);

  /// Whether no view is worth trying.
  [[nodiscard]] bool empty() const { return untried_.empty(); }
  /// Expects one.
  [[nodiscard]] const RankedView& best() const { return untried_.front(); }
  /// The best view and those behind it that gain at least this share of it, 64 at most. Views that are not ranked by
  /// gain come one by one. Expects one view.
  [[nodiscard]] std::span<const RankedView> as_good_as_best(double share) const;
  /// The views that are worth trying, by decreasing gain unless put_first() was called.
  [[nodiscard]] std::span<const RankedView> untried() const { return untried_; }
  /// Puts these views before all others, in their order. From then on views come one by one. Expects each once.
  void put_first(std::span<const std::size_t> views);
  /// Takes out the first views, or one, once they were tried.
  void drop_first(std::size_t count);
  void drop(std::size_t view);

  /// Index of the region that is being looked at.
  [[nodiscard]] std::size_t region() const { return index_; }
  /// Regions that were left, with how each ended.
  [[nodiscard]] const std::vector<std::pair<std::size_t, RegionResult>>& left() const { return left_; }
  /// Predicted gain of the best view that was not attempted; 0: none.
  [[nodiscard]] double gain_left(const PlanningScene& scene) const;

  // Counts of the regions of the index that is looked at.
  [[nodiscard]] std::size_t candidates() const;
  [[nodiscard]] std::size_t evaluated() const { return evaluated_; }
  [[nodiscard]] const RefusalCounts& refused() const { return refused_; }

  /// What a view of the chosen region is expected to make known; nothing where that cannot be told. Expects a view.
  [[nodiscard]] Promise promise(const Pose& T_world_camera) const;
  [[nodiscard]] bool makes_promises() const { return static_cast<bool>(ranked_.promise); }
  /// What the views are chosen from, and the segment that drew the attention. Expects a view.
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
  bool one_by_one_{false};  ///< the order is not that of the gains
  std::vector<std::pair<std::size_t, RegionResult>> left_{};
};

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/label_seeds.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>

#include "saccade/annotate/annotation_error.hpp"
#include "saccade/annotate/shortest_path_forest.hpp"

namespace saccade {
namespace {

/// Largest ratio of region sizes within a round; smaller regions may well be right after it.
constexpr std::size_t kRoundRange{4};

Error no_seeds(std::string why) { return {Errc::invalid_argument, std::move(why), "seeds from labels"}; }

class Seeding {
 public:
  Seeding(std::shared_ptr<const Neighbourhood> neighbourhood, const PointCloud& cloud, std::vector<std::uint32_t> truth,
          const SeedConfig& config)
      : config_{config},
        forest_{std::move(neighbourhood)},
        truth_{std::move(truth)},
        ends_{cloud_ends(forest_.neighbourhood(), cloud.positions_m, cloud.normals)},
        labels_(truth_.size(), kNoLabel) {
    const auto unlabelled = std::count(truth_.begin(), truth_.end(), kNoLabel);
    found_.points = truth_.size() - static_cast<std::size_t>(unlabelled);
  }

  LabelSeeds run() {
    start();
    while (!is_enough() && round()) {
    }
    for (auto& [label, points] : seeds_) {
      std::sort(points.begin(), points.end());
      found_.actions.push_back({std::move(points), label, 0.0});
    }
    return std::move(found_);
  }

 private:
  [[nodiscard]] bool is_enough() const {
    return static_cast<double>(found_.reproduced) >= config_.share * static_cast<double>(found_.points);
  }
  [[nodiscard]] bool is_full(std::uint32_t label) const {
    const auto seeds = seeds_.find(label);
    return seeds != seeds_.end() && seeds->second.size() >= config_.most_per_label;
  }
  [[nodiscard]] std::vector<ErrorRegion> wrong_regions() const {
    return error_regions(forest_.neighbourhood(), labels_, truth_).value();
  }

  void start() {
    const auto tiny = static_cast<std::size_t>(forest_.neighbourhood().config().neighbours) + 1;
    std::vector<ErrorRegion> regions = wrong_regions();
    std::map<std::uint32_t, std::size_t> count_of;
    std::erase_if(regions, [&](const ErrorRegion& region) {  // the largest first
      std::size_t& count = count_of[region.truth];
      if (count == config_.most_per_label || (count > 0 && region.points.size() <= tiny)) return true;
      ++count;
      return false;
    });
    std::vector<Root> roots;
    const std::vector<std::uint32_t> centres = region_centres(forest_.neighbourhood(), ends_, regions);
    for (std::size_t i = 0; i < regions.size(); ++i) {
      roots.push_back({centres[i], 0.0});
      note_seed(centres[i], regions[i].truth);
    }
    forest_.rebuild(roots);
    relabel();
  }

  /// @return whether a control point was added.
  bool round() {
    std::vector<ErrorRegion> regions = wrong_regions();
    std::erase_if(regions, [this](const ErrorRegion& region) { return is_full(region.truth); });
    const std::vector<std::uint32_t> centres = region_centres(forest_.neighbourhood(), ends_, regions);
    std::size_t largest{0};  // region that was given a control point
    for (std::size_t i = 0; i < regions.size() && !is_enough(); ++i) {
      const std::uint32_t truth = regions[i].truth;
      if (regions[i].points.size() * kRoundRange < largest) break;
      if (labels_[centres[i]] == truth || is_full(truth) || forest_.is_root(centres[i])) continue;
      largest = std::max(largest, regions[i].points.size());
      note_seed(centres[i], truth);
      forest_.add({centres[i], 0.0});
      relabel();
    }
    return largest > 0;
  }

  void note_seed(std::uint32_t point, std::uint32_t label) {
    seeds_[label].push_back(point);
    label_of_root_[point] = label;
  }

  void relabel() {
    for (const std::uint32_t point : forest_.touched()) {
      found_.reproduced -= is_right(point) ? 1 : 0;
      labels_[point] = label_of_root_.at(*forest_.root_of(point));
      found_.reproduced += is_right(point) ? 1 : 0;
    }
  }
  [[nodiscard]] bool is_right(std::uint32_t point) const {
    return truth_[point] != kNoLabel && labels_[point] == truth_[point];
  }

  SeedConfig config_;
  ShortestPathForest forest_;
  std::vector<std::uint32_t> truth_;
  std::vector<std::uint8_t> ends_;
  std::vector<std::uint32_t> labels_;
  std::unordered_map<std::uint32_t, std::uint32_t> label_of_root_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> seeds_;  ///< by label
  LabelSeeds found_;
};

}  // namespace

Status SeedConfig::validate() const {
  if (!(share > 0.0 && share <= 1.0)) return no_seeds("the share to reproduce is above 0 and at most 1");
  if (most_per_label < 1) return no_seeds("a label needs at least one control point");
  return {};
}

Result<LabelSeeds> label_seeds(std::shared_ptr<const Neighbourhood> neighbourhood, const PointCloud& cloud,
                               std::span<const std::uint32_t> labels, const SeedConfig& config) {
  SACCADE_CHECK(config.validate());
  if (labels.size() != neighbourhood->size() || cloud.positions_m.size() != labels.size()) {
    return Error{Errc::size_mismatch, "there must be one label per point", "seeds from labels"};
  }
  std::vector<std::uint32_t> truth{labels.begin(), labels.end()};
  bool any{false};
  for (std::uint32_t point = 0; point < truth.size(); ++point) {
    if (truth[point] > kMaxLabel) return no_seeds("point " + std::to_string(point) + " has a label that is too large");
    if (neighbourhood->edges(neighbourhood->node_of(point)).empty()) truth[point] = kNoLabel;
    any = any || truth[point] != kNoLabel;
  }
  if (!any) return no_seeds("no point that has neighbours has a label");
  return Seeding{std::move(neighbourhood), cloud, std::move(truth), config}.run();
}

}  // namespace saccade

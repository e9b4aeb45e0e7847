// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/ranking.hpp"

#include <algorithm>

#include "saccade/attention/salient_objects.hpp"

namespace saccade {

bool Ranking::competes(const RegionOfInterest& region, double rival_share) const {
  return !chosen_ || (region.rival && !(region.saliency < rival_share * first_saliency_));
}

void Ranking::begin(std::size_t index, const PlanningScene& scene) {
  if (begun_) left_.emplace_back(index_, result_of(scene));
  Ranking next{min_gain_};
  next.index_ = index;
  next.begun_ = true;
  next.left_ = std::move(left_);
  *this = std::move(next);
}

void Ranking::add(const RegionOfInterest& region, const ViewCandidates& found, const RefusalCounts& refused,
                  RankedViews ranked, const PlanningScene& scene) {
  if (!begun_ || region.index != index_) begin(region.index, scene);
  const PlanningContext context = scene.context(index_);
  candidates_ += found.T_world_camera.size() + refused.total();
  in_all_ = std::max(in_all_, found.in_all);
  evaluated_ += ranked.evaluated;
  refused_.add(refused);
  contours_ = found.contours;
  std::vector<RankedView> untried;
  std::copy_if(ranked.views.begin(), ranked.views.end(), std::back_inserter(untried), [&](const RankedView& view) {
    return gains_enough(view, ranked.by_gain, ranked.least_gain) && !context.was_attempted(view.T_world_camera);
  });
  if (untried.empty()) {
    if (chosen_) return;
    ranked_.by_gain = ranked.by_gain;
    ranked_.least_gain = ranked.least_gain;
    ranked_.views.insert(ranked_.views.end(), ranked.views.begin(), ranked.views.end());
    return;
  }
  if (chosen_ && !(untried.front().gain > untried_.front().gain)) return;
  if (!chosen_) first_saliency_ = region.saliency;
  chosen_ = region;
  ranked_ = std::move(ranked);
  untried_ = std::move(untried);
}

void Ranking::end(const PlanningScene& scene) {
  if (begun_ && !chosen_) left_.emplace_back(index_, result_of(scene));
}

RegionResult Ranking::result_of(const PlanningScene& scene) const {
  RegionResult result;
  result.gain_left = gain_left(scene);
  result.gain_needed = std::max(min_gain_, ranked_.least_gain);
  const bool out_of_reach = ranked_.views.empty()
                                ? refused_.total() > 0
                                : std::any_of(ranked_.views.begin(), ranked_.views.end(), [&](const RankedView& view) {
                                    return gains_enough(view, ranked_.by_gain, ranked_.least_gain) &&
                                           scene.attempts != nullptr &&
                                           scene.attempts->was_refused(index_, view.T_world_camera);
                                  });
  result.status = out_of_reach ? RegionStatus::out_of_reach : RegionStatus::done;
  if (!out_of_reach) return result;
  result.refused = refused_;
  if (scene.attempts != nullptr) result.refused.add(scene.attempts->refusals_of(index_));
  return result;
}

double Ranking::gain_left(const PlanningScene& scene) const {
  const PlanningContext context = scene.context(index_);
  double gain = 0.0;
  for (const RankedView& view : ranked_.views) {
    if (view.gain > gain && !context.was_attempted(view.T_world_camera)) gain = view.gain;
  }
  return gain;
}

std::span<const RankedView> Ranking::as_good_as_best(double share) const {
  constexpr std::size_t kMost{64};
  const std::span<const RankedView> all{untried_};
  std::size_t count = 1;
  while (ranked_.by_gain && !one_by_one_ && count < std::min(kMost, all.size()) &&
         all[count].gain >= share * all[0].gain)
    ++count;
  return all.first(count);
}

void Ranking::put_first(std::span<const std::size_t> views) {
  std::vector<RankedView> ordered;
  std::vector<bool> is_first(untried_.size(), false);
  for (const std::size_t view : views) {
    ordered.push_back(untried_[view]);
    is_first[view] = true;
  }
  for (std::size_t i = 0; i < untried_.size(); ++i) {
    if (!is_first[i]) ordered.push_back(untried_[i]);
  }
  untried_ = std::move(ordered);
  one_by_one_ = true;
}

void Ranking::drop_first(std::size_t count) {
  untried_.erase(untried_.begin(), untried_.begin() + static_cast<std::ptrdiff_t>(count));
}

void Ranking::drop(std::size_t view) { untried_.erase(untried_.begin() + static_cast<std::ptrdiff_t>(view)); }

std::size_t Ranking::candidates() const { return std::max(candidates_, in_all_); }

Promise Ranking::promise(const Pose& T_world_camera) const {
  return ranked_.promise ? ranked_.promise(T_world_camera) : Promise{};
}

std::shared_ptr<const ViewChoice> Ranking::choice() const {
  SACCADE_EXPECTS(chosen_.has_value());
  ViewChoice choice;
  choice.region = chosen_->bounds;
  choice.candidates = ranked_.views;
  choice.surface = chosen_->surface;
  choice.contours = contours_;
  if (choice.surface) {
    if (chosen_->segment != RegionOfInterest::kAllSegments) choice.segment = chosen_->segment;
    for (const Saliency& saliency : choice.surface->saliency) choice.saliency.push_back(saliency.value);
  }
  return std::make_shared<const ViewChoice>(std::move(choice));
}

std::optional<ViewAttention> Ranking::attention() const {
  if (!chosen_ || !chosen_->surface || chosen_->segment == RegionOfInterest::kAllSegments) return std::nullopt;
  const SalientSurface& surface = *chosen_->surface;
  const std::uint32_t segment = chosen_->segment;
  ViewAttention attention;
  attention.segments = surface.saliency.size();
  attention.segment = segment;
  attention.rank =
      static_cast<std::size_t>(std::find(surface.order.begin(), surface.order.end(), segment) - surface.order.begin());
  attention.saliency = surface.saliency[segment].value;
  attention.why = surface.saliency[segment].why;
  if (!contours_) return attention;
  const std::vector<std::uint32_t>& owners = contours_->segment_of_point;
  attention.contours = contours_->points.size();
  attention.contours_of_segment = static_cast<std::size_t>(std::count(owners.begin(), owners.end(), segment));
  return attention;
}

}  // namespace saccade

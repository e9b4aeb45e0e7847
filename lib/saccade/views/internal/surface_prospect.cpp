// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/surface_prospect.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/attention/salient_objects.hpp"
#include "saccade/views/internal/state_volume.hpp"
#include "saccade/views/view_device.hpp"

namespace saccade {
namespace {

constexpr double kThroughAll_m{1e6};

/// Returns the saliency of the segment nearest to each place, as a share of the largest; 0: no segment is near.
std::vector<double> saliency_near(std::span<const Eigen::Vector3d> places_m, const SalientSurface& surface,
                                  const Executor& executor) {
  double most{0.0};
  for (const Saliency& saliency : surface.saliency) most = std::max(most, saliency.value);
  std::vector<double> weights;
  for (const std::uint32_t segment : nearest_segments(surface.points, places_m, executor)) {
    const bool counts = segment < surface.saliency.size() && most > 0.0;
    weights.push_back(counts ? surface.saliency[segment].value / most : 0.0);
  }
  return weights;
}

}  // namespace

Result<SurfaceProspect> SurfaceProspect::create(const PlanningContext& context, const RegionOfInterest& region,
                                                std::shared_ptr<const ExpectedSurface> surface,
                                                std::shared_ptr<const LinesOfSight> sight, const PinholeCamera& sensor,
                                                double doubtful_share) {
  SurfaceProspect prospect{std::move(surface), std::move(sight), sensor};
  prospect.doubtful_share_ = doubtful_share;
  const std::vector<ExpectedPoint>& points = prospect.surface_->points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (contains(region.bounds, points[i].position_m.cast<double>())) prospect.points_.push_back(i);
  }
  if (region.surface && region.segment == RegionOfInterest::kAllSegments) {
    std::vector<Eigen::Vector3d> places_m;
    for (const std::size_t j : prospect.points_) places_m.push_back(points[j].position_m.cast<double>());
    prospect.weights_ = saliency_near(places_m, *region.surface, context.executor);
  }
  const double through_m = doubtful_share > 0.0 ? kThroughAll_m : prospect.surface_->config.through_m;
  auto credit = std::make_shared<const Credit>(context.checked, sensor, *prospect.surface_->volume, through_m);
  if (!credit->is_full()) {
    prospect.in_sight_.resize(prospect.points_.size());
    context.executor.parallel_for(prospect.points_.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        prospect.in_sight_[i] = credit->seen_from(points[prospect.points_[i]].voxel);
      }
    });
  }
  prospect.credit_ = std::move(credit);
  if (context.own_body) {
    constexpr int kColumns{64};
    SACCADE_TRY(prospect.own_body_, context.own_body(sensor.scaled_to_width(std::min(kColumns, sensor.width))));
  }
  return prospect;
}

std::vector<SurfaceProspect::TileVisibility> SurfaceProspect::facing(const Eigen::Vector3d& camera_m) const {
  std::vector<TileVisibility> sights;
  const Eigen::Vector3f center = camera_m.cast<float>();
  const auto reach_m = 2.0F * static_cast<float>(sensor_.max_range_m);  // wider than any field of view
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const ExpectedPoint& point = surface_->points[points_[i]];
    if ((point.position_m - center).squaredNorm() > reach_m * reach_m) continue;
    if (surface_->faces(point, camera_m)) sights.push_back({&point, weighed_cm2(i), i});
  }
  return sights;
}

template <class Visit>
void SurfaceProspect::for_each_in_picture(std::span<const TileVisibility> sights, const Pose& T_world_camera,
                                          const Visit& visit) const {
  const Eigen::Isometry3f T_camera_world = T_world_camera.inverse(Eigen::Isometry).cast<float>();
  const auto fx = static_cast<float>(sensor_.fx);
  const auto fy = static_cast<float>(sensor_.fy);
  const auto left = static_cast<float>(-0.5 - sensor_.cx);
  const auto right = static_cast<float>(sensor_.width - 0.5 - sensor_.cx);
  const auto top = static_cast<float>(-0.5 - sensor_.cy);
  const auto bottom = static_cast<float>(sensor_.height - 0.5 - sensor_.cy);
  for (const TileVisibility& sight : sights) {
    const Eigen::Vector3f p = T_camera_world * sight.point->position_m;
    if (p.z() < static_cast<float>(sensor_.min_range_m) || p.z() > static_cast<float>(sensor_.max_range_m)) continue;
    const float u = fx * p.x();
    const float v = fy * p.y();
    if (u < left * p.z() || u >= right * p.z() || v < top * p.z() || v >= bottom * p.z()) continue;
    visit(sight, p);
  }
}

double SurfaceProspect::in_sight(const ExpectedPoint& point, const Outlook& outlook) const {
  if (outlook.sees(point, surface_->config.through_m)) return 1.0;
  return doubtful_share_ > 0.0 && outlook.sees(point, kThroughAll_m) ? doubtful_share_ : 0.0;
}

std::vector<SurfaceProspect::TileVisibility> SurfaceProspect::in_pictures(std::span<const Pose> T_world_camera) const {
  std::vector<TileVisibility> sights = facing(T_world_camera.front().translation());
  std::vector<std::uint8_t> in_a_picture(sights.size(), 0);
  for (const Pose& pose : T_world_camera) {
    for_each_in_picture(sights, pose, [&](const TileVisibility& sight, const Eigen::Vector3f&) {
      in_a_picture[static_cast<std::size_t>(&sight - sights.data())] = 1;
    });
  }
  std::size_t count{0};
  for (std::size_t i = 0; i < sights.size(); ++i) {
    if (in_a_picture[i] != 0) sights[count++] = sights[i];
  }
  sights.resize(count);
  return sights;
}

void SurfaceProspect::keep_visible(std::vector<TileVisibility>& sights, std::span<const double> shares,
                                   const Eigen::Vector3d& camera_m) const {
  std::size_t count{0};
  for (std::size_t i = 0; i < sights.size(); ++i) {
    if (shares[i] == 0.0) continue;
    TileVisibility sight = sights[i];
    sight.area_cm2 *= shares[i];
    if (!in_sight_.empty()) {
      sight.area_cm2 *= credit_->of(sight.point->position_m.cast<double>(), in_sight_[sight.number], camera_m);
    }
    sights[count++] = sight;
  }
  sights.resize(count);
}

std::vector<SurfaceProspect::TileVisibility> SurfaceProspect::visible(std::span<const Pose> T_world_camera) const {
  const Eigen::Vector3d camera_m = T_world_camera.front().translation();
  std::vector<TileVisibility> sights = in_pictures(T_world_camera);
  if (sights.empty()) return {};
  std::vector<const ExpectedPoint*> points;
  for (const TileVisibility& sight : sights) points.push_back(sight.point);
  const std::unique_ptr<const Outlook> outlook = sight_->from(camera_m, points);
  std::vector<double> shares(sights.size());
  std::transform(sights.begin(), sights.end(), shares.begin(),
                 [&](const TileVisibility& sight) { return in_sight(*sight.point, *outlook); });
  keep_visible(sights, shares, camera_m);
  return sights;
}

Result<std::vector<double>> SurfaceProspect::shares_on(ViewDevice& device,
                                                       std::span<const std::vector<TileVisibility>> sights,
                                                       std::span<const Eigen::Vector3d> cameras_m) const {
  std::vector<LineOfSight> lines;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    for (const TileVisibility& sight : sights[i]) lines.push_back({sight.point->voxel, static_cast<std::uint32_t>(i)});
  }
  const std::uint64_t ticket = surface_->volume->ticket();
  SACCADE_TRY(const std::vector<std::uint8_t> clear,
              device.in_sight(ticket, lines, cameras_m, surface_->config.through_m));
  std::vector<double> shares(clear.begin(), clear.end());
  if (doubtful_share_ == 0.0) return shares;
  std::vector<std::size_t> hidden;
  for (std::size_t i = 0; i < clear.size(); ++i) {
    if (clear[i] != 0) continue;
    lines[hidden.size()] = lines[i];
    hidden.push_back(i);
  }
  lines.resize(hidden.size());
  SACCADE_TRY(const std::vector<std::uint8_t> doubtful, device.in_sight(ticket, lines, cameras_m, kThroughAll_m));
  for (std::size_t i = 0; i < hidden.size(); ++i) shares[hidden[i]] = doubtful[i] != 0 ? doubtful_share_ : 0.0;
  return shares;
}

std::vector<std::vector<SurfaceProspect::TileVisibility>> SurfaceProspect::visible(
    std::span<const std::span<const Pose>> places, const Executor& executor, ViewDevice* device) const {
  std::vector<std::vector<TileVisibility>> sights(places.size());
  const auto for_each_place = [&](const auto& visit) {
    executor.parallel_for(places.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) visit(i);
    });
  };
  if (device != nullptr && surface_->volume->ticket() != 0) {
    std::vector<Eigen::Vector3d> cameras_m;
    for (const std::span<const Pose> place : places) cameras_m.emplace_back(place.front().translation());
    for_each_place([&](std::size_t i) { sights[i] = in_pictures(places[i]); });
    if (const Result<std::vector<double>> shares = shares_on(*device, sights, cameras_m); shares.ok()) {
      std::vector<std::size_t> first{0};
      for (const std::vector<TileVisibility>& of_place : sights) first.push_back(first.back() + of_place.size());
      for_each_place([&](std::size_t i) {
        keep_visible(sights[i], std::span{shares.value()}.subspan(first[i], sights[i].size()), cameras_m[i]);
      });
      return sights;
    }
  }
  for_each_place([&](std::size_t i) { sights[i] = visible(places[i]); });
  return sights;
}

double SurfaceProspect::area_in_picture(std::span<const TileVisibility> sights, const Pose& T_world_camera) const {
  double area_cm2{0.0};
  for_each_in_picture(sights, T_world_camera,
                      [&](const TileVisibility& sight, const Eigen::Vector3f&) { area_cm2 += sight.area_cm2; });
  return area_cm2;
}

Promise SurfaceProspect::promise(const Pose& T_world_camera) const {
  std::optional<DepthImage> body;
  if (own_body_) body = own_body_(T_world_camera);
  SACCADE_EXPECTS(!body || (body->width() > 0 && body->height() > 0));
  const auto is_behind_body = [&](const Eigen::Vector3f& p) {
    if (!body) return false;
    const Eigen::Vector2d pixel = sensor_.project(p.cast<double>());
    const double scale = static_cast<double>(body->width()) / static_cast<double>(sensor_.width);
    const int u = std::clamp(static_cast<int>((pixel.x() + 0.5) * scale), 0, body->width() - 1);
    const int v = std::clamp(static_cast<int>((pixel.y() + 0.5) * scale), 0, body->height() - 1);
    return (*body)(u, v) > 0.0F && (*body)(u, v) < p.z();
  };
  Promise promise;
  for_each_in_picture(visible(std::span{&T_world_camera, 1}), T_world_camera,
                      [&](const TileVisibility& sight, const Eigen::Vector3f& p) {
                        if (is_behind_body(p)) return;
                        promise.voxels.push_back({surface_->volume->voxel(sight.point->voxel), sight.area_cm2});
                      });
  return promise;
}

}  // namespace saccade

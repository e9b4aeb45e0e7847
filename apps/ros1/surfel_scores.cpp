// SPDX-License-Identifier: Apache-2.0
#include "surfel_scores.hpp"

#include <cmath>
#include <cstring>
#include <limits>

#include "plain_types.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/surfel/surfel_points.hpp"

namespace saccade::ros1 {
namespace {

constexpr std::uint8_t kUnknownGrey{96};

struct InFilter {
  std::optional<Region> region;
  [[nodiscard]] bool operator()(const PlainSurfel& surfel) const {
    return !region || contains(*region, {surfel.position[0], surfel.position[1], surfel.position[2]});
  }
};

Result<InFilter> make_filter(const SurfelFilter& filter, const char* name) {
  constexpr std::array<std::size_t, 3> kNumbers{0, 4, 6};
  if (filter.type >= kNumbers.size())
    return Error{Errc::invalid_argument, "there is no filter of type " + std::to_string(filter.type), name};
  if (filter.type == 0) return InFilter{};
  const std::vector<float>& d = filter.data;
  if (d.size() != kNumbers[filter.type]) {
    return Error{
        Errc::size_mismatch,
        "the filter needs " + std::to_string(kNumbers[filter.type]) + " numbers, not " + std::to_string(d.size()),
        name};
  }
  InFilter made;
  if (filter.type == 1) made.region = Sphere{{d[0], d[1], d[2]}, d[3]};
  if (filter.type == 2) made.region = Box{{d[0], d[1], d[2]}, {d[3], d[4], d[5]}};
  SACCADE_CHECK(validate(*made.region));
  return made;
}

/// Surfels that are present, in the renderer's format.
struct Discs {
  std::vector<Eigen::Vector3f> positions, normals;
  std::vector<float> radii;
  std::vector<const PlainSurfel*> surfels;
  std::vector<std::uint8_t> counts;

  Discs(const std::vector<PlainSurfel>& all, const InFilter& present, const InFilter& counted) {
    for (const PlainSurfel& surfel : all) {
      const Eigen::Vector3f normal{surfel.normal[0], surfel.normal[1], surfel.normal[2]};
      if (!present(surfel) || !(normal.norm() > 0.0F) || !(surfel.radius > 0.0F)) continue;
      positions.emplace_back(surfel.position[0], surfel.position[1], surfel.position[2]);
      normals.push_back(normal.normalized());
      radii.push_back(surfel.radius);
      surfels.push_back(&surfel);
      counts.push_back(counted(surfel) ? 1 : 0);
    }
  }
};

void paint(const SurfelQuestion& question, const PlainSurfel& surfel, float facing, std::uint8_t* pixel) {
  const float light = question.lighting ? facing : 1.0F;
  const auto lit = [&](std::uint8_t value) {
    return static_cast<std::uint8_t>(std::lround(light * static_cast<float>(value)));
  };
  if (!question.with_color) {
    *pixel = lit(surfel.unknown ? kUnknownGrey : 255);
    return;
  }
  for (int k = 0; k < 3; ++k) pixel[k] = lit(surfel.rgba[static_cast<std::size_t>(k)]);
  pixel[3] = 255;
}

SurfelScore score_view(const Discs& discs, const SurfelQuestion& question, const PinholeCamera& camera,
                       const Pose& T_world_camera, const Executor& executor) {
  const SurfelView view = view_surfels({discs.positions, discs.normals, discs.radii}, camera, T_world_camera, executor);
  const Eigen::Matrix3f R_camera_world = T_world_camera.linear().transpose().cast<float>();
  SurfelScore result;
  const std::size_t pixels = view.depth.size();
  const std::size_t channels = question.with_color ? 4 : 1;
  if (question.with_images) result.image.resize(channels * pixels);
  if (question.with_clouds) {
    result.cloud.fields = {"x", "y", "z", "intensity"};
    if (question.with_color) result.cloud.fields.emplace_back("rgba");
    result.cloud.width = static_cast<std::uint32_t>(camera.width);
    result.cloud.height = static_cast<std::uint32_t>(camera.height);
    result.cloud.values.assign(result.cloud.fields.size() * pixels, std::numeric_limits<float>::quiet_NaN());
  }
  std::array<double, 2> seen{}, surface{};  // known, unknown
  std::size_t hits{0};
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const SurfelId id = view.seen(u, v);
      const Eigen::Vector3d p = camera.ray(u, v) * static_cast<double>(view.depth(u, v));
      if (id == kNoSurfel || p.norm() < question.min_range || p.norm() > question.max_range) continue;
      ++hits;
      const PlainSurfel& surfel = *discs.surfels[id];
      const double along = std::abs((R_camera_world * discs.normals[id]).cast<double>().dot(camera.ray(u, v)));
      const auto at =
          static_cast<std::size_t>(v) * static_cast<std::size_t>(camera.width) + static_cast<std::size_t>(u);
      if (question.with_images)
        paint(question, surfel, static_cast<float>(along / camera.ray(u, v).norm()), &result.image[channels * at]);
      if (question.with_clouds) {
        float* point = &result.cloud.values[result.cloud.fields.size() * at];
        for (int k = 0; k < 3; ++k) point[k] = static_cast<float>(p[k]);
        point[3] = static_cast<float>(surfel.unknown ? -p.norm() : p.norm());
        if (question.with_color) {
          const std::array<std::uint8_t, 4> bgra{surfel.rgba[2], surfel.rgba[1], surfel.rgba[0], surfel.rgba[3]};
          std::memcpy(point + 4, bgra.data(), 4);
        }
      }
      if (discs.counts[id] == 0) continue;
      seen[surfel.unknown ? 1 : 0] += 1.0;
      surface[surfel.unknown ? 1 : 0] += p.z() * p.z() / (camera.fx * camera.fy * std::max(along, 1e-3));
    }
  }
  result.occupied = seen[0] * question.absolute_weight + surface[0] * question.distance_weight;
  result.unknown = seen[1] * question.absolute_weight + surface[1] * question.distance_weight;
  result.out_of_range = static_cast<double>(pixels - hits);
  result.score = question.occupied_score * result.occupied + question.unknown_score * result.unknown;
  return result;
}

Result<std::vector<SurfelScore>> score_views(const std::vector<PlainSurfel>& surfels, const SurfelQuestion& question,
                                             const std::vector<PlainPose>& poses, const std::atomic<bool>& cancelled) {
  if (question.camera.width > 8192 || question.camera.height > 8192)
    return Error{Errc::invalid_argument, "the image is wider or higher than 8192 pixels", {}};
  if (!(question.min_range >= 0.0) || !(question.max_range > question.min_range))
    return Error{Errc::invalid_argument, "range_max must be more than range_min, and that at least 0", {}};
  const PinholeCamera camera = to_camera(question.camera, 1e-6, std::max(1e-3, question.max_range));
  SACCADE_CHECK(camera.validate());
  SACCADE_TRY(const InFilter counted, make_filter(question.counted, "filter"));
  SACCADE_TRY(const InFilter present, make_filter(question.present, "input_filter"));
  const Discs discs{surfels, present, counted};
  const Executor executor = Executor::with_threads(0);
  std::vector<SurfelScore> scores;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (cancelled) return Error{Errc::cancelled, "the evaluation was cancelled", {}};
    const Result<Pose> pose = to_pose(poses[i]);
    if (!pose) return Error{pose.error().code, pose.error().message, "pose " + std::to_string(i)};
    scores.push_back(score_view(discs, question, camera, *pose, executor));
  }
  return scores;
}

}  // namespace

void SurfelScene::set(std::vector<PlainSurfel> surfels) {
  auto made = std::make_shared<const std::vector<PlainSurfel>>(std::move(surfels));
  const std::scoped_lock lock{mutex_};
  surfels_.swap(made);
}

std::string SurfelScene::evaluate(const SurfelQuestion& question, const std::vector<PlainPose>& poses,
                                  const std::atomic<bool>& cancelled, std::vector<SurfelScore>& scores) const {
  const auto surfels = [&] {
    const std::scoped_lock lock{mutex_};
    return surfels_;
  }();
  Result<std::vector<SurfelScore>> result = score_views(*surfels, question, poses, cancelled);
  if (!result) return result.error().to_string();
  scores = std::move(result).value();
  return {};
}

}  // namespace saccade::ros1

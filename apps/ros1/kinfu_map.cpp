// SPDX-License-Identifier: Apache-2.0
#include "kinfu_map.hpp"

#include <cmath>
#include <mutex>
#include <stdexcept>

#include "map_answers.hpp"
#include "plain_types.hpp"
#include "saccade/tracking/reconstruction.hpp"

namespace saccade::ros1 {
namespace {

constexpr double kLeastMotion_m{0.003};
constexpr double kLeastTurn_rad{0.006};
constexpr int kFramesPerMemoryCheck{30};
constexpr std::uint16_t kUploadedWeight{16};

std::string text_of(const Status& status) { return status ? std::string{} : status.error().to_string(); }

TsdfConfig map_config(const KinfuConfig& config) {
  if (config.volume_resolution == 0 || !(config.volume_size > 0.0)) {
    throw std::invalid_argument{"volume_size and volume_resolution must be positive"};
  }
  TsdfConfig map;
  map.voxel_size_m = config.volume_size / config.volume_resolution;
  map.truncation_vox = config.truncation > 0.0 ? config.truncation / map.voxel_size_m : 5.12;
  return map;
}

TsdfMap new_map(const TsdfConfig& config) {
  Result<TsdfMap> map = TsdfMap::create(config);
  if (!map) throw std::invalid_argument{map.error().to_string()};
  return std::move(map).value();
}

}  // namespace

struct KinfuMap::State {
  explicit State(const KinfuConfig& from) : config{from}, map{new_map(map_config(from))} {}

  KinfuConfig config;
  Executor executor{Executor::with_threads(0)};
  mutable std::mutex writer;  ///< held while the map is written
  TsdfMap map;
  std::optional<Pose> T_world_last;
  std::optional<Pose> T_world_fused;
  std::optional<Pose> T_world_start;  ///< start of tracking for the next frame
  std::optional<Eigen::Vector3d> volume_center;
  int frames{0};
  mutable std::mutex reader;  ///< guards the data that questions read besides the map
  std::optional<PlainCamera> camera;

  bool moved(const Pose& T_world_camera) const {
    if (!config.minimum_motion || !T_world_fused) return true;
    const Pose T_fused_camera = T_world_fused->inverse() * T_world_camera;
    return T_fused_camera.translation().norm() >= kLeastMotion_m ||
           rotation_angle_rad(T_fused_camera) >= kLeastTurn_rad;
  }

  Result<FrameReport> track(const Frame& frame, const PinholeCamera& sensor, Hint hint,
                            const std::optional<Pose>& pose) {
    FrameReport report;
    report.T_world_camera = T_world_last.value_or(Pose::Identity());
    if (hint == Hint::forced) {
      report.T_world_camera = *pose;
      return report;
    }
    const std::optional<Pose> start = pose ? pose : T_world_start;
    if (map.content().grid.empty()) {
      report.T_world_camera = start.value_or(Pose::Identity());
      return report;
    }
    return track_frame(map.content(), frame, sensor, start.value_or(report.T_world_camera), executor);
  }

  /// Returns the number of megabytes freed.
  double keep_within_limit() {
    if (config.memory_limit_mb <= 0.0 || !volume_center || ++frames % kFramesPerMemoryCheck != 0) return 0.0;
    const double before = static_cast<double>(map.content().grid.usage().bytes) * 1e-6;
    if (before <= config.memory_limit_mb) return 0.0;
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * config.volume_size);
    const IndexBox kept = parents(
        parents(voxels_with_center_in({*volume_center - half, *volume_center + half}, map.config().voxel_size_m)));
    const double edge_m = kSectorVoxelEdge * map.config().voxel_size_m;
    for (const Index3& key : map.content().grid.sorted_sectors()) {
      if (kept.contains(key)) continue;
      const Eigen::Vector3d min = Eigen::Vector3d{double(key.x), double(key.y), double(key.z)} * edge_m;
      static_cast<void>(map.forget(Box{min, min + Eigen::Vector3d::Constant(edge_m)}));
    }
    return before - static_cast<double>(map.content().grid.usage().bytes) * 1e-6;
  }

  std::string clear(const Region& region, bool to_empty) {
    if (const Status checked = validate(region); !checked) return text_of(checked);
    const std::scoped_lock lock{writer};
    return text_of(to_empty ? map.free(region) : map.forget(region));
  }
};

KinfuMap::KinfuMap(const KinfuConfig& config) : state_{std::make_unique<State>(config)} {}
KinfuMap::~KinfuMap() = default;

FrameOutcome KinfuMap::process(PlainFrame plain) {
  State& state = *state_;
  FrameOutcome outcome;
  const PinholeCamera sensor = to_camera(plain.camera, state.config.min_range, state.config.max_range);
  std::optional<Pose> pose;
  const auto fail = [&](const Error& error) {
    outcome.error = error.to_string();
    return outcome;
  };
  if (const Status checked = sensor.validate(); !checked) return fail(checked.error());
  if (plain.hint != Hint::none) {
    const Result<Pose> hint = to_pose(plain.pose);
    if (!hint) return fail({Errc::invalid_argument, "the pose hint is not a pose: " + hint.error().message, {}});
    pose = *hint;
  }
  Frame frame;
  frame.depth = DepthImage{sensor.width, sensor.height, std::move(plain.metres)};
  if (!plain.rgb.empty()) {
    frame.color.emplace(sensor.width, sensor.height);
    std::copy(plain.rgb.begin(), plain.rgb.end(), frame.color->data()->data());
  }
  const std::scoped_lock lock{state.writer};
  const Result<FrameReport> report = state.track(frame, sensor, plain.hint, pose);
  if (!report) return fail(report.error());
  outcome.track_ms = report->raycast_ms + report->track_ms;
  outcome.lost = report->status == FrameReport::Status::lost;
  outcome.why = report->why;
  if (!outcome.lost) {
    if (state.moved(report->T_world_camera)) {
      const Result<FusionStats> fused = state.map.integrate(sensor, frame.depth, report->T_world_camera, state.executor,
                                                            frame.color ? &*frame.color : nullptr);
      if (!fused) return fail(fused.error());
      outcome.fused = true;
      outcome.fuse_ms = fused->ms;
      state.T_world_fused = report->T_world_camera;
    }
    state.T_world_last = report->T_world_camera;
    state.T_world_start.reset();
  }
  outcome.pose = to_plain(state.T_world_last.value_or(Pose::Identity()));
  outcome.forgotten_mb = state.keep_within_limit();
  const std::scoped_lock reader{state.reader};
  state.camera = plain.camera;
  return outcome;
}

std::string KinfuMap::reset(const std::optional<PlainPose>& start) {
  std::optional<Pose> pose;
  if (start) {
    const Result<Pose> checked = to_pose(*start);
    if (!checked) return checked.error().to_string();
    pose = *checked;
  }
  const std::scoped_lock lock{state_->writer};
  state_->map = TsdfMap{TsdfSnapshot{state_->map.config(), {}}};
  state_->T_world_last.reset();
  state_->T_world_fused.reset();
  state_->T_world_start = pose;
  return {};
}

std::string KinfuMap::clear(const PlainSphere& region, bool to_empty) {
  return state_->clear(to_sphere(region), to_empty);
}
std::string KinfuMap::clear(const PlainBox& region, bool to_empty) { return state_->clear(to_box(region), to_empty); }
std::string KinfuMap::clear(const PlainCylinder& region, bool to_empty) {
  return state_->clear(Cylinder{to_vector(region.base), to_vector(region.top), region.radius}, to_empty);
}

std::string KinfuMap::upload(const MapUpload& upload) {
  const Box box = to_box(upload.box);
  if (const Status checked = validate(Region{box}); !checked) return text_of(checked);
  const double edge_m = voxel_size();
  const std::size_t known_count = std::size_t{upload.known_size[0]} * upload.known_size[1] * upload.known_size[2];
  if (!upload.known.empty()) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double count = std::floor((upload.box.max[axis] - upload.box.min[axis]) / edge_m + 0.5);
      if (count != upload.known_size[axis]) {
        return "known_voxelgrid has " + std::to_string(upload.known_size[axis]) + " voxels along axis " +
               std::to_string(axis) + ", the box " + std::to_string(static_cast<long>(count));
      }
    }
    if (known_count != upload.known.size())
      return "known_voxelgrid holds " + std::to_string(upload.known.size()) + " voxels, its dimensions " +
             std::to_string(known_count);
  }
  const std::scoped_lock lock{state_->writer};
  TsdfSnapshot content{state_->map.config(), upload.reset ? TsdfGrid{} : state_->map.content().grid};
  const auto write = [&](const Index3& voxel, Voxel value) {
    const Index3 brick = parent(voxel);
    Sector& sector = content.grid.writable(parent(brick));
    const int child = child_index(brick);
    BrickRef& ref = sector.bricks[static_cast<std::size_t>(child)];
    DenseBrick& dense = ref.dense() != nullptr ? ref.writable_dense() : ref.densify();
    const auto i = static_cast<std::size_t>(child_index(voxel));
    dense.v[i] = value.v;
    dense.w[i] = value.w;
    dense.unknown.assign(static_cast<int>(i), value.w == 0);
    dense.occupied.assign(static_cast<int>(i), state_of(value) == VoxelState::occupied);
    return IndexBox::cube(brick, 1);
  };
  IndexBox written;
  const std::uint16_t free_weight = content.config.free_weight;
  for (std::size_t i = 0; i < upload.known.size(); ++i) {
    if (upload.known[i] == 0) continue;
    const std::size_t nx = upload.known_size[0];
    const std::size_t ny = upload.known_size[1];
    const std::size_t x = i % nx;
    const std::size_t y = i / nx % ny;
    const std::size_t z = i / nx / ny;
    const Eigen::Vector3d cell{0.5 + double(x), 0.5 + double(y), 0.5 + double(z)};
    written = written.hull(write(voxel_at(box.min + edge_m * cell, edge_m), {kTsdfOne, free_weight}));
  }
  for (const auto& [x, y, z, value] : upload.points) {
    const Eigen::Vector3d p{x, y, z};
    if (!p.allFinite() || !std::isfinite(value) || !contains(box, p)) continue;
    const auto v = static_cast<std::int16_t>(std::lround(std::clamp(value, -1.0F, 1.0F) * float{kTsdfOne}));
    written = written.hull(write(voxel_at(p, edge_m), {v, v == kTsdfOne ? free_weight : kUploadedWeight}));
  }
  for (const Index3& key : content.grid.sorted_sectors()) {
    if (written.empty() || !parents(written).contains(key)) continue;
    Sector& sector = content.grid.writable(key);
    for (int i = 0; i < kSectorBricks; ++i) {
      if (!written.contains(key * kSectorEdge + child_offset(i))) continue;
      sector.bricks[static_cast<std::size_t>(i)].canonicalize(free_weight);
      sector.update_summary(i, free_weight);
    }
  }
  state_->map = TsdfMap{std::move(content)};
  return {};
}

void KinfuMap::set_minimum_motion(bool on) {
  const std::scoped_lock lock{state_->writer};
  state_->config.minimum_motion = on;
}
void KinfuMap::set_volume_center(const std::array<double, 3>& center) {
  const std::scoped_lock lock{state_->writer};
  state_->volume_center = to_vector(center);
}

std::optional<PlainCamera> KinfuMap::camera() const {
  const std::scoped_lock lock{state_->reader};
  return state_->camera;
}
double KinfuMap::voxel_size() const { return state_->map.config().voxel_size_m; }

MapAnswer KinfuMap::answer(const MapRequest& request, const std::atomic<bool>& cancelled) const {
  const TsdfSnapshot map = state_->map.snapshot();
  Source source{map, {}, state_->config.max_range, cancelled, Executor::with_threads(0)};
  if (const std::optional<PlainCamera> last = camera())
    source.sensor = to_camera(*last, state_->config.min_range, source.max_range_m);
  const Result<MapAnswer> answer = [&]() -> Result<MapAnswer> {
    SACCADE_CHECK(source.go_on());
    switch (request.question) {
      case Question::ping: return MapAnswer{};
      case Question::tsdf: return tsdf_answer(source, request);
      case Question::mesh:
      case Question::cloud: return mesh_answer(source, request);
      case Question::known: return known_answer(source, request);
      case Question::view: return view_answer(source, request);
      case Question::view_cloud: return view_cloud_answer(source, request);
      case Question::voxel_count:
      case Question::view_score: return views_answer(source, request);
      case Question::voxelgrid: return voxelgrid_answer(source, request);
      case Question::frontier_points:
      case Question::border_points:
      case Question::surface_points: return points_answer(source, request);
    }
    return Error{Errc::invalid_argument,
                 "there is no request of type " + std::to_string(static_cast<std::uint32_t>(request.question)),
                 {}};
  }();
  if (answer) return *answer;
  MapAnswer failed;
  failed.error = answer.error().to_string();
  failed.cancelled = answer.error().code == Errc::cancelled;
  return failed;
}

}  // namespace saccade::ros1

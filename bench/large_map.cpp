// SPDX-License-Identifier: Apache-2.0
// Maps that need more memory than they get: a building of furnished rooms, and what paging costs.
//   large_map ratio [ROUNDS]      fuses a storey's rooms with a tenth of the memory and with all of it, alternating
//   large_map frames DIR [ROOMS]  writes frames of the building, 40 × 30 × 6 m, for saccade fuse
//   large_map building MIB DIR [ROOMS]  fuses the building with so much memory for the map, and saves it to DIR
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "saccade/core/clock.hpp"
#include "saccade/core/seeded_random.hpp"
#include "saccade/core/statistics.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/frames/camera_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/io/frames/trajectory_io.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "saccade/io/maps/spill_file.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/sensor/analytic_scene.hpp"

namespace {

using namespace saccade;
namespace fs = std::filesystem;
using Eigen::Vector3d;

constexpr double kPitchX_m{40.0 / 6.0};
constexpr double kPitchY_m{30.0 / 5.0};
constexpr double kStorey_m{3.0};
constexpr std::size_t kColumns{6};
constexpr std::size_t kRows{5};
constexpr std::size_t kStoreys{2};
constexpr std::size_t kRooms{kColumns * kRows * kStoreys};
constexpr int kDirections{8};
constexpr double kVoxel_m{0.01};

/// Two storeys of five rows of six rooms, walked through row by row, to and fro.
Vector3d place_of(std::size_t room) {
  const std::size_t storey = room / (kColumns * kRows);
  const std::size_t row = room / kColumns % kRows;
  const std::size_t along = room % kColumns;
  const std::size_t column = row % 2 == 0 ? along : kColumns - 1 - along;
  return {(static_cast<double>(column) + 0.5) * kPitchX_m, (static_cast<double>(row) + 0.5) * kPitchY_m,
          static_cast<double>(storey) * kStorey_m};
}

PinholeCamera camera_of_building() {
  PinholeCamera camera;
  camera.width = 320;
  camera.height = 240;
  camera.fx = camera.fy = 220.0;
  camera.cx = 159.5;
  camera.cy = 119.5;
  camera.min_range_m = 0.3;
  camera.max_range_m = 5.0;
  return camera;
}

/// A room of 6.4 × 5.7 × 2.8 m around the middle of its floor, with furniture drawn from a seed: tables on legs,
/// shelves with boards, cupboards, lamps and balls.
class Room {
 public:
  explicit Room(std::uint64_t seed) : random_{seed} {
    const auto shell = [this](const Vector3d& lo, const Vector3d& hi) { add(Box{lo, hi}); };
    constexpr double kWall_m{0.1};
    const Vector3d half{kHalfX_m, kHalfY_m, 0.0};
    shell(-half - Vector3d{kWall_m, kWall_m, kWall_m}, half + Vector3d{kWall_m, kWall_m, 0.0});
    shell(-half + Vector3d{-kWall_m, -kWall_m, kHeight_m}, half + Vector3d{kWall_m, kWall_m, kHeight_m + kWall_m});
    for (const double side : {-1.0, 1.0}) {
      const Vector3d x{side * (kHalfX_m + kWall_m / 2.0), 0.0, kHeight_m / 2.0};
      const Vector3d y{0.0, side * (kHalfY_m + kWall_m / 2.0), kHeight_m / 2.0};
      const Vector3d across_x{kWall_m / 2.0, kHalfY_m, kHeight_m / 2.0};
      const Vector3d across_y{kHalfX_m, kWall_m / 2.0, kHeight_m / 2.0};
      shell(x - across_x, x + across_x);
      shell(y - across_y, y + across_y);
    }
    for (int i = 0; i < 4; ++i) add_table();
    for (int i = 0; i < 3; ++i) add_shelf();
    for (int i = 0; i < 6; ++i) add_small();
  }

  [[nodiscard]] const AnalyticScene& scene() const { return scene_; }
  /// Poses from which the room is scanned: from two stations all around, looking up and down in turn.
  [[nodiscard]] static std::vector<Pose> poses() {
    std::vector<Pose> poses;
    for (const double side : {-1.0, 1.0}) {
      const Vector3d from{side * 1.3, side * 0.9, 1.6};
      for (int i = 0; i < kDirections; ++i) {
        const double azimuth = 2.0 * std::numbers::pi * i / kDirections;
        const double height = i % 2 == 0 ? -0.4 : 0.3;
        poses.push_back(
            look_at(from, from + Vector3d{std::cos(azimuth), std::sin(azimuth), height}, Vector3d::UnitZ()));
      }
    }
    return poses;
  }

 private:
  static constexpr double kHalfX_m{3.2};
  static constexpr double kHalfY_m{2.85};
  static constexpr double kHeight_m{2.8};
  template <class Shape>
  void add(const Shape& shape) {
    scene_.objects.push_back({"body-" + std::to_string(scene_.objects.size()), shape});
  }
  /// A place on the floor that the camera does not stand in.
  Vector3d place() {
    const double x = random_.uniform(-kHalfX_m + 0.7, kHalfX_m - 0.7);
    const double y = random_.uniform(-kHalfY_m + 0.6, kHalfY_m - 0.6);
    return {x, y, 0.0};
  }
  void stand(const Vector3d& at, const Vector3d& size) {
    const Vector3d half{size.x() / 2.0, size.y() / 2.0, 0.0};
    add(Box{at - half, at + half + Vector3d{0.0, 0.0, size.z()}});
  }
  void add_table() {
    const Vector3d at = place();
    stand(at + Vector3d{0.0, 0.0, 0.7}, {1.2, 0.8, 0.04});
    for (const double x : {-0.5, 0.5}) {
      for (const double y : {-0.3, 0.3}) stand(at + Vector3d{x, y, 0.0}, {0.06, 0.06, 0.7});
    }
    stand(at + Vector3d{0.1, 0.1, 0.74}, {0.3, 0.2, random_.uniform(0.1, 0.4)});
  }
  void add_shelf() {
    Vector3d at = place();
    at.y() = kHalfY_m - 0.2;
    for (int board = 0; board < 5; ++board) stand(at + Vector3d{0.0, 0.0, 0.1 + 0.4 * board}, {1.0, 0.3, 0.03});
    for (const double x : {-0.5, 0.5}) stand(at + Vector3d{x, 0.0, 0.0}, {0.03, 0.3, 1.8});
  }
  void add_small() {
    const Vector3d at = place();
    add(Sphere{at + Vector3d{0.0, 0.0, 0.2}, random_.uniform(0.1, 0.2)});
    add(Cylinder{at + Vector3d{0.4, 0.0, 0.0}, at + Vector3d{0.4, 0.0, random_.uniform(0.3, 1.0)}, 0.08});
  }

  SeededRandom random_;
  AnalyticScene scene_;
};

struct View {
  Pose T_world_camera;
  DepthImage depth;
};

/// Calls body(view) for the views of a room, in the building's frame.
template <class Body>
Status for_each_view(std::size_t number, const Executor& executor, const Body& body) {
  const Room room{number + 1};
  Pose T_building_room{Pose::Identity()};
  T_building_room.translation() = place_of(number);
  for (const Pose& T_room_camera : Room::poses()) {
    SACCADE_TRY(RenderedFrame frame, render(room.scene(), camera_of_building(), T_room_camera, executor));
    SACCADE_CHECK(body(View{T_building_room * T_room_camera, std::move(frame.depth)}));
  }
  return {};
}

int fail(const Error& error) {
  std::fprintf(stderr, "%s\n", error.to_string().c_str());
  return 1;
}

/// Fuses all views; returns the milliseconds.
Result<double> fuse(TsdfMap& map, const std::vector<View>& views, const Executor& executor) {
  const Stopwatch stopwatch;
  for (const View& view : views) {
    SACCADE_CHECK(map.integrate(camera_of_building(), view.depth, view.T_world_camera, executor));
  }
  return stopwatch.elapsed_ms();
}

Status compare(int rounds) {
  const Executor executor = Executor::with_threads(0);
  std::vector<View> views;
  for (std::size_t room = 0; room < kColumns * 2; ++room) {
    const auto keep = [&](View view) {
      views.push_back(std::move(view));
      return Status{};
    };
    SACCADE_CHECK(for_each_view(room, executor, keep));
  }
  TsdfConfig config;
  config.voxel_size_m = kVoxel_m;
  std::vector<double> whole_ms;
  std::vector<double> tenth_ms;
  for (int round = 0; round < rounds; ++round) {
    SACCADE_TRY(TsdfMap whole, TsdfMap::create(config));
    SACCADE_TRY(const double ms, fuse(whole, views, executor));
    whole_ms.push_back(ms);
    const std::size_t needed = whole.content().grid.usage().bytes;
    SACCADE_TRY(const std::vector<std::byte> expected, encode_map(whole.content(), executor));
    whole = TsdfMap{TsdfSnapshot{config, {}}};

    SACCADE_TRY(TsdfMap paged, TsdfMap::create(config));
    SACCADE_TRY(auto store, SpillFile::create(fs::current_path()));
    SACCADE_CHECK(paged.keep_within({needed / 10, std::nullopt, store}));
    SACCADE_TRY(const double paged_ms, fuse(paged, views, executor));
    tenth_ms.push_back(paged_ms);
    SACCADE_TRY(const std::vector<std::byte> saved, encode_map(paged.content(), executor));
    if (saved != expected) return Error{Errc::corrupt_data, "the paged map differs", {}};
    const PagingStats stats = *paged.paging();
    std::printf(
        "round %d: %zu frames, %.0f MiB needed, %.1f ms a frame; a tenth: %.1f ms a frame, ratio %.2f, peak %.0f MiB, "
        "%zu sectors out, %zu in, %.0f MiB written, %.0f MiB read, file %.0f MiB\n",
        round + 1, views.size(), static_cast<double>(needed) / 1048576.0, ms / static_cast<double>(views.size()),
        paged_ms / static_cast<double>(views.size()), paged_ms / ms,
        static_cast<double>(stats.peak_map_bytes) / 1048576.0, stats.sectors_out, stats.sectors_in,
        static_cast<double>(stats.bytes_written) / 1048576.0, static_cast<double>(stats.bytes_read) / 1048576.0,
        static_cast<double>(store->file_bytes()) / 1048576.0);
    std::fflush(stdout);
  }
  std::printf("median ratio %.2f\n", median(tenth_ms) / median(whole_ms));
  return {};
}

double mebibytes(std::size_t bytes) { return static_cast<double>(bytes) / 1048576.0; }

/// Most memory of this process so far.
double peak_rss_mib() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

Status fuse_building(std::size_t memory_mib, const fs::path& folder, std::size_t rooms) {
  const Executor executor = Executor::with_threads(0);
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  TsdfConfig config;
  config.voxel_size_m = kVoxel_m;
  SACCADE_TRY(TsdfMap map, TsdfMap::create(config));
  SACCADE_TRY(auto store, SpillFile::create(folder));
  SACCADE_CHECK(map.keep_within({memory_mib << 20U, std::nullopt, store}));
  double fuse_ms{0.0};
  std::size_t frames{0};
  const auto integrate = [&](const View& view) -> Status {
    SACCADE_TRY(const FusionStats stats,
                map.integrate(camera_of_building(), view.depth, view.T_world_camera, executor));
    fuse_ms += stats.ms;
    ++frames;
    return {};
  };
  for (std::size_t room = 0; room < std::min(rooms, kRooms); ++room) {
    SACCADE_CHECK(for_each_view(room, executor, integrate));
    std::printf("room %zu: %.1f ms a frame, %.0f MiB in memory, peak of the process %.0f MiB\n", room + 1,
                fuse_ms / static_cast<double>(frames), mebibytes(map.paging()->map_bytes), peak_rss_mib());
    std::fflush(stdout);
  }
  const Stopwatch stopwatch;
  SACCADE_CHECK(save_map(map.content(), folder / "map.sacmap", executor));
  const TsdfGrid::Usage usage = map.content().grid.usage();
  const PagingStats stats = *map.paging();
  std::printf("%zu frames; the map needs %.0f MiB, at most %.0f MiB were in memory, peak of the process %.0f MiB\n",
              frames, mebibytes(usage.bytes + usage.away_bytes), mebibytes(stats.peak_map_bytes), peak_rss_mib());
  std::printf("%zu sectors out, %zu in, %.0f MiB written, %.0f MiB read, file %.0f MiB; saved in %.1f s\n",
              stats.sectors_out, stats.sectors_in, mebibytes(stats.bytes_written), mebibytes(stats.bytes_read),
              mebibytes(store->file_bytes()), stopwatch.elapsed_ms() / 1000.0);
  return {};
}

Status write_frame(const fs::path& folder, std::size_t index, const View& view) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "frame-%06zu", index);
  const fs::path depth = folder / (std::string{name.data()} + ".depth.png");
  SACCADE_CHECK(write_png16(depth, encode_depth(view.depth, DepthEncoding{})));
  return write_matrices(folder / (std::string{name.data()} + ".pose.txt"), std::array{view.T_world_camera});
}

Status write_frames(const fs::path& folder, std::size_t rooms) {
  const Executor executor = Executor::with_threads(0);
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  SACCADE_CHECK(write_json(folder / "camera.json", camera_to_json(camera_of_building())));
  std::size_t index{0};
  for (std::size_t room = 0; room < std::min(rooms, kRooms); ++room) {
    const auto write = [&](const View& view) { return write_frame(folder, index++, view); };
    SACCADE_CHECK(for_each_view(room, executor, write));
  }
  std::printf("%zu frames in %s\n", index, folder.c_str());
  return {};
}

std::size_t number_of(const char* text) { return static_cast<std::size_t>(std::max(1, std::atoi(text))); }

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "ratio") {
    const Status status = compare(argc > 2 ? std::atoi(argv[2]) : 3);
    return status.ok() ? 0 : fail(status.error());
  }
  if (what == "frames" && argc > 2) {
    const Status status = write_frames(argv[2], argc > 3 ? number_of(argv[3]) : kRooms);
    return status.ok() ? 0 : fail(status.error());
  }
  if (what == "building" && argc > 3) {
    const Status status = fuse_building(number_of(argv[2]), argv[3], argc > 4 ? number_of(argv[4]) : kRooms);
    return status.ok() ? 0 : fail(status.error());
  }
  std::fprintf(stderr, "large_map ratio [ROUNDS] | frames DIR [ROOMS] | building MIB DIR [ROOMS]\n");
  return 2;
}

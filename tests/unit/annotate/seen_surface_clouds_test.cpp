// SPDX-License-Identifier: Apache-2.0
// Areas on the surface of recorded clouds against a z-buffer that draws points as the page does.
#include <gtest/gtest.h>

#include <cstdio>

#include "saccade/annotate/selection.hpp"
#include "saccade/io/clouds/pcd_io.hpp"
#include "support/drawn_points.hpp"
#include "support/effort.hpp"
#include "support/naive_selection.hpp"
#include "support/places.hpp"

namespace saccade {
namespace {

constexpr int kCloudWidth{320};
constexpr int kCloudHeight{240};

std::vector<Eigen::Vector3f> recorded_points(const std::filesystem::path& file) {
  std::vector<Eigen::Vector3f> positions_m;
  const PcdFile pcd = read_pcd(file).value();
  const std::vector<float> x = pcd.table.find("x")->values<float>();
  const std::vector<float> y = pcd.table.find("y")->values<float>();
  const std::vector<float> z = pcd.table.find("z")->values<float>();
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::isfinite(x[i] + y[i] + z[i]) && z[i] > 0.1F) positions_m.emplace_back(x[i], y[i], z[i]);
  }
  return positions_m;
}

struct AreaCount {
  std::size_t seen{0}, taken{0};
};

/// Counts points with a pixel, and those of them that areas of a part of the picture take.
AreaCount count_areas(const std::vector<Eigen::Vector3f>& positions_m, const SelectionView& view, SurfaceRule rule) {
  const test::DrawnPoints drawn{positions_m, view};
  AreaCount count;
  for (int column = 0; column < 4; ++column) {
    const ScreenRectangle area{{20.0 + 70.0 * column, 40.0 + 30.0 * column},
                               {80.0 + 70.0 * column, 100.0 + 30.0 * column}};
    std::vector<bool> taken(positions_m.size());
    const auto selected = select_points(positions_m, view, area, kOnSurface_m, Executor{}, rule).value();
    for (const std::uint32_t point : selected) taken[point] = true;
    for (std::size_t i = 0; i < taken.size(); ++i) {
      if (drawn.pixels_of(i) == 0 || !drawn.is_in(i, area)) continue;
      count.seen += 1;
      count.taken += taken[i] ? 1 : 0;
    }
  }
  return count;
}

TEST(SeenSurface, AreasOfRecordedCloudsTakeWhatAZBufferShows) {
  const std::filesystem::path folder = test::shared_data() / "mosd_labelled" / "learn";
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "no " << folder;
  AreaCount all, printed;
  for (const char* name : {"learn0.pcd", "learn25.pcd"}) {
    const std::vector<Eigen::Vector3f> positions_m = recorded_points(folder / name);
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3f& p : positions_m) middle += p.cast<double>() / static_cast<double>(positions_m.size());
    const Pose aside = look_at(middle + Eigen::Vector3d{0.5, -0.4, -0.8}, middle);
    for (const Pose& T_world_camera : {Pose::Identity(), aside}) {
      for (const double focal_px : {260.0, 900.0}) {
        for (const int size : {1, 4, 8}) {
          if (test::kSanitized && size != 4) continue;
          SCOPED_TRACE(std::string{name} + ", " + std::to_string(focal_px) + " px, size " + std::to_string(size));
          const SelectionView view{test::perspective(T_world_camera, focal_px, kCloudWidth, kCloudHeight, 0.05, 20.0),
                                   kCloudWidth, kCloudHeight, size};
          const AreaCount count = count_areas(positions_m, view, SurfaceRule::seen);
          EXPECT_GE(static_cast<double>(count.taken), 0.95 * static_cast<double>(count.seen));
          all.seen += count.seen;
          all.taken += count.taken;
          if (size != 4) continue;
          const AreaCount before = count_areas(positions_m, view, SurfaceRule::as_printed);
          printed.seen += before.seen;
          printed.taken += before.taken;
        }
      }
    }
  }
  EXPECT_GT(all.seen, test::kSanitized ? 30'000U : 100'000U);
  EXPECT_LT(printed.taken, printed.seen / 5);  // what was wrong: overlapping squares hide their own surface
  std::printf("%zu of %zu seen points; as printed, 4 px: %zu of %zu\n", all.taken, all.seen, printed.taken,
              printed.seen);
}

}  // namespace
}  // namespace saccade

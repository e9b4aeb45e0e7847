// SPDX-License-Identifier: Apache-2.0
// Colour edges of recorded frames in surfel clouds: those of the mode filter beside the averages. Evidence runs it with
// all frames (SACCADE_SHARPNESS_FRAMES).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

#include "saccade/io/frames/rgbd_folder.hpp"
#include "saccade/surfel/mode_filter.hpp"
#include "saccade/surfel/surfel_fusion.hpp"
#include "saccade/surfel/surfel_points.hpp"
#include "support/color_edges.hpp"
#include "support/effort.hpp"
#include "support/places.hpp"

namespace saccade {
namespace {

using test::ColorEdge;
using test::edge_sharpness;
using test::EdgeSharpness;
using test::find_color_edges;
using test::luminance;

constexpr std::size_t kLookedAt{10};  ///< frames that edges are looked for in

std::size_t frames_to_fuse() {
  constexpr std::size_t kQuick{60};
  const char* const asked = std::getenv("SACCADE_SHARPNESS_FRAMES");
  return asked != nullptr ? std::stoul(asked) : kQuick;
}

/// Luminance of the surfels that a camera sees; NaN where there is none.
Image<float> rendered(const SurfelPoints& points, const PinholeCamera& camera, const Pose& T_world_camera,
                      const Executor& executor, double& covered) {
  const SurfelView view =
      view_surfels({points.positions_m, points.normals, points.radii_m}, camera, T_world_camera, executor);
  ColorImage colors{camera.width, camera.height};
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const SurfelId id = view.seen.pixels()[i];
    if (id == kNoSurfel) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      colors.data()[i][k] =
          static_cast<std::uint8_t>(std::lround(255.0F * points.colors[id][static_cast<Eigen::Index>(k)]));
    }
  }
  Image<float> result = luminance(colors);
  std::size_t seen{0};
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (view.seen.pixels()[i] == kNoSurfel)
      result.data()[i] = std::numeric_limits<float>::quiet_NaN();
    else
      ++seen;
  }
  covered += static_cast<double>(seen) / static_cast<double>(result.size());
  return result;
}

TEST(SurfelSharpness, ModesAreSharperThanAveragesOnRecordedFrames) {
  const auto folder = test::shared_data() / "rgbd_redkitchen";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  if (test::kSanitized) GTEST_SKIP() << "takes long under sanitizers";
  const Executor executor = Executor::with_threads(0);
  RgbdFolderConfig reading;
  reading.count = frames_to_fuse();
  auto source = open_rgbd_folder(folder, reading);
  ASSERT_TRUE(source);
  const PinholeCamera camera = (*source)->camera();
  SurfelFusion fusion = SurfelFusion::create().value();
  ModeFilter filter = ModeFilter::create().value();
  std::vector<Frame> looked_at;
  ASSERT_GE(*reading.count, kLookedAt);
  std::size_t frames{0};
  for (auto next = (*source)->next(); next.ok() && next->has_value(); next = (*source)->next()) {
    ASSERT_TRUE(fusion.add_frame(**next, camera, executor));
    ASSERT_TRUE(filter.add_frame(**next, fusion.association(), executor));
    if (frames++ % (*reading.count / kLookedAt) == 0) looked_at.push_back(std::move(**next));
    if (looked_at.size() > kLookedAt) looked_at.pop_back();
  }
  ASSERT_EQ(frames, *reading.count);
  ASSERT_EQ(looked_at.size(), kLookedAt);
  // As saccade surfels writes them.
  const double min_weight = std::min(10.0, 0.05 * static_cast<double>(frames));
  std::vector<SurfelMode> winners = filter.winners(executor);
  put_at_averages(winners, fusion.map());
  const std::array<SurfelPoints, 2> clouds{surfel_points(fusion.map(), {}, min_weight),
                                           surfel_points(fusion.map(), winners, min_weight)};
  std::array<EdgeSharpness, 3> mean{};
  std::array<double, 2> covered{};
  for (const Frame& frame : looked_at) {
    const std::vector<ColorEdge> edges = find_color_edges(*frame.color, frame.depth);
    std::array<Image<float>, 3> images;
    for (std::size_t i = 0; i < clouds.size(); ++i) {
      images[i] = rendered(clouds[i], camera, *frame.T_world_camera, executor, covered[i]);
    }
    images[2] = luminance(*frame.color);
    const std::vector<EdgeSharpness> found = edge_sharpness(edges, images);
    EXPECT_GT(found[0].edges, 1000U) << frame.name;
    EXPECT_GT(found[1].across, 1.3 * found[0].across) << frame.name;
    for (std::size_t i = 0; i < mean.size(); ++i) {
      mean[i].edges += found[i].edges;
      mean[i].across += found[i].across / static_cast<double>(kLookedAt);
      mean[i].along += found[i].along / static_cast<double>(kLookedAt);
    }
  }
  const EdgeSharpness& average = mean[0];
  const EdgeSharpness& modes = mean[1];
  std::cout << "sharpness: " << frames << " frames, " << average.edges << " edges in " << kLookedAt
            << " of them; rise per pixel across edges: average " << average.across << ", modes " << modes.across
            << ", image " << mean[2].across << "; along edges: " << average.along << ", " << modes.along << ", "
            << mean[2].along << "; pixels covered: " << covered[0] / kLookedAt << ", " << covered[1] / kLookedAt
            << std::endl;
  EXPECT_GT(modes.across, 1.5 * average.across);
  EXPECT_GT(modes.across - modes.along, 1.2 * (average.across - average.along)) << "more than noise and jags give";
  EXPECT_GT(covered[1], covered[0] - 0.002 * kLookedAt);
}

}  // namespace
}  // namespace saccade

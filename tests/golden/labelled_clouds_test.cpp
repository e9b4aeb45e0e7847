// SPDX-License-Identifier: Apache-2.0
// Supervoxels and LCCP on real clouds of tables with labelled objects (mOSD). PCL's on the same: program segmentation.

#include <gtest/gtest.h>

#include <iostream>

#include "saccade/segment/lccp.hpp"
#include "saccade/segment/overlap.hpp"
#include "support/effort.hpp"
#include "support/labelled_clouds.hpp"
#include "support/places.hpp"

namespace saccade {
namespace {

TEST(LabelledClouds, ObjectsAreSegments) {
  std::vector<test::LabelledCloud> clouds = test::labelled_clouds(test::shared_data());
  if (clouds.empty()) GTEST_SKIP() << "no labelled clouds in " << test::shared_data();
  if (test::kSanitized) clouds.resize(1);
  SupervoxelConfig config;
  config.voxels.single_camera = true;
  double all{0.0}, objects{0.0};
  for (const test::LabelledCloud& labelled : clouds) {
    const SupervoxelResult one = find_supervoxels(labelled.cloud, config, Executor{}).value();
    const SupervoxelResult three = find_supervoxels(labelled.cloud, config, Executor::with_threads(3)).value();
    EXPECT_EQ(one.labels, three.labels) << labelled.name;
    EXPECT_EQ(one.edges, three.edges) << labelled.name;
    const LccpResult segments = segment_by_convexity(one).value();
    all += score_segments(segments.labels, labelled.parts).value().weighted_overlap;
    objects += score_segments(segments.labels, labelled.parts, test::kFirstObjectPart).value().weighted_overlap;
  }
  all /= static_cast<double>(clouds.size());
  objects /= static_cast<double>(clouds.size());
  std::cout << clouds.size() << " clouds: weighted overlap of objects " << objects << ", of all " << all << "\n";
  EXPECT_GT(all, test::kSanitized ? 0.95 : 0.983);
  EXPECT_GT(objects, test::kSanitized ? 0.85 : 0.938);
}

}  // namespace
}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#include "table_options.hpp"

#include <algorithm>

namespace saccade::reproduce {
namespace {

constexpr std::size_t kQuickPoses{40};
constexpr std::size_t kQuickNoiseSeeds{2};
constexpr int kQuickWidth_px{96};
constexpr std::size_t kQuickFrames{40};
constexpr std::size_t kQuickPlacements{1};

}  // namespace

TableOptions quick_options(TableOptions given) {
  const TableOptions unset;
  if (given.poses == unset.poses) given.poses = kQuickPoses;
  if (given.noise_seeds == unset.noise_seeds) given.noise_seeds = kQuickNoiseSeeds;
  if (given.image_width_px == unset.image_width_px) given.image_width_px = kQuickWidth_px;
  if (given.frames == unset.frames) given.frames = kQuickFrames;
  if (given.placements == unset.placements) given.placements = kQuickPlacements;
  given.quick = true;
  return given;
}

std::string quick_note() {
  return "Quick (--quick), and so not what the thesis did: where a table has them, " + std::to_string(kQuickFrames) +
         " frames of a scan or scene, images " + std::to_string(kQuickWidth_px) + " pixels wide, " +
         std::to_string(kQuickPoses) + " view poses, " + std::to_string(kQuickNoiseSeeds) + " seeds of noise, " +
         std::to_string(kQuickPlacements) + " place of the grid of seeds; what was given by an option stays.";
}

}  // namespace saccade::reproduce

// SPDX-License-Identifier: Apache-2.0
#pragma once
// find_supervoxels: VCCS, patches of a cloud that respect surface borders. segment_by_convexity: LCCP, patches joined
// across convex edges. segment_by_sv_lccp: LCCP that also uses colours.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "saccade/cloud/point_cloud.hpp"
#include "saccade/cloud/voxel_cloud.hpp"
#include "saccade/core/angle.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

/// Parameters of find_supervoxels.
struct SupervoxelConfig {
  VoxelCloudConfig voxels{};
  double seed_spacing_m{0.03};  ///< edge length of the cells that get one seed each
  double spatial_weight{1.0};   ///< weight of the distance from the centre, in seed spacings
  double normal_weight{4.0};    ///< weight of 1 − cos of the angle between normals
  double color_weight{0.0};     ///< weight of the distance between colours
  double min_seed_share{
      0.3};       ///< share of the voxels that a plane fills within half a seed spacing; seeds with fewer are dropped
  int rounds{1};  ///< rounds of growth; before each but the first, supervoxels move to the means of their voxels
  bool seeds_settle{true};        ///< seeds move to where normals and colours change least; false: they stay
  double reach{2.0};              ///< steps of growth from voxel to voxel, in seed spacings
  bool moves_in_growth{false};    ///< supervoxels move to the means of their voxels after every step of growth, too
  bool opposite_is_alike{false};  ///< normals differ by 1 − |N₁ · N₂|, so that their sides do not matter

  /// @return invalid_argument for a number that is not finite or negative, all weights zero, seeds closer than voxels,
  /// a reach above 100, or rounds that are not from 1 to 100.
  [[nodiscard]] Status validate() const;
  /// Returns the number of voxels that a seed needs within half a seed spacing, which is given in voxels.
  [[nodiscard]] double fewest_around_seed(double spacing_vox) const;
};

/// Patch of a surface.
struct Supervoxel {
  Eigen::Vector3f centroid_m;  ///< mean of its voxels
  Eigen::Vector3f normal;      ///< mean of its voxels, of unit length
  Eigen::Vector3f color;       ///< mean of its voxels
  std::uint32_t voxels{0};
  std::uint32_t points{0};
};

/// Supervoxels of a cloud. Labels count from 0.
struct SupervoxelResult {
  std::vector<std::uint32_t> labels;  ///< one per point; kUnlabelled where it is no point
  std::vector<Supervoxel> supervoxels;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;  ///< touching supervoxels, (a, b) with a < b, sorted
  std::size_t voxels{0};
  double voxel_size_m{0.0};
};

/// Voxel cloud connectivity segmentation (Papon et al., CVPR 2013). Seeds on a regular grid, moved to where normals and
/// colours change least, grow from voxel to neighbouring voxel; each voxel goes to the nearest seed that reaches it.
/// With one round, seeds stay where they are, unlike the paper's: docs/guides/segmentation.md gives the reasons. A
/// connected part without a seed becomes a supervoxel of its own, so every point has a label.
/// @return an error of the cloud or the config. No points: no supervoxels. O(points + voxels × rounds). The thread
/// count never changes a bit of the result.
[[nodiscard]] Result<SupervoxelResult> find_supervoxels(const PointCloud& cloud, const SupervoxelConfig& config,
                                                        const Executor& executor);

/// Parameters of segment_by_convexity.
struct LccpConfig {
  double concavity_tolerance_rad{10_deg};  ///< a smaller angle between normals counts as convex
  bool sanity{true};                       ///< separates supervoxels that touch in one point only
  bool extended_convexity{false};          ///< a convex edge requires a third supervoxel with convex edges to both
  bool smooth{true};                       ///< separates supervoxels with a step between them
  double smoothness{0.1};                  ///< largest step allowed, in voxels
  std::size_t min_supervoxels{0};          ///< a segment with fewer joins the largest neighbouring one

  /// @return invalid_argument for a number that is not finite or negative.
  [[nodiscard]] Status validate() const;
};

/// Segments of supervoxels. Labels count from 0, in the order of their first supervoxels.
struct LccpResult {
  std::vector<std::uint32_t> labels;      ///< one per point; kUnlabelled where it is no point
  std::vector<std::uint32_t> segment_of;  ///< per supervoxel
  std::vector<bool> convex;               ///< per edge of the supervoxels: whether it joins them
  std::size_t segments{0};
};

/// Tells whether the edge between two touching supervoxels joins them (Stein et al., CVPR 2014, section 3), regardless
/// of common neighbours. Symmetric.
[[nodiscard]] bool is_convex(const Supervoxel& a, const Supervoxel& b, const LccpConfig& config, double voxel_size_m);

/// Returns the segments that result from convex and concave edges; `convex` has one entry per edge. Applies extended
/// convexity and the smallest size. O(points + edges · degree), one thread, deterministic.
[[nodiscard]] LccpResult join_convex(const SupervoxelResult& supervoxels, std::vector<bool> convex,
                                     const LccpConfig& config);

/// Locally convex connected patches (Stein et al., CVPR 2014). Edges between supervoxels are convex or concave by their
/// centroids and normals; convex edges connect the supervoxels of a segment.
/// @return invalid_argument for a bad config. O(points + edges · degree); one thread, deterministic.
[[nodiscard]] Result<LccpResult> segment_by_convexity(const SupervoxelResult& supervoxels,
                                                      const LccpConfig& config = {});

/// Parameters of segment_by_sv_lccp: thesis Table 4.2. Others are as for LCCP, except for the rounds, which are those
/// of the VCCS paper: a seed's own colour represents its surroundings worse than their mean does.
struct SvLccpConfig {
  SvLccpConfig();
  /// As the thesis has it (§4.1.2), "the Point Cloud Library implementation": what PCL 1.13 does where nothing is set.
  /// Seeds stay where they are, and fall away below a twentieth of a plane's voxels. Supervoxels grow once, move with
  /// every step, and reach eight voxels. Normals have no sides. LCCP is without sanity and smoothness (decision 41).
  [[nodiscard]] static SvLccpConfig as_printed();

  SupervoxelConfig supervoxels;  ///< V_lccp 1 cm, S_lccp 5 cm, weights α_p 0.1, α_n 0.5, α_c 1; 5 rounds
  LccpConfig lccp;
  double max_color_difference{0.1};  ///< T_lccp, for colours in [0, 1]

  /// @return an error of the parts; invalid_argument for a T_lccp that is negative or not a number.
  [[nodiscard]] Status validate() const;
};

struct SvLccpResult {
  SupervoxelResult supervoxels;  ///< with the remaining edges
  LccpResult segments;
};

/// Removes the edges between supervoxels whose colours differ too much: ‖c₁ − c₂‖ > T_lccp, thesis eq. (4.15). Removes
/// none where the cloud has no colours.
void prune_by_color(SupervoxelResult& supervoxels, double max_difference);

/// SV-LCCP with colours (thesis §4.1.2): find_supervoxels, prune_by_color, segment_by_convexity.
/// @return an error of the cloud or the config. O(points). The thread count never changes a bit of the result.
[[nodiscard]] Result<SvLccpResult> segment_by_sv_lccp(const PointCloud& cloud, const SvLccpConfig& config,
                                                      const Executor& executor);

}  // namespace saccade

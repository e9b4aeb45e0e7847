// SPDX-License-Identifier: Apache-2.0
#pragma once
// draw_attention, attention_picture, speed_plot: the way of a hand, what a detector made of it, and where it found the
// hand to have acted.

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "saccade/attention/dip_detector.hpp"
#include "saccade/report/sheet.hpp"
#include "saccade/report/viewpoint.hpp"
#include "saccade/sensor/hand_trajectory.hpp"
#include "saccade/sensor/image.hpp"

namespace saccade {

class Canvas;

/// A Gaussian as an ellipsoid of two standard deviations.
struct DrawnGaussian {
  Eigen::Vector3d mean_m{Eigen::Vector3d::Zero()};
  Eigen::Matrix3d covariance_m2{Eigen::Matrix3d::Zero()};
  bool is_poi{false};
};

/// Items to draw besides the trajectory; any part may be empty.
struct AttentionFindings {
  std::vector<DrawnGaussian> gaussians;
  std::vector<SmoothedPoint> motion;  ///< in which dips were looked for
  std::vector<Dip> dips;
  std::vector<HandAction> actions;  ///< points of interest, numbered in their order; numbers of near ones in one label
  std::vector<Eigen::Vector3d> labels_m;  ///< where the hand is known to have acted
};

/// Returns the meaning of the colours of draw_attention.
struct AttentionLegend {
  std::optional<ColorBar> time;  ///< time along the trajectory, in depth_colors(); nullopt: fewer than two samples
  std::vector<LegendEntry> entries;
};

/// Adds the trajectory coloured by time, over everything, and what was found, with a sphere of the region's radius
/// around each point of interest.
AttentionLegend draw_attention(Canvas& canvas, std::span<const HandSample> trajectory,
                               const AttentionFindings& findings, double region_radius_m);
/// Everything that draw_attention draws lies between these.
[[nodiscard]] std::vector<Eigen::Vector3d> attention_points(std::span<const HandSample> trajectory,
                                                            const AttentionFindings& findings, double region_radius_m);

/// Returns the colour of points of interest and their regions.
[[nodiscard]] Rgb8 poi_color();

struct AttentionPictureConfig {
  std::string title{"Trajectory of the hand"};
  std::string note;  ///< one line at the bottom
  double region_radius_m{0.2};
  OverviewConfig overview{};
};

/// The trajectory coloured by time, with a sphere of the region's radius around each point of interest. An empty
/// trajectory gives a picture that says so in its note. One thread.
[[nodiscard]] ColorImage attention_picture(std::span<const HandSample> trajectory, const AttentionFindings& findings,
                                           const AttentionPictureConfig& config = {});

/// The speed of findings.motion over the time since its start as SVG, with a stroke for each dip: from its bottom to
/// the lower of the two peaks beside it, which is how deep it is. Empty without motion.
[[nodiscard]] std::string speed_plot(const AttentionFindings& findings, const std::string& title);

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
// color_agreement DIR TRAJECTORY [GAP]: which camera poses agree with the colour images, those of the folder or those
// that tracking found (trajectory.txt of `saccade fuse`)? The tables of docs/guides/tracking.md. Depth tracking does
// not look at colours, so they are a witness of their own: points of one frame are put where the poses want them in the
// frame GAP (30) later, and their surroundings are looked for around there. What is missing, in pixels, is the error of
// poses, depths and of what is assumed of the colour camera; so that camera is varied. Exit status 77: DIR is not
// there.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/io/frames/rgbd_folder.hpp"
#include "saccade/io/frames/trajectory_io.hpp"

namespace {

using namespace saccade;

constexpr int kHalfPatch_px{6};
constexpr int kReach_px{24};       ///< searched in each direction
constexpr int kEvery_px{8};        ///< spacing of points in columns and rows
constexpr std::size_t kEvery{20};  ///< pairs begin at every 20th frame
constexpr float kLeastVariance{400.0F};
constexpr float kLeastCorrelation{0.85F};

/// A colour camera beside the depth camera, looking the same way.
struct ColorCamera {
  double fx, fy, cx, cy;
  double to_the_right_m;
};

/// Colour camera: the depth camera, if depth is registered; else that of a Kinect v1, by nominal values
/// of 525 px and 25 mm, either way round, and some more.
std::vector<ColorCamera> color_cameras(const PinholeCamera& depth) {
  std::vector<ColorCamera> cameras{{depth.fx, depth.fy, depth.cx, depth.cy, 0.0}};
  for (const double focal_px : {525.0, 515.0, 540.0}) {
    for (const double right_m : {0.0, 0.025, -0.025}) {
      cameras.push_back({focal_px, focal_px, 0.5 * depth.width, 0.5 * depth.height, right_m});
    }
  }
  return cameras;
}

struct View {
  DepthImage depth;
  Image<float> grey;
};

Image<float> to_grey(const ColorImage& colors) {
  Image<float> grey{colors.width(), colors.height()};
  for (std::size_t i = 0; i < grey.size(); ++i) {
    const Rgb8& c = colors.data()[i];
    grey.data()[i] = (static_cast<float>(c[0]) + 2.0F * static_cast<float>(c[1]) + static_cast<float>(c[2])) / 4.0F;
  }
  return grey;
}

struct Pixel {
  int u;
  int v;
};
bool within(const Image<float>& image, const Pixel& at, int border) {
  return at.u >= border && at.v >= border && at.u < image.width() - border && at.v < image.height() - border;
}

std::optional<Pixel> project(const ColorCamera& color, const PinholeCamera& depth, const Eigen::Vector3d& p_depth) {
  if (p_depth.z() < depth.min_range_m) return std::nullopt;
  const double x = p_depth.x() - color.to_the_right_m;
  return Pixel{static_cast<int>(std::lround(color.fx * x / p_depth.z() + color.cx)),
               static_cast<int>(std::lround(color.fy * p_depth.y() / p_depth.z() + color.cy))};
}

struct Moments {
  float mean{0.0F};
  float variance{0.0F};
};
Moments moments_around(const Image<float>& image, const Pixel& at) {
  constexpr float kCount{(2.0F * kHalfPatch_px + 1.0F) * (2.0F * kHalfPatch_px + 1.0F)};
  float sum{0.0F};
  float squares{0.0F};
  for (int y = -kHalfPatch_px; y <= kHalfPatch_px; ++y) {
    for (int x = -kHalfPatch_px; x <= kHalfPatch_px; ++x) {
      const float value = image(at.u + x, at.v + y);
      sum += value;
      squares += value * value;
    }
  }
  const float mean = sum / kCount;
  return {mean, squares / kCount - mean * mean};
}

float correlation(const Image<float>& from, const Pixel& at, const Moments& here, const Image<float>& to,
                  const Pixel& other) {
  constexpr float kCount{(2.0F * kHalfPatch_px + 1.0F) * (2.0F * kHalfPatch_px + 1.0F)};
  const Moments there = moments_around(to, other);
  float products{0.0F};
  for (int y = -kHalfPatch_px; y <= kHalfPatch_px; ++y) {
    for (int x = -kHalfPatch_px; x <= kHalfPatch_px; ++x) {
      products += from(at.u + x, at.v + y) * to(other.u + x, other.v + y);
    }
  }
  return (products / kCount - here.mean * there.mean) / std::sqrt(here.variance * there.variance + 1e-3F);
}

/// How far the surroundings of a pixel lie from where they should; none where they are not found for certain.
std::optional<double> displacement(const Image<float>& from, const Pixel& at, const Image<float>& to,
                                   const Pixel& expected) {
  if (!within(from, at, kHalfPatch_px) || !within(to, expected, kHalfPatch_px + kReach_px)) return std::nullopt;
  const Moments here = moments_around(from, at);
  if (here.variance < kLeastVariance) return std::nullopt;
  float best{kLeastCorrelation};
  Pixel found{kReach_px, kReach_px};
  for (int dv = -kReach_px; dv <= kReach_px; ++dv) {
    for (int du = -kReach_px; du <= kReach_px; ++du) {
      const float alike = correlation(from, at, here, to, {expected.u + du, expected.v + dv});
      if (alike <= best) continue;
      best = alike;
      found = {du, dv};
    }
  }
  if (std::abs(found.u) == kReach_px || std::abs(found.v) == kReach_px) return std::nullopt;
  return std::hypot(found.u, found.v);
}

/// Displacements of the points of one frame in another.
std::vector<double> displacements(const View& from, const View& to, const Pose& T_to_from, const PinholeCamera& camera,
                                  const ColorCamera& color) {
  std::vector<double> all;
  for (int v = 0; v < camera.height; v += kEvery_px) {
    for (int u = 0; u < camera.width; u += kEvery_px) {
      const double z = static_cast<double>(from.depth(u, v));
      if (!(z > 0.0)) continue;
      const Eigen::Vector3d p_from = camera.ray(u, v) * z;
      const auto at = project(color, camera, p_from);
      const auto expected = project(color, camera, T_to_from * p_from);
      if (!at || !expected) continue;
      if (const auto pixels = displacement(from.grey, *at, to.grey, *expected)) all.push_back(*pixels);
    }
  }
  return all;
}

double median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Sequence {
  PinholeCamera camera;
  std::vector<View> views;
  std::vector<Pose> given;
  std::vector<Pose> tracked;
};

Result<Sequence> read_sequence(const std::filesystem::path& folder, const std::filesystem::path& trajectory) {
  Sequence sequence;
  SACCADE_TRY(const auto source, open_rgbd_folder(folder));
  sequence.camera = source->camera();
  for (;;) {
    SACCADE_TRY(std::optional<Frame> frame, source->next());
    if (!frame) break;
    if (!frame->color || !frame->T_world_camera) return Error{Errc::not_found, "no colours or poses", folder.string()};
    sequence.views.push_back({std::move(frame->depth), to_grey(*frame->color)});
    sequence.given.push_back(*frame->T_world_camera);
  }
  SACCADE_TRY(sequence.tracked, read_poses(trajectory));
  if (sequence.tracked.size() != sequence.views.size()) {
    return Error{Errc::size_mismatch, "not a pose for every frame", trajectory.string()};
  }
  return sequence;
}

/// Displacements of one pair of frames: by the given poses, and by the tracked ones.
using PairOfFrames = std::array<std::vector<double>, 2>;

std::vector<PairOfFrames> measure(const Sequence& sequence, const ColorCamera& color, std::size_t gap,
                                  const Executor& executor) {
  std::vector<PairOfFrames> pairs((sequence.views.size() - gap + kEvery - 1) / kEvery);
  executor.parallel_for(pairs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t i = k * kEvery;
      const auto by = [&](const std::vector<Pose>& T_world) {
        return displacements(sequence.views[i], sequence.views[i + gap], T_world[i + gap].inverse() * T_world[i],
                             sequence.camera, color);
      };
      pairs[k] = {by(sequence.given), by(sequence.tracked)};
    }
  });
  return pairs;
}

std::array<double, 2> medians_of(const std::vector<PairOfFrames>& pairs) {
  PairOfFrames all;
  for (const PairOfFrames& pair : pairs) {
    for (std::size_t which : {0, 1}) all[which].insert(all[which].end(), pair[which].begin(), pair[which].end());
  }
  return {median(all[0]), median(all[1])};
}

std::size_t points_of(const std::vector<PairOfFrames>& pairs) {
  std::size_t count{0};
  for (const PairOfFrames& pair : pairs) count += pair[1].size();
  return count;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 3) {
    std::fprintf(stderr, "usage: color_agreement DIR TRAJECTORY [GAP]\n");
    return 2;
  }
  if (!std::filesystem::exists(arguments[1])) {
    std::printf("skipped, %s is not there\n", arguments[1]);
    return 77;
  }
  const std::size_t gap = count > 3 ? static_cast<std::size_t>(std::max(1, std::atoi(arguments[3]))) : 30;
  const auto sequence = read_sequence(arguments[1], arguments[2]);
  if (!sequence) {
    std::fprintf(stderr, "%s\n", sequence.error().to_string().c_str());
    return 3;
  }
  if (gap >= sequence->views.size()) {
    std::fprintf(stderr, "there are no frames so far apart\n");
    return 2;
  }
  const Executor executor = Executor::with_threads(0);
  std::vector<PairOfFrames> shown;
  std::array<double, 2> least{HUGE_VAL, HUGE_VAL};
  std::printf("| colour camera: focal length, to the right | points found | given poses, px | tracked, px |\n");
  std::printf("|---|---|---|---|\n");
  for (const ColorCamera& color : color_cameras(sequence->camera)) {
    std::vector<PairOfFrames> pairs = measure(*sequence, color, gap, executor);
    const auto [given, tracked] = medians_of(pairs);
    std::printf("| %.0f px, %.0f mm | %zu | %.2f | %.2f |\n", color.fx, 1e3 * color.to_the_right_m, points_of(pairs),
                given, tracked);
    if (given < least[0]) shown = std::move(pairs);  // what suits the given poses best
    least = {std::min(least[0], given), std::min(least[1], tracked)};
  }
  std::printf("| the best for each |  | %.2f | %.2f |\n\n", least[0], least[1]);
  if (shown.empty()) {
    std::fprintf(stderr, "no point was found again\n");
    return 5;
  }
  std::printf("| frames | points found | given poses, px | tracked, px |\n|---|---|---|---|\n");
  for (std::size_t k = 0; k < shown.size(); ++k) {
    std::printf("| %zu → %zu | %zu | %.1f | %.1f |\n", k * kEvery, k * kEvery + gap, shown[k][1].size(),
                median(shown[k][0]), median(shown[k][1]));
  }
  return 0;
}

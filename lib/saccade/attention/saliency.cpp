// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/saliency.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

namespace saccade {

namespace {

constexpr double kFlat{0.2};  // largest roundness of a support

std::string number(double value, int decimals) {
  std::array<char, 32> text{};
  const int length = std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return {text.data(), static_cast<std::size_t>(std::clamp(length, 0, 31))};
}
std::string percent(double share) { return number(100.0 * share, 0) + " %"; }
std::string centimetres(double length_m) { return number(100.0 * length_m, 1) + " cm"; }

/// Returns "21.0 × 14.2 × 9.1 cm"; "0.58 × 0.47 × 0.30 mm" of a speck below a centimetre.
std::string sizes_text(const SegmentMeasures& segment) {
  constexpr double kSpeck_m{0.01};
  Eigen::Vector3d sizes_m = segment.sizes_m;
  std::sort(sizes_m.begin(), sizes_m.end());
  if (sizes_m[2] < kSpeck_m) {
    return number(1000.0 * sizes_m[2], 2) + " × " + number(1000.0 * sizes_m[1], 2) + " × " +
           number(1000.0 * sizes_m[0], 2) + " mm";
  }
  return number(100.0 * sizes_m[2], 1) + " × " + number(100.0 * sizes_m[1], 1) + " × " + centimetres(sizes_m[0]);
}

std::string isolation_text(const MeasuredSegments& segments, std::size_t s) {
  return percent(segments.measures[s].isolation) + " of its points are farther than " +
         centimetres(segments.config.isolation_distance_m) + " from other segments";
}
std::string roundness_text(const SegmentMeasures& segment) {
  return "roundness " + number(segment.roundness, 2) + " (" + sizes_text(segment) + ")";
}

/// Rates each segment with points individually; one without points gets 0.
template <class Judge>
std::vector<Saliency> judge_each(const MeasuredSegments& segments, const Judge& judge) {
  std::vector<Saliency> saliencies(segments.measures.size(), {0.0, "has no points"});
  for (std::size_t s = 0; s < saliencies.size(); ++s) {
    if (segments.measures[s].points > 0) saliencies[s] = judge(s);
  }
  return saliencies;
}

double longest_m(const SegmentMeasures& segment) { return segment.sizes_m.maxCoeff(); }

/// Returns the area of the largest side of its oriented bounding box.
double extent_m2(const SegmentMeasures& segment) {
  const Eigen::Vector3d& d = segment.sizes_m;
  return std::max({d[0] * d[1], d[0] * d[2], d[1] * d[2]});
}

struct Support {
  Eigen::Vector3d normal;  ///< upwards, of unit length
  Eigen::Vector3d point_m;
  std::optional<std::size_t> segment;  ///< none: the level of the lowest point

  [[nodiscard]] double height_m(const Eigen::Vector3d& p_m) const { return normal.dot(p_m - point_m); }
};

Support find_support(const MeasuredSegments& segments, const HeightConfig& config) {
  const Eigen::Vector3d up = config.up.normalized();
  Support support{up, Eigen::Vector3d::Zero(), std::nullopt};
  double largest_m2{0.0};
  for (std::size_t s = 0; s < segments.measures.size(); ++s) {
    const SegmentMeasures& segment = segments.measures[s];
    const Eigen::Vector3d normal = segment.axes.col(0);
    const bool level = std::abs(normal.dot(up)) >= std::cos(config.level_rad);
    if (!level || segment.roundness >= kFlat || !(extent_m2(segment) > largest_m2)) continue;
    largest_m2 = extent_m2(segment);
    support = {normal.dot(up) < 0.0 ? Eigen::Vector3d{-normal} : normal, segment.mean_m, s};
  }
  if (support.segment) return support;
  double lowest_m{std::numeric_limits<double>::infinity()};
  for (std::size_t s = 0; s < segments.measures.size(); ++s) {
    for (const Eigen::Vector3f& p : segments.points.points_of(s)) {
      lowest_m = std::min(lowest_m, up.dot(p.cast<double>()));
    }
  }
  if (std::isfinite(lowest_m)) support.point_m = lowest_m * up;
  return support;
}

double share_inside(std::span<const Eigen::Vector3f> points_m, const Region& region) {
  const auto inside = std::count_if(points_m.begin(), points_m.end(), [&](const Eigen::Vector3f& p) {
    return contains(region, Eigen::Vector3d{p.cast<double>()});
  });
  return static_cast<double>(inside) / static_cast<double>(points_m.size());
}

bool is_positive(double value) { return std::isfinite(value) && value > 0.0; }

}  // namespace

SaliencyHeuristic objectness() {
  return [](const MeasuredSegments& segments) {
    return judge_each(segments, [&](std::size_t s) -> Saliency {
      const SegmentMeasures& segment = segments.measures[s];
      return {segment.isolation * segment.roundness, roundness_text(segment) + ", " + isolation_text(segments, s)};
    });
  };
}

SaliencyHeuristic roundness_alone() {
  return [](const MeasuredSegments& segments) {
    return judge_each(segments, [&](std::size_t s) -> Saliency {
      return {segments.measures[s].roundness, roundness_text(segments.measures[s])};
    });
  };
}

SaliencyHeuristic isolation_alone() {
  return [](const MeasuredSegments& segments) {
    return judge_each(segments, [&](std::size_t s) -> Saliency {
      return {segments.measures[s].isolation, isolation_text(segments, s)};
    });
  };
}

SaliencyHeuristic equally_salient() {
  return [](const MeasuredSegments& segments) {
    return std::vector<Saliency>(segments.measures.size(), {1.0, "as salient as any"});
  };
}

SaliencyHeuristic rough_first() {
  return [](const MeasuredSegments& segments) {
    double most_m{0.0};
    for (const SegmentMeasures& segment : segments.measures) most_m = std::max(most_m, longest_m(segment));
    return judge_each(segments, [&](std::size_t s) -> Saliency {
      const SegmentMeasures& segment = segments.measures[s];
      const double share = most_m > 0.0 ? longest_m(segment) / most_m : 0.0;
      const double object = segment.isolation * segment.roundness;
      return {(1.0 - object) * share, "as little of an object as " + number(1.0 - object, 2) + ", " +
                                          centimetres(longest_m(segment)) + " long: " + percent(share) +
                                          " of the longest segment"};
    });
  };
}

Status SizePriorConfig::validate() const {
  if (is_positive(size_m) && std::isfinite(factor) && factor > 1.0) return {};
  return Error{Errc::invalid_argument, "a size must be positive, its factor above 1", "size prior"};
}

SaliencyHeuristic size_prior(const SizePriorConfig& config) {
  SACCADE_EXPECTS(config.validate().ok());
  return [config](const MeasuredSegments& segments) {
    return judge_each(segments, [&](std::size_t s) -> Saliency {
      const double length_m = longest_m(segments.measures[s]);
      const std::string why = centimetres(length_m) + " long, " + centimetres(config.size_m) + " are looked for";
      if (!(length_m > 0.0)) return {0.0, why};
      const double deviations = std::log(length_m / config.size_m) / std::log(config.factor);
      return {std::exp(-0.5 * deviations * deviations), why};
    });
  };
}

Status HeightConfig::validate() const {
  if (up.allFinite() && up.norm() > 0.0 && is_positive(half_height_m) && is_positive(level_rad)) return {};
  return Error{Errc::invalid_argument, "needs a direction upwards, and a positive height and angle", "height"};
}

SaliencyHeuristic height_above_support(const HeightConfig& config) {
  SACCADE_EXPECTS(config.validate().ok());
  return [config](const MeasuredSegments& segments) {
    const Support support = find_support(segments, config);
    return judge_each(segments, [&](std::size_t s) -> Saliency {
      if (support.segment == s) return {0.0, "is the support"};
      const double height_m = support.height_m(segments.measures[s].mean_m);
      const char* const of = support.segment ? " the support" : " the lowest point";
      if (!(height_m > 0.0)) return {0.0, centimetres(-height_m) + " below" + of};
      return {height_m / (height_m + config.half_height_m), centimetres(height_m) + " above" + of};
    });
  };
}

SaliencyHeuristic inside_region(const Region& region) {
  SACCADE_EXPECTS(validate(region).ok());
  return [region](const MeasuredSegments& segments) {
    return judge_each(segments, [&](std::size_t s) -> Saliency {
      const double share = share_inside(segments.points.points_of(s), region);
      return {share, percent(share) + " of its points lie in the region asked for"};
    });
  };
}

SaliencyHeuristic weighted_blend(std::vector<BlendPart> parts) {
  SACCADE_EXPECTS(!parts.empty());
  double sum{0.0};
  for (const BlendPart& part : parts) {
    SACCADE_EXPECTS(is_positive(part.weight) && part.heuristic != nullptr);
    sum += part.weight;
  }
  return [parts = std::move(parts), sum](const MeasuredSegments& segments) {
    std::vector<Saliency> blended(segments.measures.size());
    for (const BlendPart& part : parts) {
      const std::vector<Saliency> judged = part.heuristic(segments);
      for (std::size_t s = 0; s < blended.size(); ++s) {
        blended[s].value += part.weight / sum * judged[s].value;
        blended[s].why += (blended[s].why.empty() ? "" : "; ") + percent(part.weight / sum) + " " + part.name + " " +
                          number(judged[s].value, 2) + ": " + judged[s].why;
      }
    }
    return blended;
  };
}

}  // namespace saccade

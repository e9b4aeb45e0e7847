// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/shortcut.hpp"

#include "saccade/core/seeded_random.hpp"

#include <algorithm>

namespace saccade {
namespace {

using MotionIsFree = std::function<bool(const Configuration& from, const Configuration& to)>;

/// Smallest saving of a chord that is worth its corner.
constexpr double kLeastSaving_s{1e-3};

/// Goes from each configuration straight to the last one reachable that way.
JointPath skip_corners(const JointPath& path, const MotionIsFree& motion_is_free) {
  JointPath kept{path.front()};
  for (std::size_t here = 0; here + 1 < path.size();) {
    std::size_t next = path.size() - 1;
    while (next > here + 1 && !motion_is_free(path[here], path[next])) --next;
    kept.push_back(path[next]);
    here = next;
  }
  return kept;
}

/// Path with its timing, to find points on it by their share of the whole.
class TimedPath {
 public:
  TimedPath(const ArmModel& arm, JointPath path) : arm_{arm}, path_{std::move(path)} { measure(); }

  struct Point {
    std::size_t line;  ///< from configuration `line` to the next
    Configuration q;
  };
  [[nodiscard]] Point at(double share) const {
    double t_s = share * total_s_;
    std::size_t line = 0;
    while (line + 1 < lines_s_.size() && t_s > lines_s_[line]) t_s -= lines_s_[line++];
    const double along = lines_s_[line] > 0.0 ? std::clamp(t_s / lines_s_[line], 0.0, 1.0) : 0.0;
    return {line, path_[line] + along * (path_[line + 1] - path_[line])};
  }
  /// Returns the path with a chord from a to b; a lies before b on an earlier line.
  [[nodiscard]] JointPath with_chord(const Point& a, const Point& b) const {
    JointPath chord{path_.begin(), path_.begin() + static_cast<std::ptrdiff_t>(a.line) + 1};
    chord.push_back(a.q);
    chord.push_back(b.q);
    chord.insert(chord.end(), path_.begin() + static_cast<std::ptrdiff_t>(b.line) + 1, path_.end());
    return chord;
  }
  void take(JointPath path) {
    path_ = std::move(path);
    measure();
  }
  [[nodiscard]] double total_s() const { return total_s_; }
  [[nodiscard]] const JointPath& path() const { return path_; }

 private:
  void measure() {
    lines_s_.clear();
    total_s_ = 0.0;
    for (std::size_t i = 0; i + 1 < path_.size(); ++i) {
      lines_s_.push_back(rest_to_rest_s(arm_, path_[i], path_[i + 1]));
      total_s_ += lines_s_.back();
    }
  }
  const ArmModel& arm_;
  JointPath path_;
  std::vector<double> lines_s_;
  double total_s_{0.0};
};

}  // namespace

JointPath shortcut(const ArmModel& arm, JointPath path, const MotionIsFree& motion_is_free, int tries,
                   std::uint64_t seed) {
  if (path.size() < 3) return path;
  TimedPath best{arm, skip_corners(path, motion_is_free)};
  SeededRandom random{seed};
  for (int idle = 0; idle < tries && best.path().size() > 2; ++idle) {
    const double u = random.unit();
    const double v = random.unit();
    const TimedPath::Point a = best.at(std::min(u, v));
    const TimedPath::Point b = best.at(std::max(u, v));
    if (a.line == b.line) continue;
    JointPath chord = best.with_chord(a, b);
    if (rest_to_rest_s(arm, chord) > best.total_s() - kLeastSaving_s || !motion_is_free(a.q, b.q)) continue;
    best.take(std::move(chord));
    idle = -1;
  }
  return best.path();
}

}  // namespace saccade

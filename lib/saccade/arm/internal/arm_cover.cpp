// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/arm_cover.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace saccade {
namespace {

/// Balls of one arm, without the padding of blocks.
constexpr std::size_t kFrontBalls{40};
static_assert(ArmCover::kFinerBalls % arm::kBlock == 0 && ArmCover::kFinerBalls <= 64);
constexpr float kBoxSlack_m{1e-6F};

struct Candidate {
  FrontBall origin;
  TreeBall ball;
};

using Covers = std::vector<std::vector<SphereTree>>;

/// Replaces the largest ball above the finest level by those below it; false when there is none.
bool split_largest(std::vector<Candidate>& balls, const Covers& covers) {
  const auto worth = [](const Candidate& c) { return c.ball.finest ? 0.0F : c.ball.radius_m; };
  const auto largest = std::max_element(balls.begin(), balls.end(),
                                        [&](const Candidate& a, const Candidate& b) { return worth(a) < worth(b); });
  if (largest == balls.end() || largest->ball.finest) return false;
  const Candidate split = *largest;
  balls.erase(largest);
  const auto tree = covers[split.origin.link][split.origin.body].balls();
  for (std::uint32_t i = split.origin.index + 1; i < split.ball.next; i = tree[i].next) {
    balls.push_back({{split.origin.link, split.origin.body, i}, tree[i]});
  }
  return true;
}

/// Splits while there is room, then pads with copies of the last ball.
void fill(std::vector<Candidate>& balls, std::size_t count, const Covers& covers) {
  for (std::vector<Candidate> finer = balls; split_largest(finer, covers) && finer.size() <= count;) balls = finer;
  while (balls.size() < count) balls.push_back(balls.back());
}

/// Returns for each link balls of about equal size over the whole arm, in whole blocks.
std::vector<std::vector<Candidate>> choose(const Covers& covers) {
  std::vector<Candidate> all;
  for (std::size_t link = 1; link < covers.size(); ++link) {
    for (std::size_t body = 0; body < covers[link].size(); ++body) {
      all.push_back({{link, body, 0}, covers[link][body].balls().front()});
    }
  }
  while (all.size() < kFrontBalls && split_largest(all, covers)) {
  }
  std::vector<std::vector<Candidate>> per_link(covers.size());
  for (const Candidate& candidate : all) per_link[candidate.origin.link].push_back(candidate);
  for (std::vector<Candidate>& some : per_link) {
    fill(some, (some.size() + arm::kBlock - 1) / arm::kBlock * arm::kBlock, covers);
  }
  return per_link;
}

arm::Frame frame_of(const Eigen::Matrix4d& T) {
  const Eigen::Matrix4f rounded = T.cast<float>();
  arm::Frame frame;
  std::copy_n(rounded.data(), frame.size(), frame.begin());
  return frame;
}

/// Returns the terms of Rodrigues' formula, sorted by their dependence on the joint.
arm::JointTerms terms_of(const ArmJoint& joint) {
  const Eigen::Vector3d& a = joint.axis_joint;
  const Eigen::Matrix4d& before = joint.T_parent_joint.matrix();
  Eigen::Matrix4d by_cosine = Eigen::Matrix4d::Zero();
  Eigen::Matrix4d by_sine = Eigen::Matrix4d::Zero();
  Eigen::Matrix4d fixed = Eigen::Matrix4d::Identity();
  if (joint.kind == JointKind::prismatic) {
    by_cosine.col(3).head<3>() = a;
  } else {
    fixed.topLeftCorner<3, 3>() = a * a.transpose();
    by_cosine.topLeftCorner<3, 3>() = Eigen::Matrix3d::Identity() - a * a.transpose();
    by_sine.topLeftCorner<3, 3>() << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  }
  return {frame_of(before * fixed), frame_of(before * by_cosine), frame_of(before * by_sine)};
}

/// Reduces an angle by whole turns, so that float suffices.
double reduced(double angle_rad) {
  constexpr double kTurn{2.0 * std::numbers::pi};
  return std::fabs(angle_rad) > kTurn ? std::remainder(angle_rad, kTurn) : angle_rad;
}

arm::FrameBox frame_box(const Eigen::AlignedBox3d& box) {
  const Eigen::Vector3f center = box.center().cast<float>();
  const Eigen::Vector3f half = (0.5 * box.sizes()).cast<float>() + Eigen::Vector3f::Constant(kBoxSlack_m);
  return {{center.x(), center.y(), center.z()}, {half.x(), half.y(), half.z()}};
}

}  // namespace

ArmCover::ArmCover(const ArmModel& arm, const Covers& covers,
                   const std::vector<std::vector<Eigen::AlignedBox3d>>& boxes,
                   const std::vector<std::pair<int, int>>& self_pairs, double slack_m)
    : slack_m_{slack_m}, base_{frame_of(arm.T_world_base().matrix())} {
  for (const ArmJoint& joint : arm.joints()) {
    joints_.push_back(terms_of(joint));
    slides_.push_back(joint.kind == JointKind::prismatic);
  }
  const std::vector<std::vector<Candidate>> per_link = choose(covers);
  std::vector<std::size_t> first_block(covers.size() + 1, 0);  // hand first: block numbers decrease with the link's
  for (std::size_t link = covers.size(); link-- > 0;) {
    first_block[link] = coarse_.links.size();
    for (const Candidate& candidate : per_link[link]) {
      coarse_.add(candidate.origin, candidate.ball, static_cast<float>(slack_m));
      std::vector<Candidate> finer{candidate};
      fill(finer, ArmCover::kFinerBalls, covers);
      for (const Candidate& below : finer) fine_.add(below.origin, below.ball, static_cast<float>(slack_m));
    }
  }
  std::vector<std::size_t> first_box{0};
  for (const std::vector<Eigen::AlignedBox3d>& of_link : boxes) {
    for (const Eigen::AlignedBox3d& box : of_link) boxes_.push_back(frame_box(box));
    first_box.push_back(boxes_.size());
  }
  for (const auto& [a, b] : self_pairs) {
    const auto link_a = static_cast<std::size_t>(a);
    const auto link_b = static_cast<std::size_t>(b);
    const std::size_t blocks = per_link[link_b].size() / arm::kBlock;
    pairs_.push_back(
        {link_a, first_box[link_a], first_box[link_a + 1], first_block[link_b], first_block[link_b] + blocks});
  }
}

void ArmCover::Level::add(const FrontBall& ball, const TreeBall& of_cover, float slack_m) {
  if (balls.size() % arm::kBlock == 0) links.push_back(static_cast<std::uint8_t>(ball.link));
  balls.push_back(ball);
  x_m.push_back(of_cover.center.x());
  y_m.push_back(of_cover.center.y());
  z_m.push_back(of_cover.center.z());
  radius_m.push_back(of_cover.radius_m + slack_m);
}

PlacedFront::PlacedFront(const ArmCover& front, const ArmPoses& poses) : front_{front} {
  for (std::size_t link = 0; link <= front.joints_.size(); ++link) {
    frames_[link] = frame_of(poses.T_world_link[link].matrix());
  }
  place();
}

PlacedFront::PlacedFront(const ArmCover& front, const Configuration& q) : front_{front} {
  std::array<float, kMaxJoints> cosines;
  std::array<float, kMaxJoints> sines;
  for (std::size_t i = 0; i < front.joints_.size(); ++i) {
    const double value = q[static_cast<Eigen::Index>(i)];
    const auto angle_rad = static_cast<float>(reduced(value));
    cosines[i] = front.slides_[i] ? static_cast<float>(value) : std::cos(angle_rad);
    sines[i] = front.slides_[i] ? 0.0F : std::sin(angle_rad);
  }
  frames_.front() = front.base_;
  arm::chain(front.joints_, cosines.data(), sines.data(), frames_.data());
  place();
}

void PlacedFront::place() {
  const std::size_t count = front_.coarse_.balls.size();
  if (count > kFew) many_.resize(3 * count);
  x_m_ = count > kFew ? many_.data() : few_.data();
  y_m_ = x_m_ + count;
  z_m_ = y_m_ + count;
  arm::place_blocks(frames_, front_.coarse_.links, front_.coarse_.arrays(0), x_m_, y_m_, z_m_);
}

Pose PlacedFront::T_world_link(std::size_t link) const {
  Pose T_world_link;
  T_world_link.matrix() = Eigen::Map<const Eigen::Matrix4f>{frames_[link].data()}.cast<double>();
  return T_world_link;
}

SphereSpans PlacedFront::spheres(std::size_t first, std::size_t count) const {
  const float* radius_m = front_.coarse_.radius_m.data() + first;
  return {{x_m_ + first, count}, {y_m_ + first, count}, {z_m_ + first, count}, {radius_m, count}};
}

std::uint64_t PlacedFront::perhaps_touching_finer(std::size_t i, const ObstacleMap& obstacles) const {
  const std::size_t first = i * ArmCover::kFinerBalls;
  const std::span<const std::uint8_t> links{&front_.fine_.links[first / arm::kBlock],
                                            ArmCover::kFinerBalls / arm::kBlock};
  const arm::BallArrays balls = front_.fine_.arrays(first);
  std::array<float, ArmCover::kFinerBalls> x_m;
  std::array<float, ArmCover::kFinerBalls> y_m;
  std::array<float, ArmCover::kFinerBalls> z_m;
  arm::place_blocks(frames_, links, balls, x_m.data(), y_m.data(), z_m.data());
  std::uint64_t perhaps{0};
  obstacles.perhaps_touching({x_m, y_m, z_m, {balls.radius_m, ArmCover::kFinerBalls}}, {&perhaps, 1});
  return perhaps;
}

std::size_t PlacedFront::first_near_pair(std::size_t first, std::span<const float> margins_m) const {
  return arm::first_near(front_.pairs_, first, margins_m.data(), frames_, front_.boxes_.data(), arrays());
}

}  // namespace saccade

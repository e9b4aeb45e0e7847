// SPDX-License-Identifier: Apache-2.0
// Descriptions with numbers, names and elements exchanged: each is read or refused in one line, and soon.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <regex>

#include "saccade/arm/kinematics.hpp"
#include "saccade/arm/urdf.hpp"
#include "saccade/core/length_limit.hpp"

namespace saccade {
namespace {

constexpr int kUrdfMutants{2000};
constexpr std::uint64_t kMutationSeed{20};

/// Changes one number, one name, or one element of an XML text at random.
class UrdfMutator {
 public:
  explicit UrdfMutator(std::uint64_t seed) : random_{seed} {}

  std::string operator()(std::string text) {
    const std::size_t changes = 1 + below(3);
    for (std::size_t i = 0; i < changes; ++i) {
      switch (below(6)) {
        case 0:
        case 1: replace(text, kNumber, one_of(kNumbers)); break;
        case 2: replace(text, kValue, "\"" + std::string{one_of(kNames)} + "\""); break;
        case 3: replace(text, kType, std::string{"type=\""} + one_of(kTypes) + "\""); break;
        case 4: replace(text, kElement, one_of(kElements)); break;
        default: text.erase(below(text.size()), below(2) == 0 ? 1 : 200); break;
      }
    }
    return text;
  }

 private:
  std::size_t below(std::size_t end) { return std::uniform_int_distribution<std::size_t>{0, end - 1}(random_); }
  template <std::size_t N>
  const char* one_of(const char* const (&texts)[N]) {
    return texts[below(N)];
  }
  /// Replaces one of the places that the expression finds.
  void replace(std::string& text, const std::regex& what, const std::string& with) {
    const std::vector<std::smatch> places(std::sregex_iterator(text.begin(), text.end(), what), {});
    if (places.empty()) return;
    const std::smatch& place = places[below(places.size())];
    const auto at = static_cast<std::size_t>(place.position());
    text.replace(at, static_cast<std::size_t>(place.length()), with);
  }

  static constexpr const char* kNumbers[]{"nan",    "inf", "-inf", "1e999", "-1e308", "1e300", "1e16",
                                          "1001",   "999", "21",   "-180",  "0",      "-0",    "1e-9",
                                          "1e-320", "",    "abc",  "1,5",   "0x10"};
  static constexpr const char* kNames[]{"", "base", "tool0", "link_3", "joint_2", "nowhere", "a b", "\xff", "&#0;"};
  static constexpr const char* kTypes[]{"revolute", "continuous", "prismatic", "fixed", "floating", "planar", "odd"};
  static constexpr const char* kElements[]{"",
                                           "<!--",
                                           "<xacro:arm/>",
                                           "<mimic joint=\"joint_1\" multiplier=\"1e300\"/>",
                                           "<collision><geometry><sphere radius=\"1e9\"/></geometry></collision>",
                                           "<visual><geometry><mesh filename=\"gone.dae\"/></geometry></visual>",
                                           "<limit lower=\"-1e16\" upper=\"1e16\" velocity=\"1\" effort=\"1\"/>"};
  const std::regex kNumber{R"(-?\d+\.?\d*(?=[" ]))"};
  const std::regex kValue{R"("[^"<>]*")"};
  const std::regex kType{R"(type="\w+")"};
  const std::regex kElement{R"(<[a-z]+[^<>]*/>)"};
  std::mt19937_64 random_;
};

TEST(UrdfMutation, EachIsReadOrRefusedInOneLine) {
  UrdfMutator mutated{kMutationSeed};
  int read{0};
  int refused{0};
  double slowest_s{0.0};
  for (int i = 0; i < kUrdfMutants; ++i) {
    const BuiltinRobot& robot = builtin_robots()[static_cast<std::size_t>(i) % builtin_robots().size()];
    const std::string text = mutated(std::string{robot.urdf});
    const auto begin = std::chrono::steady_clock::now();
    const auto arm = parse_urdf(text);
    slowest_s = std::max(slowest_s, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    if (!arm) {
      ++refused;
      EXPECT_FALSE(arm.error().message.empty());
      ASSERT_EQ(arm.error().to_string().find('\n'), std::string::npos) << arm.error().to_string();
      continue;
    }
    ++read;
    const Pose T = camera_pose(arm->arm, arm->arm.middle());
    ASSERT_TRUE(T.matrix().allFinite()) << text;
    for (const ArmJoint& joint : arm->arm.joints()) {
      if (joint.kind == JointKind::continuous) continue;
      ASSERT_LE(std::max(std::abs(joint.limits.lower), std::abs(joint.limits.upper)), kMaxLength_m) << joint.name;
    }
  }
  EXPECT_EQ(read + refused, kUrdfMutants) << "seed " << kMutationSeed;
  EXPECT_GT(read, kUrdfMutants / 20) << "seed " << kMutationSeed;
  EXPECT_GT(refused, kUrdfMutants / 20) << "seed " << kMutationSeed;
  EXPECT_LT(slowest_s, 10.0) << "seed " << kMutationSeed;
}

}  // namespace
}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
// Mounts and clocks found from simulated frames of a Kinect and from the frames of a real arm, and input that
// determines neither. The tests print what docs/guides/calibration.md says.
#include "saccade/tracking/hand_eye.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <iostream>

#include "saccade/core/seeded_random.hpp"
#include "saccade/io/frames/rgbd_folder.hpp"
#include "saccade/io/frames/trajectory_io.hpp"
#include "saccade/scene/simulated_camera.hpp"
#include "saccade/sensor/gap_filling.hpp"
#include "support/effort.hpp"
#include "support/places.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

Executor two_threads() { return Executor::with_threads(2); }

Pose turned(const Vector3d& rotation_vector, const Vector3d& translation) {
  Pose T{Pose::Identity()};
  const double angle = rotation_vector.norm();
  if (angle > 0.0) T.linear() = Eigen::AngleAxisd{angle, rotation_vector / angle}.toRotationMatrix();
  T.translation() = translation;
  return T;
}

Pose true_mount() { return turned({0.15, -0.1, 1.6}, {0.04, -0.06, 0.09}); }

Vector3d random_direction(SeededRandom& random) {
  return Vector3d{random.normal(), random.normal(), random.normal()}.normalized();
}

/// Mount that is 8 mm and 2° off.
Pose rough_mount(std::uint64_t seed) {
  SeededRandom random{seed};
  return true_mount() * turned(2_deg * random_direction(random), 0.008 * random_direction(random));
}

/// Where the camera is at a time of a motion around a table; its phases by seed.
Pose camera_at(double time_s, std::uint64_t seed) {
  const double phase = 0.7 * static_cast<double>(seed % 9);
  const double azimuth_rad = -90_deg + 35_deg * std::sin(1.1 * time_s + phase);
  const double elevation_rad = 50_deg + 15_deg * std::sin(1.7 * time_s + 2.0 * phase);
  const double distance_m = 0.75 + 0.08 * std::sin(0.9 * time_s + phase);
  const Vector3d target{0.05 * std::sin(1.3 * time_s + phase), 0.0, 0.05};
  const Vector3d outward{std::cos(elevation_rad) * std::cos(azimuth_rad),
                         std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad)};
  return look_at(target + distance_m * outward, target, Vector3d::UnitZ(), 20_deg * std::sin(0.8 * time_s + phase));
}

/// A cell with a simulated Kinect in which input is collected.
class Cell {
 public:
  Cell(const Scene& scene, std::uint64_t seed, int width = 160) : camera_{kinect(scene, seed, width)}, seed_{seed} {
    input.camera = camera_.camera();
  }

  void add_still(const Pose& T_world_camera) {
    input.still.push_back({camera_.capture(T_world_camera).depth, T_world_camera * true_mount().inverse()});
  }
  void add_still_views(int count) {
    for (int k = 0; k < count; ++k) add_still(camera_at(1.37 * k, seed_));
  }

  using Path = std::function<Pose(double time_s)>;
  /// Frames at 30 Hz and flange poses at 125 Hz; the camera's clock is behind.
  void add_motion(double seconds, double clock_offset_s, const Path& path) {
    for (int k = 0; k < static_cast<int>(seconds * 30.0); ++k) {
      const double time_s = k / 30.0;
      input.moving.push_back({camera_.capture(path(time_s)).depth, 100.0 + time_s - clock_offset_s});
    }
    for (int k = -60; k < static_cast<int>((seconds + 0.5) * 125.0); ++k) {
      const double time_s = k / 125.0;
      input.flange.push_back({100.0 + time_s, path(time_s) * true_mount().inverse()});
    }
  }
  void add_motion(double seconds, double clock_offset_s = 0.035) {
    add_motion(seconds, clock_offset_s, [this](double time_s) { return camera_at(time_s, seed_); });
  }

  HandEyeInput input;

 private:
  static SimulatedCamera kinect(const Scene& scene, std::uint64_t seed, int width) {
    SimulatedCameraConfig config;
    config.camera = camera_preset("kinect-v1").value().scaled_to_width(width);
    config.noise = kinect_v1_noise(seed);
    return SimulatedCamera::create(RayScene::build(scene).value(), config).value();
  }

  SimulatedCamera camera_;
  std::uint64_t seed_;
};

HandEyeResult calibrated(const HandEyeInput& input) {
  auto result = calibrate_hand_eye(input, two_threads());
  EXPECT_TRUE(result) << (result ? "" : result.error().to_string());
  return result ? *result : HandEyeResult{};
}

double turn_error_deg(const Pose& mount) { return to_deg(rotation_angle_rad(true_mount().inverse() * mount)); }
double shift_error_mm(const Pose& mount) { return 1e3 * (true_mount().inverse() * mount).translation().norm(); }

void print(const std::string& what, const HandEyeResult& result) {
  std::cout << what << ": ";
  if (!result.T_flange_camera) {
    std::cout << "no mount\n";
    return;
  }
  std::cout << turn_error_deg(*result.T_flange_camera) << " deg (sigma " << to_deg(result.rotation_sigma_rad) << "), "
            << shift_error_mm(*result.T_flange_camera) << " mm (sigma " << 1e3 * result.translation_sigma_m
            << "), clock ";
  if (result.clock_offset_s) {
    std::cout << 1e3 * *result.clock_offset_s << " ms (sigma " << 1e3 * result.clock_sigma_s << ")\n";
  } else {
    std::cout << "none\n";
  }
}

void expect_found(const HandEyeResult& result, std::optional<double> clock_offset_s) {
  ASSERT_TRUE(result.T_flange_camera.has_value()) << (result.missing.empty() ? "" : result.missing.front());
  EXPECT_LT(turn_error_deg(*result.T_flange_camera), 0.2);
  EXPECT_LT(shift_error_mm(*result.T_flange_camera), 1.5);
  EXPECT_TRUE(result.missing.empty());
  EXPECT_GT(result.translation_sigma_m, 0.0);
  EXPECT_LT(result.translation_sigma_m, 1.5e-3);
  EXPECT_LE(result.agreement_after->median_plane_m, 1.01 * result.agreement_before->median_plane_m);
  ASSERT_EQ(result.clock_offset_s.has_value(), clock_offset_s.has_value()) << result.why_no_clock;
  if (clock_offset_s) {
    EXPECT_NEAR(*result.clock_offset_s, *clock_offset_s, 0.005);
  }
  EXPECT_EQ(result.why_no_clock.empty(), clock_offset_s.has_value());
}

TEST(HandEye, FindsMountAndClockFromARoughMount) {
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(test::scaled_cases(2)); ++seed) {
    Cell cell{random_clutter(seed), seed};
    cell.add_still_views(8);
    cell.add_motion(2.0);
    cell.input.T_flange_camera_guess = rough_mount(seed);
    const HandEyeResult result = calibrated(cell.input);
    print("seed " + std::to_string(seed), result);
    expect_found(result, 0.035);
    EXPECT_EQ(result.still_tracked, 8U);
  }
}

TEST(HandEye, FindsBothWithoutAGuessFromTheMotion) {
  Cell cell{random_clutter(3), 3};
  cell.add_motion(3.0, -0.02);
  const HandEyeResult result = calibrated(cell.input);
  print("no guess", result);
  expect_found(result, -0.02);
  EXPECT_TRUE(result.T_flange_camera_tracked.has_value());
}

TEST(HandEye, FindsTheMountFromStillViewsAlone) {
  Cell cell{random_clutter(4), 4};
  cell.add_still_views(8);
  cell.input.T_flange_camera_guess = rough_mount(4);
  const HandEyeResult result = calibrated(cell.input);
  print("still views", result);
  expect_found(result, std::nullopt);
}

/// Errors by axis.
void spoil_flange_poses(HandEyeInput& input, double turn_rad, double shift_m, std::uint64_t seed) {
  SeededRandom random{seed};
  const auto normals = [&] { return Vector3d{random.normal(), random.normal(), random.normal()}; };
  for (StillView& view : input.still) {
    const Vector3d turn = turn_rad * normals();
    view.T_base_flange = view.T_base_flange * turned(turn, shift_m * normals());
  }
}

TEST(HandEye, TellsHowSureItIsWithInexactFlangePoses) {
  Cell cell{random_clutter(5), 5};
  cell.add_still_views(16);
  spoil_flange_poses(cell.input, 0.05_deg, 0.00036, 9);
  cell.input.T_flange_camera_guess = rough_mount(5);
  const HandEyeResult result = calibrated(cell.input);
  print("inexact flange poses", result);
  expect_found(result, std::nullopt);
  EXPECT_LT(shift_error_mm(*result.T_flange_camera), 4e3 * result.translation_sigma_m);
  EXPECT_LT(turn_error_deg(*result.T_flange_camera), 4.0 * to_deg(result.rotation_sigma_rad));
  EXPECT_GT(result.flange_translation_sigma_m, 0.0002);
  EXPECT_LT(result.flange_translation_sigma_m, 0.0010);
}

void expect_missing(const HandEyeInput& input, const std::string& word) {
  const HandEyeResult result = calibrated(input);
  EXPECT_FALSE(result.T_flange_camera.has_value());
  ASSERT_FALSE(result.missing.empty());
  std::cout << result.missing.front() << '\n';
  EXPECT_NE(result.missing.front().find(word), std::string::npos) << result.missing.front();
}

TEST(HandEye, SaysThatTheFlangeDidNotTurn) {
  Cell cell{random_clutter(3), 3};
  for (int k = 0; k < 6; ++k) {
    Pose T = camera_at(0.0, 1);
    T.translation() += 0.1 * Vector3d{std::sin(1.0 * k), std::sin(2.3 * k), std::cos(1.7 * k)};
    cell.add_still(T);
  }
  expect_missing(cell.input, "hardly turned");
  cell.input.T_flange_camera_guess = rough_mount(1);
  expect_missing(cell.input, "hardly turned");
}

TEST(HandEye, SaysAboutWhichAxisAloneTheFlangeTurned) {
  Cell cell{random_clutter(3), 3};
  for (int k = 0; k < 6; ++k) cell.add_still(turned({0.0, 0.0, 10_deg * k}, Vector3d::Zero()) * camera_at(0.0, 1));
  expect_missing(cell.input, "one axis");
  cell.input.T_flange_camera_guess = rough_mount(1);
  expect_missing(cell.input, "one axis");
}

TEST(HandEye, SaysThatThereIsNothingButAPlane) {
  Scene scene = random_clutter(1, 1);
  scene.objects.clear();
  SceneObject floor{"floor", BoxShape{{3.0, 3.0, 0.1}}};
  floor.T_world_object.translation().z() = -0.1;
  scene.objects.push_back(floor);
  Cell cell{scene, 3};
  for (int k = 0; k < 6; ++k) cell.add_still(camera_at(0.5 * k, 1));
  expect_missing(cell.input, "one plane");
  cell.input.T_flange_camera_guess = rough_mount(1);
  expect_missing(cell.input, "one plane");
}

TEST(HandEye, FindsNoMountForFlangePosesOfOtherViews) {
  Cell cell{random_clutter(3), 3};
  cell.add_still_views(8);
  const std::vector<StillView> still = cell.input.still;
  for (std::size_t k = 0; k < 8; ++k) cell.input.still[k].T_base_flange = still[(k + 3) % 8].T_base_flange;
  cell.input.T_flange_camera_guess = rough_mount(1);
  expect_missing(cell.input, "do not agree");
}

TEST(HandEye, SaysWhyThereIsNoClockOffset) {
  Cell cell{random_clutter(3), 3};
  cell.add_motion(1.5, 0.035, [](double time_s) {
    Pose T = camera_at(0.0, 1);
    T.translation().x() += 0.05 * time_s;
    return T;
  });
  cell.add_still_views(6);
  cell.input.T_flange_camera_guess = rough_mount(3);
  HandEyeResult result = calibrated(cell.input);
  expect_found(result, std::nullopt);
  EXPECT_NE(result.why_no_clock.find("speed of turning"), std::string::npos) << result.why_no_clock;
  cell.input.moving[3].time_s.reset();
  result = calibrated(cell.input);
  EXPECT_NE(result.why_no_clock.find("carry no time"), std::string::npos) << result.why_no_clock;
  EXPECT_TRUE(result.T_flange_camera.has_value());
}

TEST(HandEye, EveryThreadCountGivesTheSameBits) {
  Cell cell{random_clutter(6), 6};
  cell.add_still_views(5);
  cell.add_motion(1.5);
  cell.input.T_flange_camera_guess = rough_mount(6);
  const HandEyeResult two = calibrated(cell.input);
  const HandEyeResult one = calibrate_hand_eye(cell.input, Executor{}).value();
  ASSERT_TRUE(one.T_flange_camera && two.T_flange_camera);
  EXPECT_EQ(one.T_flange_camera->matrix(), two.T_flange_camera->matrix());
  EXPECT_EQ(one.clock_offset_s, two.clock_offset_s);
  EXPECT_EQ(one.translation_sigma_m, two.translation_sigma_m);
  EXPECT_EQ(one.agreement_after->median_plane_m, two.agreement_after->median_plane_m);
}

TEST(HandEye, RefusesBadInputAndIsCancelled) {
  Cell cell{random_clutter(3), 3};
  cell.add_still_views(3);
  const auto code = [](const HandEyeInput& input, const HandEyeConfig& config = {}) {
    return calibrate_hand_eye(input, Executor{}, config).error().code;
  };
  HandEyeInput bad = cell.input;
  bad.still.pop_back();
  EXPECT_EQ(code(bad), Errc::invalid_argument);
  bad = cell.input;
  bad.still[1].depth = DepthImage{4, 4};
  EXPECT_EQ(code(bad), Errc::size_mismatch);
  bad = cell.input;
  bad.still[1].T_base_flange.linear() *= 2.0;
  EXPECT_EQ(code(bad), Errc::invalid_argument);
  bad = cell.input;
  bad.flange = {{1.0, Pose::Identity()}, {1.0, Pose::Identity()}};
  EXPECT_EQ(code(bad), Errc::invalid_argument);
  EXPECT_EQ(code(cell.input, {.min_overlap = 0.0}), Errc::invalid_argument);
  EXPECT_EQ(view_agreement({}, cell.input.camera, std::vector<Pose>(1), Executor{}).error().code, Errc::size_mismatch);
  Progress progress;
  progress.request_cancel();
  EXPECT_EQ(calibrate_hand_eye(cell.input, Executor{}, {}, &progress).error().code, Errc::cancelled);
}

/// The arm's poses as its authors had them before their calibration are taken as the flange's.
TEST(HandEye, BringsARealArmsViewsTogetherBetterThanItsCalibration) {
  const std::filesystem::path folder = test::shared_data() / "rgbd_eyeinhand_shelfA";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no recorded frames in " << folder;
  if (test::kSanitized) GTEST_SKIP() << "takes a minute with sanitizers, and runs what the tests above run";
  auto source = open_rgbd_folder(folder, {.read_color = false});
  ASSERT_TRUE(source) << source.error().to_string();
  HandEyeInput input;
  input.camera = (*source)->camera();
  input.T_flange_camera_guess = Pose::Identity();
  std::vector<DepthImage> depth;
  std::vector<Pose> nominal;
  while (const std::optional<Frame> frame = (*source)->next().value()) {
    depth.push_back(fill_gaps(frame->depth, choose_gap_filling(frame->depth)));
    nominal.push_back(*frame->T_world_camera);
    input.still.push_back({depth.back(), nominal.back()});
  }
  const HandEyeResult result = calibrated(input);
  ASSERT_TRUE(result.T_flange_camera.has_value()) << result.missing.front();
  std::vector<Pose> ours;
  for (const Pose& T : nominal) ours.push_back(T * *result.T_flange_camera);
  const auto depth_mm = [&](const char* name, const std::vector<Pose>& T_world_camera) {
    const ViewAgreement agreement = view_agreement(depth, input.camera, T_world_camera, two_threads()).value();
    std::cout << name << ": median |dz| " << 1e3 * agreement.median_depth_m << " mm, from planes "
              << 1e3 * agreement.median_plane_m << " mm, " << agreement.agreeing << " of " << agreement.points
              << " points, " << agreement.pairs << " pairs\n";
    EXPECT_GT(agreement.points, 500000U);
    return 1e3 * agreement.median_depth_m;
  };
  const double nominal_mm = depth_mm("nominal", nominal);
  const double supplied_mm = depth_mm("supplied", read_poses(folder / "cam.poses.A.txt").value());
  const double ours_mm = depth_mm("ours", ours);
  std::cout << "turned by " << to_deg(rotation_angle_rad(*result.T_flange_camera)) << " deg, moved by "
            << 1e3 * result.T_flange_camera->translation().norm() << " mm, sigma " << to_deg(result.rotation_sigma_rad)
            << " deg, " << 1e3 * result.translation_sigma_m << " mm; flange poses "
            << to_deg(result.flange_rotation_sigma_rad) << " deg, " << 1e3 * result.flange_translation_sigma_m
            << " mm\n";
  EXPECT_LT(ours_mm, supplied_mm);
  EXPECT_LT(ours_mm, 0.8 * nominal_mm);
}

/// Many scenes, paths, guesses and offsets, with images of 320 × 240 pixels.
TEST(HandEyeEvidence, FindsMountAndClockOnManySeeds) {
  double squared_ratio{0.0};
  constexpr int kSeeds{16};
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const double offset_s = seed % 3 == 0 ? 0.035 : seed % 3 == 1 ? -0.035 : 0.02;
    Cell cell{random_clutter(seed), seed, 320};
    if (seed % 4 != 3) cell.add_still_views(6 + static_cast<int>(seed % 5));
    cell.add_motion(2.5, offset_s);
    if (seed % 4 < 2) cell.input.T_flange_camera_guess = rough_mount(seed);
    const HandEyeResult result = calibrated(cell.input);
    print("seed " + std::to_string(seed), result);
    expect_found(result, offset_s);
    if (!result.T_flange_camera) continue;
    const double ratio = 1e-3 * shift_error_mm(*result.T_flange_camera) / result.translation_sigma_m;
    squared_ratio += ratio * ratio / kSeeds;
  }
  std::cout << "root mean square of error / sigma: " << std::sqrt(squared_ratio) << '\n';
  EXPECT_LT(std::sqrt(squared_ratio), 4.0);
}

TEST(HandEyeEvidence, StandardDeviationsHoldForInexactFlangePoses) {
  constexpr int kSeeds{8};
  for (const double scale : {0.3, 1.0}) {
    double squared_mm2{0.0};
    double variance_mm2{0.0};
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      Cell cell{random_clutter(3), seed, 320};
      cell.add_still_views(20);
      spoil_flange_poses(cell.input, scale * 0.17_deg, scale * 0.0012, 100 + seed);
      cell.input.T_flange_camera_guess = rough_mount(seed);
      const HandEyeResult result = calibrated(cell.input);
      print("errors of " + std::to_string(scale * 1.2) + " mm, seed " + std::to_string(seed), result);
      ASSERT_TRUE(result.T_flange_camera.has_value());
      squared_mm2 += std::pow(shift_error_mm(*result.T_flange_camera), 2) / kSeeds;
      variance_mm2 += 1e6 * result.translation_sigma_m * result.translation_sigma_m / kSeeds;
    }
    std::cout << "root mean square error " << std::sqrt(squared_mm2) << " mm, sigma " << std::sqrt(variance_mm2)
              << " mm\n";
    EXPECT_LT(squared_mm2, 4.0 * variance_mm2);
    EXPECT_LT(std::sqrt(squared_mm2), 3.0 * scale);
  }
}

}  // namespace
}  // namespace saccade

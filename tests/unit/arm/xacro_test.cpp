// SPDX-License-Identifier: Apache-2.0
// Descriptions that the program xacro expands, with scripts in its place.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "saccade/arm/urdf.hpp"
#include "support/environment_variable.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using test::EnvironmentVariable;

constexpr const char* kExpanded{R"(<robot name="expanded"><link name="b"/><link name="c"/>
<!-- <xacro:include filename="gone"/> -->
<joint name="j" type="continuous"><parent link="b"/><child link="c"/><axis xyz="0 0 1"/></joint></robot>)"};

class XacroTest : public testing::Test {
 protected:
  XacroTest() { file_ = folder_.write("it's an arm.urdf.xacro", "<robot name=\"raw\"/>"); }

  /// Writes a program xacro: a script of sh.
  void install(const std::string& script) const {
    const fs::path program = folder_.write("bin/xacro", "#!/bin/sh\n" + script + "\n");
    fs::permissions(program, fs::perms::owner_all);
  }
  [[nodiscard]] Error error() const {
    const auto arm = read_urdf(file_, config_);
    EXPECT_FALSE(arm);
    return arm ? Error{} : arm.error();
  }
  void expect_error(Errc code, const std::string& part) const {
    const Error found = error();
    EXPECT_EQ(found.code, code) << found.to_string();
    EXPECT_NE(found.to_string().find(part), std::string::npos) << found.to_string();
    EXPECT_EQ(found.to_string().find('\n'), std::string::npos) << found.to_string();
  }
  [[nodiscard]] std::string command() const {
    return "xacro '" + (folder_ / "it'\\''s an arm.urdf.xacro").string() + "' > robot.urdf";
  }

  test::TempFolder folder_;
  fs::path file_;
  UrdfConfig config_;
  EnvironmentVariable path_{"PATH", (folder_ / "bin").string() + ":/usr/bin:/bin"};
  EnvironmentVariable no_ros_{"ROS_PACKAGE_PATH", ""};
  EnvironmentVariable no_ament_{"AMENT_PREFIX_PATH", ""};
};

TEST_F(XacroTest, ItsOutputIsTheDescription) {
  folder_.write("expanded", kExpanded);
  install("echo \"$ROS_PACKAGE_PATH $#\" > '" + (folder_ / "seen").string() + "'; test -f \"$1\" && cat '" +
          (folder_ / "expanded").string() + "'; echo warning >&2");
  config_.package_paths = {folder_ / "src"};
  const auto arm = read_urdf(file_, config_);
  ASSERT_TRUE(arm) << arm.error().to_string();
  EXPECT_EQ(arm->arm.name(), "expanded");
  std::ifstream seen{folder_ / "seen"};
  std::string paths;
  std::getline(seen, paths);
  EXPECT_EQ(paths, (folder_ / "src").string() + " 1");

  file_ = folder_.write("arm.urdf", "<robot name='a' xmlns:xacro='x'><xacro:arm prefix='a'/></robot>");
  EXPECT_TRUE(read_urdf(file_, config_)) << "elements tell, not only the name";
  const auto text = parse_urdf("<robot name='a' xmlns:xacro='x'><xacro:arm prefix='a'/></robot>");
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().code, Errc::unsupported);
  EXPECT_NE(text.error().to_string().find("xacro FILE > robot.urdf"), std::string::npos) << text.error().to_string();
}

TEST_F(XacroTest, WithoutItTheErrorSaysWhatToRun) {
  const EnvironmentVariable nothing{"PATH", (folder_ / "bin").string()};
  expect_error(Errc::unavailable, "there is no program xacro in PATH");
  expect_error(Errc::unavailable, command());
}

TEST_F(XacroTest, ItsFailureIsToldInItsWords) {
  install("echo 'Undefined substitution argument ur_type' >&2; exit 2");
  expect_error(Errc::corrupt_data, "exit status 2: Undefined substitution argument ur_type");
  expect_error(Errc::corrupt_data, command());
  install("exit 0");
  expect_error(Errc::corrupt_data, "xacro wrote nothing");
  install("kill -9 $$");
  expect_error(Errc::corrupt_data, "exit status 137");
  install("echo '<robot/>'");
  expect_error(Errc::corrupt_data, "no URDF that can be read");
  install("yes '<robot>'");
  expect_error(Errc::corrupt_data, "more than 64 MiB");
  config_.xacro_timeout_s = 0.0;
  expect_error(Errc::invalid_argument, "time limit");
}

TEST_F(XacroTest, EndsWithTheTimeAndWithTheUser) {
  const auto begin = std::chrono::steady_clock::now();
  install("sleep 50 & sleep 50");
  config_.xacro_timeout_s = 0.3;
  expect_error(Errc::io_failure, "took longer than the 0.3 s allowed");
  install("exec 1>&-; sleep 50");  // closes its output, and goes on
  expect_error(Errc::io_failure, "took longer than the 0.3 s allowed");
  config_.xacro_timeout_s = 40.0;
  config_.cancelled = [begin] { return std::chrono::steady_clock::now() - begin > std::chrono::milliseconds{900}; };
  expect_error(Errc::cancelled, "interrupted while xacro ran");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds{20});
}

}  // namespace
}  // namespace saccade

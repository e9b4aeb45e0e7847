// SPDX-License-Identifier: Apache-2.0
// The browser is sent to the page by a file that only the user can read, not by its arguments, which everyone can see.
#include <sys/stat.h>

#include <cstdlib>
#include <map>
#include <optional>

#include "cli/run_program.hpp"

namespace saccade::test {
namespace {

/// With a display, and an xdg-open that keeps what it is given.
class BrowserPageTest : public ::testing::Test {
 protected:
  void SetUp() override {
    cloud_ = folder_.write("cloud.xyz", "0 0 0\n1 0 0\n0 1 0\n");
    const fs::path fake = folder_.write(
        "bin/xdg-open",
        "#!/bin/sh\nkept='" + folder_.path().string() +
            "'\ncp \"$1\" \"$kept/content\"\nstat -c %a \"$1\" > \"$kept/mode\"\nps -o args= -p $$ > \"$kept/args\"\n"
            "echo \"$# $1\" > \"$kept/given.part\"\nmv \"$kept/given.part\" \"$kept/given\"\n");
    fs::permissions(fake, fs::perms::owner_all);
    for (const char* place : {"run", "tmp", "home"}) fs::create_directory(folder_ / place);
    set("PATH", (folder_ / "bin").string() + ":" + std::getenv("PATH"));
    set("DISPLAY", ":0");
    set("SSH_CONNECTION", "");
    set("XDG_RUNTIME_DIR", (folder_ / "run").string());
    set("HOME", (folder_ / "home").string());
  }
  void TearDown() override {
    for (const auto& [name, value] : before_) {
      value ? ::setenv(name.c_str(), value->c_str(), 1) : ::unsetenv(name.c_str());
    }
  }
  void set(const std::string& name, const std::string& value) {
    const char* const was = std::getenv(name.c_str());
    before_.emplace(name, was == nullptr ? std::optional<std::string>{} : was);
    ::setenv(name.c_str(), value.c_str(), 1);
  }
  [[nodiscard]] Arguments show() const { return {"show", cloud_.string()}; }
  [[nodiscard]] std::size_t files_left() const {
    std::size_t count{0};
    for (const char* place : {"run", "tmp", "home"}) {
      for (const std::string& name : names_in(folder_ / place)) count += name.ends_with(".html") ? 1 : 0;
    }
    return count;
  }
  /// Returns the argument of xdg-open.
  [[nodiscard]] fs::path given() const {
    if (!wait_for_file(folder_ / "given")) return {};
    const std::string line = text_of(folder_ / "given");
    EXPECT_EQ(line.substr(0, 2), "1 ") << "one argument";
    return line.substr(2, line.size() - 3);
  }
  static std::string address_in(const std::string& out) {
    const std::size_t begin = out.find("http://localhost:");
    return begin == std::string::npos ? "" : out.substr(begin, out.find('\n', begin) - begin);
  }

  TempFolder folder_;
  fs::path cloud_;
  std::map<std::string, std::optional<std::string>> before_;
};

TEST_F(BrowserPageTest, AFileOfItsUserAloneLeadsThere) {
  for (const int signal : {SIGINT, SIGTERM}) {
    fs::remove(folder_ / "given");
    RunningProgram program{show()};
    const fs::path file = given();
    const std::string address = address_in(program.out());
    const std::size_t token_at = address.find("token=");
    ASSERT_NE(token_at, std::string::npos) << program.err();
    EXPECT_EQ(file.extension(), ".html");
    EXPECT_TRUE(fs::exists(file));
    if (!fs::exists("/snap/bin")) {
      EXPECT_EQ(file.parent_path(), folder_ / "run");
    }
    EXPECT_EQ(text_of(folder_ / "mode"), "600\n");
    EXPECT_NE(text_of(folder_ / "content").find("content=\"0; url=" + address + "\""), std::string::npos);
    EXPECT_EQ(text_of(folder_ / "args").find(address.substr(token_at + 6)), std::string::npos);
    EXPECT_EQ(file.string().find(address.substr(token_at + 6)), std::string::npos);
    program.send(signal);
    EXPECT_EQ(program.finish().status, 0);
    EXPECT_FALSE(fs::exists(file));
    EXPECT_EQ(files_left(), 0U);
  }
}

TEST_F(BrowserPageTest, ThereIsMoreThanOnePlaceForIt) {
  set("XDG_RUNTIME_DIR", (folder_ / "absent").string());
  set("TMPDIR", (folder_ / "tmp").string());
  RunningProgram program{show()};
  if (!fs::exists("/snap/bin")) {
    EXPECT_EQ(given().parent_path(), folder_ / "tmp");
  }
  program.send(SIGINT);
  EXPECT_EQ(program.finish().status, 0);
  EXPECT_EQ(files_left(), 0U);
}

TEST_F(BrowserPageTest, SaysWhyTheBrowserWasNotOpened) {
  const auto expect_said = [&](const std::string& why, rlim_t file_bytes) {
    RunningProgram program{show() + Arguments{"--quiet"}, file_bytes};
    EXPECT_TRUE(program.wait_for("the browser was not opened")) << program.out();
    EXPECT_TRUE(program.wait_for(why)) << program.err();
    EXPECT_NE(address_in(program.out()), "");
    program.send(SIGINT);
    EXPECT_EQ(program.finish().status, 0) << "it serves all the same";
    EXPECT_EQ(files_left(), 0U);
    EXPECT_FALSE(fs::exists(folder_ / "given"));
  };
  set("TMPDIR", (folder_ / "tmp").string());
  expect_said("File too large", 300);
  set("PATH", (folder_ / "home").string());
  expect_said("xdg-open", 0);
}

TEST_F(BrowserPageTest, WithoutADisplayNothingIsOpened) {
  set("DISPLAY", "");
  set("WAYLAND_DISPLAY", "");
  for (const Arguments& more : {Arguments{}, Arguments{"--no-browser"}}) {
    RunningProgram program{show() + more};
    for (int i = 0; i < 2000 && address_in(program.out()).empty(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds{5});
    }
    std::this_thread::sleep_for(std::chrono::milliseconds{200});
    program.send(SIGINT);
    const Outcome outcome = program.finish();
    EXPECT_NE(address_in(outcome.out), "");
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(files_left(), 0U);
    EXPECT_FALSE(fs::exists(folder_ / "given"));
    set("DISPLAY", ":0");  // with --no-browser
  }
}

}  // namespace
}  // namespace saccade::test

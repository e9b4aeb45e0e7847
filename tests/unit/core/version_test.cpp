// SPDX-License-Identifier: Apache-2.0
#include "saccade/core/version.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <sstream>
#include <string>

#include "support/places.hpp"

namespace saccade {
namespace {

/// Returns the first group of the expression's first match in a file of the repository.
std::string found_in(const std::string& file, const std::string& expression) {
  std::ifstream stream{test::source_folder() / file};
  std::ostringstream text;
  text << stream.rdbuf();
  std::smatch match;
  const std::string all = text.str();
  return std::regex_search(all, match, std::regex{expression}) ? match[1].str() : file + " names no version";
}

TEST(Version, IsThatOfTheProjectAndOfItsParts) {
  const std::string parts = std::to_string(SACCADE_VERSION_MAJOR) + "." + std::to_string(SACCADE_VERSION_MINOR) + "." +
                            std::to_string(SACCADE_VERSION_PATCH);
  EXPECT_EQ(parts, SACCADE_VERSION);
  EXPECT_EQ(version(), SACCADE_VERSION);
  EXPECT_EQ(found_in("CMakeLists.txt", R"(project\(saccade VERSION ([0-9.]+))"), SACCADE_VERSION);
  EXPECT_EQ(found_in("CITATION.cff", R"(\nversion: ([0-9.]+))"), SACCADE_VERSION);
  EXPECT_EQ(found_in("web/package.json", R"-("version": "([0-9.]+)")-"), SACCADE_VERSION);
}

}  // namespace
}  // namespace saccade

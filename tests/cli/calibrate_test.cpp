// SPDX-License-Identifier: Apache-2.0
// saccade calibrate on what is no cell's file.
#include <gtest/gtest.h>

#include "cli/run_program.hpp"

namespace saccade::test {
namespace {

TEST(Calibrate, SaysFirstThatTheFileIsNotThere) {
  const TempFolder folder;
  for (const char* name : {"none.yaml", "none"}) {
    expect_failure(run_program({"calibrate", (folder / name).string()}), 3, "calibrate", {name, "no such file"});
  }
  expect_failure(run_program({"calibrate", folder.path().string()}), 3, "calibrate", {"is a folder", "cell.yaml"});
}

}  // namespace
}  // namespace saccade::test

// SPDX-License-Identifier: Apache-2.0
#include "saccade/core/freed_memory.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstddef>
#include <vector>

#include "support/effort.hpp"

namespace saccade::test {
namespace {

long page_faults() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_minflt;
}

/// Four images as large as the points of a 640×480 frame, written all over.
long faults_of_one_frame() {
  const long before = page_faults();
  for (const std::vector<float>& image : std::vector(4, std::vector<float>(std::size_t{640} * 480 * 6, 1.0F))) {
    EXPECT_EQ(image.back(), 1.0F);
  }
  return page_faults() - before;
}

TEST(FreedMemory, KeptMemoryServesTheNextFrameWithoutPageFaults) {
  if (kSanitized) GTEST_SKIP() << "sanitizers have an allocator of their own";
  keep_freed_memory();
  EXPECT_GT(faults_of_one_frame(), 1000);  // new to the process
  EXPECT_LT(faults_of_one_frame(), 20);
  EXPECT_LT(faults_of_one_frame(), 20);
}

}  // namespace
}  // namespace saccade::test

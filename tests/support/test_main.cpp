// SPDX-License-Identifier: Apache-2.0
// main of every test program: GoogleTest, with the processor time of each test in its XML, that of its children
// included.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <string>

namespace {

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Processor seconds of all threads so far, and of the child processes that have ended.
double processor_s() {
  rusage own{};
  rusage children{};
  ::getrusage(RUSAGE_SELF, &own);
  ::getrusage(RUSAGE_CHILDREN, &children);
  return seconds_of(own.ru_utime) + seconds_of(own.ru_stime) + seconds_of(children.ru_utime) +
         seconds_of(children.ru_stime);
}

class ProcessorTime final : public testing::EmptyTestEventListener {
  void OnTestStart(const testing::TestInfo& /*test*/) override { began_s_ = processor_s(); }
  void OnTestEnd(const testing::TestInfo& /*test*/) override {
    testing::Test::RecordProperty("processor_s", std::to_string(processor_s() - began_s_));
  }
  double began_s_{0.0};
};

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  testing::UnitTest::GetInstance()->listeners().Append(new ProcessorTime);
  return RUN_ALL_TESTS();
}

// SPDX-License-Identifier: Apache-2.0
#include "saccade/core/hidden.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace saccade {
namespace {

/// As a header declares it: the type of the part is not known there.
class Owner {
 public:
  struct Part;
  explicit Owner(int value);
  void set(int value);
  [[nodiscard]] int value() const;

 private:
  Hidden<Part> part_;
};

struct Owner::Part {
  std::vector<int> values;
};

Owner::Owner(int value) : part_{Part{{value}}} {}
void Owner::set(int value) { part_->values[0] = value; }
int Owner::value() const { return part_->values[0]; }

TEST(Hidden, IsCopiedAndMovedWithItsOwner) {
  Owner a{1};
  Owner b{a};
  a.set(2);
  EXPECT_EQ(a.value(), 2);
  EXPECT_EQ(b.value(), 1);
  b = a;
  a.set(3);
  EXPECT_EQ(b.value(), 2);
  const Owner moved{std::move(a)};
  EXPECT_EQ(moved.value(), 3);
  a = b;  // what was moved from can be assigned to
  EXPECT_EQ(a.value(), 2);
}

}  // namespace
}  // namespace saccade

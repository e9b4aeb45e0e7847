// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/label_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace saccade {
namespace {

double lab_distance(const std::array<std::uint8_t, 3>& a, const std::array<std::uint8_t, 3>& b) {
  const auto p = cielab(a);
  const auto q = cielab(b);
  return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

/// Between any two of the labels 1 to `labels`.
double least_distance(const DistinctColors& colors, std::uint32_t labels) {
  double least = 1000.0;
  for (std::uint32_t a = 1; a <= labels; ++a) {
    for (std::uint32_t b = 1; b < a; ++b) least = std::min(least, lab_distance(colors(a), colors(b)));
  }
  return least;
}

TEST(Cielab, KnownColors) {
  const auto expect = [](const std::array<std::uint8_t, 3>& color, double l, double a, double b) {
    const auto lab = cielab(color);
    EXPECT_NEAR(lab[0], l, 0.05);
    EXPECT_NEAR(lab[1], a, 0.05);
    EXPECT_NEAR(lab[2], b, 0.05);
  };
  expect({0, 0, 0}, 0.0, 0.0, 0.0);
  expect({255, 255, 255}, 100.0, 0.0, 0.0);
  expect({255, 0, 0}, 53.24, 80.09, 67.20);
  expect({0, 0, 255}, 32.30, 79.19, -107.86);
  expect({119, 119, 119}, 50.03, 0.0, 0.0);
}

TEST(DistinctColors, AreWellApart) {
  const DistinctColors colors;
  EXPECT_GT(least_distance(colors, 10), 45.0);
  EXPECT_GT(least_distance(colors, 20), 28.0);
  EXPECT_GT(least_distance(colors, 64), 16.0);
  EXPECT_GT(least_distance(colors, 256), 8.0);
}

TEST(DistinctColors, AreNotGreyAndEvenInLightness) {
  const DistinctColors colors;
  for (std::uint32_t label = 0; label < 5000; ++label) {
    const auto lab = cielab(colors(label));
    EXPECT_GE(std::hypot(lab[1], lab[2]), 30.0) << label;
    EXPECT_GE(lab[0], 54.0) << label;
    EXPECT_LE(lab[0], 78.0) << label;
  }
}

TEST(DistinctColors, AreAlwaysTheSame) {
  const DistinctColors colors;
  const DistinctColors again;
  std::set<std::array<std::uint8_t, 3>> seen;
  for (std::uint32_t label = 1; label <= 3000; ++label) {
    EXPECT_EQ(colors(label), again(label));
    seen.insert(colors(label));
  }
  EXPECT_GT(seen.size(), 1000U);
  EXPECT_EQ(colors(1), (std::array<std::uint8_t, 3>{221, 0, 255}));
  EXPECT_NE(colors(kMaxLabel), colors(kMaxLabel - 1));
}

TEST(LabelTable, WhatIsNotDefinedHasAGeneratedColor) {
  LabelTable table;
  const DistinctColors colors;
  EXPECT_EQ(table.info(7), (LabelInfo{"", colors(7), "", 0}));
  const LabelInfo box{"White box", {1, 2, 3}, "box", 4};
  table.define(7, box);
  EXPECT_EQ(table.info(7), box);
  EXPECT_EQ(table.color(7), box.color);
  EXPECT_EQ(table.defined().size(), 1U);
  table.undefine(7);
  EXPECT_EQ(table.color(7), colors(7));
  EXPECT_TRUE(table.defined().empty());
  EXPECT_THROW(table.define(kNoLabel, box), ContractViolation);
  EXPECT_THROW(table.define(kMaxLabel + 1, box), ContractViolation);
}

TEST(LabelInfo, TextIsOneLineOfUtf8) {
  const auto valid = [](const std::string& name) { return LabelInfo{name, {}, "", 0}.validate().ok(); };
  for (const char* good : {"", "Tasse", "Schl\xC3\xBCssel", "\xE2\x82\xAC", "\xF0\x9F\x98\x80"})
    EXPECT_TRUE(valid(good));
  for (const char* bad : {"a\nb", "\x7F", "\xC3", "\xFC", "\xC0\x80", "\xE0\x80\x80", "\xED\xA0\x80",
                          "\xF4\x90\x80\x80", "\xF0\x8F\xBF\xBF", "\xE2\x82"}) {
    EXPECT_FALSE(valid(bad)) << bad;
  }
  EXPECT_TRUE(valid(std::string(kMaxLabelBytes, 'x')));
  EXPECT_FALSE(valid(std::string(kMaxLabelBytes + 1, 'x')));
  const LabelInfo bad_class{"good", {}, "bad\t", 0};
  ASSERT_FALSE(bad_class.validate());
  EXPECT_EQ(bad_class.validate().error().message, "the class of a label holds a control character");
}

}  // namespace
}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/html_text.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace saccade {
namespace {

const std::string kGap{"\xE2\x80\xAF"};
const std::string kUnreadable{"\xEF\xBF\xBD"};

std::string base64_of(const std::string& text) {
  std::vector<std::byte> bytes;
  for (const char c : text) bytes.push_back(static_cast<std::byte>(c));
  return base64(bytes);
}

TEST(HtmlEscaped, MarkupBecomesEntities) {
  EXPECT_EQ(html_escaped(R"x(<b onclick="x()">A & B's</b>)x"),
            "&lt;b onclick=&quot;x()&quot;&gt;A &amp; B&#39;s&lt;/b&gt;");
  EXPECT_EQ(html_escaped("plain\ttext\n"), "plain\ttext\n");
  EXPECT_EQ(html_escaped(""), "");
}

TEST(HtmlEscaped, KeepsUtf8AndReplacesWhatIsNone) {
  EXPECT_EQ(html_escaped("Küche – 机器人 🤖"), "Küche – 机器人 🤖");
  EXPECT_EQ(html_escaped("a\xFFz"), "a" + kUnreadable + "z");
  EXPECT_EQ(html_escaped("\xC3"), kUnreadable) << "cut at the end";
  EXPECT_EQ(html_escaped("\xC0\xBC"), kUnreadable + kUnreadable) << "an overlong <";
  EXPECT_EQ(html_escaped("\xE0\x80\xBC"), kUnreadable + kUnreadable + kUnreadable) << "the same in three bytes";
  EXPECT_EQ(html_escaped("\xED\xA0\x80"), kUnreadable + kUnreadable + kUnreadable) << "a surrogate";
  EXPECT_EQ(html_escaped("\xF4\x90\x80\x80").size(), 4 * kUnreadable.size()) << "beyond U+10FFFF";
  EXPECT_EQ(html_escaped("\xC3<"), kUnreadable + "&lt;") << "what follows is not swallowed";
}

TEST(HtmlEscaped, ReplacesControlCharacters) {
  EXPECT_EQ(html_escaped(std::string{"a\0b\x1B\r\x7F", 6}),
            "a" + kUnreadable + "b" + kUnreadable + kUnreadable + kUnreadable);
}

TEST(RelativeHref, LeavesNamesAndDisarmsTheRest) {
  EXPECT_EQ(relative_href("mesh.ply"), "mesh.ply");
  EXPECT_EQ(relative_href("pictures/view-01.png"), "pictures/view-01.png");
  EXPECT_EQ(relative_href("a b&\"ü.png"), "a%20b%26%22%C3%BC.png");
  EXPECT_EQ(relative_href("javascript:alert(1)"), "javascript%3Aalert%281%29");
  EXPECT_EQ(relative_href("//host/x"), "./host/x");
  EXPECT_EQ(relative_href("/etc/x"), "./etc/x");
}

TEST(Base64, EqualsTheExamplesOfRfc4648) {
  EXPECT_EQ(base64_of(""), "");
  EXPECT_EQ(base64_of("f"), "Zg==");
  EXPECT_EQ(base64_of("fo"), "Zm8=");
  EXPECT_EQ(base64_of("foo"), "Zm9v");
  EXPECT_EQ(base64_of("foob"), "Zm9vYg==");
  EXPECT_EQ(base64_of("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64_of("foobar"), "Zm9vYmFy");
}

TEST(Base64, UsesAllSymbols) {
  const std::array bytes{std::byte{0xFB}, std::byte{0xEF}, std::byte{0xBE}, std::byte{0xFF},
                         std::byte{0xFF}, std::byte{0xFF}, std::byte{0x00}};
  EXPECT_EQ(base64(bytes), "++++////AA==");
}

TEST(Numbers, AreGroupedByThousands) {
  EXPECT_EQ(grouped(0), "0");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(1000), "1" + kGap + "000");
  EXPECT_EQ(grouped(1234567), "1" + kGap + "234" + kGap + "567");
  EXPECT_EQ(grouped(std::numeric_limits<std::uint64_t>::max()).size(), 20 + 6 * kGap.size());
}

TEST(Numbers, AreRoundedAndSigned) {
  EXPECT_EQ(number_text(1234.5678, 2), "1" + kGap + "234.57");
  EXPECT_EQ(number_text(-3.2, 1),
            "\xE2\x88\x92"
            "3.2");
  EXPECT_EQ(number_text(-0.001, 1), "0.0") << "no minus before zero";
  EXPECT_EQ(number_text(999.996, 2), "1" + kGap + "000.00");
  EXPECT_EQ(number_text(1e300, 1), "1e+300");
  EXPECT_EQ(number_text(std::nan(""), 1), "–");
  EXPECT_EQ(number_text(std::numeric_limits<double>::infinity(), 1), "–");
}

TEST(Durations, HaveTheUnitThatSuitsThem) {
  EXPECT_EQ(duration_text(0.0), "0" + kGap + "ms");
  EXPECT_EQ(duration_text(0.314), "0.31" + kGap + "ms");
  EXPECT_EQ(duration_text(7.25), "7.2" + kGap + "ms");
  EXPECT_EQ(duration_text(31.4), "31" + kGap + "ms");
  EXPECT_EQ(duration_text(2345.0), "2.35" + kGap + "s");
  EXPECT_EQ(duration_text(12345.0), "12.3" + kGap + "s");
  EXPECT_EQ(duration_text(59990.0), "1" + kGap + "min 0" + kGap + "s");
  EXPECT_EQ(duration_text(192000.0), "3" + kGap + "min 12" + kGap + "s");
  EXPECT_EQ(duration_text(std::nan("")), "–");
}

}  // namespace
}  // namespace saccade

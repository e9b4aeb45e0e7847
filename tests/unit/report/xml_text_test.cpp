// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/internal/xml_text.hpp"

#include <gtest/gtest.h>

#include <string>

namespace saccade {
namespace {

const std::string kUnreadable{"\xEF\xBF\xBD"};

TEST(XmlEscaped, MarkupBecomesEntities) {
  EXPECT_EQ(xml_escaped(R"x(<b onclick="x()">A & B's</b>)x"),
            "&lt;b onclick=&quot;x()&quot;&gt;A &amp; B&#39;s&lt;/b&gt;");
  EXPECT_EQ(xml_escaped("plain\ttext\n"), "plain\ttext\n");
  EXPECT_EQ(xml_escaped(""), "");
}

TEST(XmlEscaped, KeepsUtf8AndReplacesWhatIsNone) {
  EXPECT_EQ(xml_escaped("Küche – 机器人 🤖"), "Küche – 机器人 🤖");
  EXPECT_EQ(xml_escaped("a\xFFz"), "a" + kUnreadable + "z");
  EXPECT_EQ(xml_escaped("\xC3"), kUnreadable) << "cut at the end";
  EXPECT_EQ(xml_escaped("\xC0\xBC"), kUnreadable + kUnreadable) << "an overlong <";
  EXPECT_EQ(xml_escaped("\xE0\x80\xBC"), kUnreadable + kUnreadable + kUnreadable) << "the same in three bytes";
  EXPECT_EQ(xml_escaped("\xED\xA0\x80"), kUnreadable + kUnreadable + kUnreadable) << "a surrogate";
  EXPECT_EQ(xml_escaped("\xF4\x90\x80\x80").size(), 4 * kUnreadable.size()) << "beyond U+10FFFF";
  EXPECT_EQ(xml_escaped("\xC3<"), kUnreadable + "&lt;") << "what follows is not swallowed";
}

TEST(XmlEscaped, ReplacesControlCharacters) {
  EXPECT_EQ(xml_escaped(std::string{"a\0b\x1B\r\x7F", 6}),
            "a" + kUnreadable + "b" + kUnreadable + kUnreadable + kUnreadable);
}

}  // namespace
}  // namespace saccade

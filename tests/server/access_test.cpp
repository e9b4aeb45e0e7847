// SPDX-License-Identifier: Apache-2.0
// Parts of HTTP requests: targets, hosts, origins, tokens.
#include "server/access.hpp"

#include <gtest/gtest.h>

namespace saccade::test {
namespace {

TEST(Access, Targets) {
  const auto parsed = server::parse_target("/data/a%20b+c?x=%C3%A4+b&&y&x=2&=z&p=1=2#end");
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->path, "/data/a b+c");
  EXPECT_EQ(parsed->query, (std::map<std::string, std::string>{{"", ""}, {"p", "1=2"}, {"x", "ä b"}, {"y", ""}}));
  for (const std::string_view wrong : {"", "a", "http://a/", "/%", "/%1", "/%1g", "/%00", "/a\nb", "/?%0a", "/?a=%"}) {
    EXPECT_FALSE(server::parse_target(wrong)) << wrong;
  }
}

TEST(Access, HostNames) {
  EXPECT_EQ(server::host_name("LocalHost"), "localhost");
  EXPECT_EQ(server::host_name("lab-7.example:8080"), "lab-7.example");
  EXPECT_EQ(server::host_name("127.0.0.1:"), "127.0.0.1");
  EXPECT_EQ(server::host_name("[::1]"), "::1");
  EXPECT_EQ(server::host_name("[FE80::1]:80"), "fe80::1");
  for (const std::string_view wrong :
       {"", ":80", "a:b", "a:123456", "[::1", "[::1]80", "a b", "a/b", "a@b", "ä", "a:8 "}) {
    EXPECT_EQ(server::host_name(wrong), "") << wrong;
  }
}

TEST(Access, Origins) {
  EXPECT_TRUE(server::is_origin_of("http://localhost:1", "localhost:1"));
  EXPECT_TRUE(server::is_origin_of("https://A.example", "a.EXAMPLE"));
  for (const std::string_view wrong : {"", "null", "http://localhost", "http://localhost:12", "localhost:1",
                                       "ws://localhost:1", "http://localhost:1/", "http://x@localhost:1"}) {
    EXPECT_FALSE(server::is_origin_of(wrong, "localhost:1")) << wrong;
  }
}

TEST(Access, Tokens) {
  EXPECT_EQ(server::offered_token("saccade.v1, saccade.token.0-aB_ ,saccade.token.x"), "0-aB_");
  EXPECT_EQ(server::offered_token("saccade.token.x"), "x");
  for (const std::string_view none : {"", ", ,", "saccade.v1", "saccade.token.", "saccade.v1 saccade.token.x"}) {
    EXPECT_EQ(server::offered_token(none), "") << none;
  }
  EXPECT_TRUE(server::is_same_token("0123456789abcdef", "0123456789abcdef"));
  for (const std::string_view wrong : {"", "0", "0123456789abcdeF", "0123456789abcdef0", "0123456789abcde"}) {
    EXPECT_FALSE(server::is_same_token(wrong, "0123456789abcdef")) << wrong;
  }
  EXPECT_TRUE(server::check_token("0123456789abc-_Z"));
  EXPECT_FALSE(server::check_token("0123456789abc-_"));
  EXPECT_FALSE(server::check_token("0123456789abcdef;"));
}

}  // namespace
}  // namespace saccade::test

// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/bags/bags.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "support/bag_writer.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

using test::BagStyle;
using test::McapBytes;
using test::RosbagBytes;
using test::WrittenMessage;

constexpr std::int64_t kStart_ns{1'700'000'000'000'000'000};

/// Ten texts on two topics; the last is recorded with an early time.
std::vector<WrittenMessage> ten_texts(messages::Wire wire) {
  std::vector<WrittenMessage> all;
  for (int i = 0; i < 10; ++i) {
    const std::string topic = i % 3 == 0 ? "/b" : "/a";
    const std::int64_t at = i == 9 ? kStart_ns - 5 : kStart_ns + i * 100'000'000;
    all.push_back(test::written(topic, at, messages::String{"text " + std::to_string(i)}, wire));
  }
  return all;
}

test::Bytes make_bag(bool mcap, const BagStyle& style) {
  const auto messages = ten_texts(style.wire);
  return mcap ? McapBytes::make(messages, style) : RosbagBytes::make(messages, style);
}

std::vector<std::string> texts_of(Bag& bag) {
  std::vector<std::uint32_t> topics(bag.topics().size());
  std::iota(topics.begin(), topics.end(), 0U);
  std::vector<std::string> texts;
  const auto entries = bag.entries(topics);
  if (!entries) return texts;
  for (const BagEntry& entry : *entries) {
    const auto message = bag.read(entry);
    if (!message || !message->wire) continue;
    const auto text = messages::read_message<messages::String>(*message->wire, message->bytes);
    if (text) texts.push_back(text->data);
  }
  return texts;
}

TEST(Bag, ReadsEveryKindInOrderOfTime) {
  const test::TempFolder folder;
  const std::vector<std::string> expected{"text 9", "text 0", "text 1", "text 2", "text 3",
                                          "text 4", "text 5", "text 6", "text 7", "text 8"};
  int kinds = 0;
  for (const bool mcap : {false, true}) {
    for (const char* packing : {"none", "bz2", "lz4", "zstd"}) {
      if (std::string_view{packing} == (mcap ? "bz2" : "zstd")) continue;
      for (const bool indexed : {true, false}) {
        for (const messages::Wire wire : {messages::Wire::ros1, messages::Wire::cdr}) {
          if (!mcap && wire == messages::Wire::cdr) continue;
          const auto path = test::write_bytes(folder / "x", make_bag(mcap, {packing, indexed, 3, wire}));
          EXPECT_TRUE(is_bag(path));
          const auto bag = Bag::open(path);
          ASSERT_TRUE(bag) << packing << bag.error().to_string();
          ASSERT_EQ((*bag)->topics().size(), 2U);
          EXPECT_EQ((*bag)->list(), "/a (std_msgs/String, 6 messages), /b (std_msgs/String, 4 messages)");
          EXPECT_EQ((*bag)->damage().empty(), indexed) << (*bag)->damage();
          EXPECT_EQ(texts_of(**bag), expected) << packing << mcap;
          ++kinds;
        }
      }
    }
  }
  EXPECT_EQ(kinds, 18);
}

TEST(Bag, ReadsMcapWithoutChunks) {
  const test::TempFolder folder;
  for (const bool indexed : {true, false}) {
    const auto bag =
        Bag::open(test::write_bytes(folder / "x", make_bag(true, {"none", indexed, 0, messages::Wire::cdr})));
    ASSERT_TRUE(bag) << bag.error().to_string();
    EXPECT_EQ(texts_of(**bag).size(), 10U);
  }
}

/// Cut at every byte: nothing crashes, what is whole before the cut is there, and the damage is said.
TEST(Bag, ReadsWhatIsBeforeACut) {
  const test::TempFolder folder;
  int opened = 0;
  for (const bool mcap : {false, true}) {
    for (const char* packing : {"none", "lz4"}) {
      const auto whole = make_bag(mcap, {packing, true, 3, messages::Wire::ros1});
      std::size_t most = 0;
      for (std::size_t size = mcap ? 8 : 4110; size < whole.size(); size += 29) {
        const auto bag = Bag::open(test::write_bytes(folder / "x", std::span{whole}.first(size)));
        if (!bag) {
          EXPECT_FALSE(bag.error().message.empty());
          continue;
        }
        EXPECT_TRUE(size + 8 >= whole.size() || !(*bag)->damage().empty()) << size;
        const std::size_t texts = texts_of(**bag).size();
        EXPECT_GE(texts, most) << mcap << packing << size;
        most = std::max(most, texts);
        ++opened;
      }
      EXPECT_EQ(most, 10U);
    }
  }
  EXPECT_GT(opened, 30);
}

/// Each byte wrong once: an error, or fewer messages.
TEST(Bag, SurvivesEveryWrongByte) {
  const test::TempFolder folder;
  int read = 0;
  for (const bool mcap : {false, true}) {
    const auto good = make_bag(mcap, {"lz4", true, 4, messages::Wire::ros1});
    for (std::size_t at = 0; at < good.size(); ++at) {
      if (!mcap && at > 200 && at < 4090) continue;  // blanks
      auto bad = good;
      bad[at] ^= std::byte{0xFF};
      const auto bag = Bag::open(test::write_bytes(folder / "x", bad));
      if (bag) read += texts_of(**bag).size() <= 10U ? 1 : 0;
    }
  }
  EXPECT_GT(read, 500);
}

TEST(Bag, SaysWhatIsNoBag) {
  const test::TempFolder folder;
  EXPECT_EQ(Bag::open(folder / "none").error().code, Errc::not_found);
  EXPECT_EQ(Bag::open(test::write_bytes(folder / "x", test::Bytes(40))).error().code, Errc::corrupt_data);
  test::Bytes old;
  test::append_chars(old, "#ROSBAG V1.2\n");
  EXPECT_EQ(Bag::open(test::write_bytes(folder / "x", old)).error().code, Errc::unsupported);
}

}  // namespace
}  // namespace saccade

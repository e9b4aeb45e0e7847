// SPDX-License-Identifier: Apache-2.0
#include "saccade/devices/program_messages.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "saccade/core/clock.hpp"
#include "saccade/io/files/file_io.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

using messages::Wire;

struct PipedText {
  nlohmann::json head;
  std::string text;
};

/// Data read by a program: lengths of heads, heads, strings of ROS.
std::vector<PipedText> piped_texts(const std::vector<std::byte>& bytes, Wire wire) {
  std::vector<PipedText> all;
  for (std::size_t at = 0; at < bytes.size();) {
    std::size_t length = 0;
    for (int i = 3; i >= 0; --i) length = 256 * length + std::to_integer<std::size_t>(bytes.at(at + i));
    const auto* const line = reinterpret_cast<const char*>(bytes.data() + at + 4);
    PipedText one{nlohmann::json::parse(line, line + length), {}};
    at += 4 + length;
    const auto size = one.head.at("bytes").get<std::size_t>();
    const auto read = messages::read_message<messages::String>(wire, std::span{bytes}.subspan(at, size));
    EXPECT_TRUE(read.ok());
    one.text = read ? read->data : "";
    at += size;
    all.push_back(std::move(one));
  }
  return all;
}

Status put_text(ProgramMessages& program, const std::string& topic, const std::string& text) {
  const auto bytes = messages::write_message(program.wire(), messages::String{text});
  return program.add(topic, messages::type_of<messages::String>(), {}, bytes);
}

std::unique_ptr<ProgramMessages> started_publisher(ProgramMessagesConfig config) {
  auto program = ProgramMessages::start(std::move(config));
  EXPECT_TRUE(program.ok());
  return *std::move(program);
}

bool fails_within_5_s(ProgramMessages& program) {
  for (int i = 0; i < 500; ++i) {
    if (!put_text(program, "/a", "again").ok()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds{10});
  }
  return false;
}

TEST(ProgramMessages, WritesHeadsAndBytesInEachLayout) {
  const test::TempFolder folder;
  for (const Wire wire : {Wire::ros1, Wire::cdr}) {
    const auto file = folder / "read";
    const auto program = started_publisher({"cat > '" + file.string() + "'", wire});
    EXPECT_EQ(program->wire(), wire);
    ASSERT_TRUE(put_text(*program, "/a", "one").ok());
    ASSERT_TRUE(put_text(*program, "/b", std::string(300000, 'x')).ok());  // more than a pipe holds
    ASSERT_TRUE(program->finish().ok());
    const auto read = piped_texts(read_file(file).value(), wire);
    ASSERT_EQ(read.size(), 2U);
    EXPECT_EQ(read[0].head.at("topic"), "/a");
    EXPECT_EQ(read[0].head.at("type"), "std_msgs/String");
    EXPECT_EQ(read[0].head.at("latched"), true);
    EXPECT_EQ(read[0].text, "one");
    EXPECT_EQ(read[1].head.at("topic"), "/b");
    EXPECT_EQ(read[1].text, std::string(300000, 'x'));
    EXPECT_EQ(read[0].head.contains("md5"), wire == Wire::ros1);
    if (wire == Wire::cdr) continue;
    EXPECT_EQ(read[0].head.at("md5"), "992ce8a1687cec8c8bd883ec73ca41d1");
    EXPECT_EQ(read[0].head.at("definition"), "string data\n");
  }
}

TEST(ProgramMessages, OfAProgramThatIsSlowTheLastMessageOfEachTopicWaits) {
  const test::TempFolder folder;
  const auto file = folder / "read";
  const auto program = started_publisher({"sh -c 'sleep 1; exec cat' > '" + file.string() + "'", Wire::ros1});
  const Stopwatch watch;
  const std::string large(200000, 'x');  // one fills the pipe
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(put_text(*program, "/a", std::to_string(i) + large).ok());
    ASSERT_TRUE(put_text(*program, "/b", std::to_string(i)).ok());
    std::this_thread::sleep_for(std::chrono::milliseconds{1});
  }
  EXPECT_LT(watch.elapsed_ms(), 900.0);
  ASSERT_TRUE(program->finish().ok());
  const auto read = piped_texts(read_file(file).value(), Wire::ros1);
  ASSERT_GE(read.size(), 3U);
  EXPECT_LE(read.size(), 4U);  // what came before the pipe was full, and the last of each topic
  EXPECT_EQ(read[read.size() - 2].text.substr(0, 4), "19xx");
  EXPECT_EQ(read.back().text, "19");
}

TEST(ProgramMessages, AProgramThatNeverReadsEndsWithTheLimit) {
  ProgramMessagesConfig config{"sleep 60"};
  config.flush_limit = std::chrono::milliseconds{200};
  const auto program = started_publisher(config);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(put_text(*program, "/a", std::string(200000, 'x')).ok());
  const Stopwatch watch;
  const Status ended = program->finish();
  ASSERT_FALSE(ended.ok());
  EXPECT_NE(ended.error().to_string().find("not read within 200 ms"), std::string::npos) << ended.error().to_string();
  EXPECT_LT(watch.elapsed_ms(), 2000.0);
}

TEST(ProgramMessages, AProgramThatEndsIsAnErrorThatQuotesIt) {
  const auto program = started_publisher({"sh -c 'echo no master >&2; exit 3'"});
  ASSERT_TRUE(fails_within_5_s(*program));
  const Status again = put_text(*program, "/a", "more");
  ASSERT_FALSE(again.ok());
  const std::string said = again.error().to_string();
  EXPECT_NE(said.find("exit status 3"), std::string::npos) << said;
  EXPECT_NE(said.find("no master"), std::string::npos) << said;
  EXPECT_FALSE(program->finish().ok());
}

TEST(ProgramMessages, AnExitStatusAfterTheEndIsSaid) {
  const auto program = started_publisher({"sh -c 'cat > /dev/null; echo it was too much >&2; exit 1'"});
  ASSERT_TRUE(put_text(*program, "/a", "one").ok());
  const Status ended = program->finish();
  ASSERT_FALSE(ended.ok());
  EXPECT_NE(ended.error().to_string().find("it was too much"), std::string::npos) << ended.error().to_string();
}

TEST(ProgramMessages, WithoutFinishTheProgramEndsAllTheSame) {
  const Stopwatch watch;
  {
    const auto program = started_publisher({"sleep 60"});
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(put_text(*program, "/a", std::string(200000, 'x')).ok());
    std::this_thread::sleep_for(std::chrono::milliseconds{50});
  }
  EXPECT_LT(watch.elapsed_ms(), 2000.0);
}

}  // namespace
}  // namespace saccade

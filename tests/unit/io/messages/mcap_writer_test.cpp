// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/messages/mcap_writer.hpp"

#include <gtest/gtest.h>
#include <zstd.h>

#include "saccade/io/files/crc32.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/little_endian.hpp"
#include "support/temp_folder.hpp"

namespace saccade::messages {
namespace {

struct Record {
  std::uint8_t op;
  std::span<const std::byte> content;
};

/// Records of a file or a chunk, until there are no more whole ones.
std::vector<Record> records_of(std::span<const std::byte> bytes) {
  std::vector<Record> records;
  ByteReader reader{bytes};
  while (reader.has(9)) {
    const auto op = reader.value<std::uint8_t>();
    const auto length = reader.value<std::uint64_t>();
    if (!reader.has(length)) break;
    records.push_back({op, reader.take(length)});
  }
  return records;
}

std::vector<std::byte> unpacked(std::span<const std::byte> chunk) {
  ByteReader reader{chunk};
  static_cast<void>(reader.take(16));
  std::vector<std::byte> out(reader.value<std::uint64_t>());
  const auto crc = reader.value<std::uint32_t>();
  EXPECT_EQ(reader.value<std::uint32_t>(), 4U);  // "zstd"
  static_cast<void>(reader.take(4));
  const auto packed = reader.take(reader.value<std::uint64_t>());
  EXPECT_EQ(ZSTD_decompress(out.data(), out.size(), packed.data(), packed.size()), out.size());
  EXPECT_EQ(crc32(out), crc);
  return out;
}

Status add_text(McapWriter& writer, const std::string& topic, const std::string& text, std::int64_t second) {
  return writer.add(topic, type_of<String>(), {second, 5}, write_message(Wire::cdr, String{text}));
}

TEST(McapWriter, ChunksIndexesAndSummaryAgree) {
  const test::TempFolder folder;
  auto writer = McapWriter::create(folder / "a.mcap");
  ASSERT_TRUE(writer.ok());
  ASSERT_TRUE(add_text(*writer, "/one", "first", 7).ok());
  ASSERT_TRUE(add_text(*writer, "/two", "second", 6).ok());
  ASSERT_TRUE(writer->flush().ok());
  ASSERT_TRUE(add_text(*writer, "/one", "third", 8).ok());
  ASSERT_TRUE(writer->finish().ok());

  const auto bytes = read_file(folder / "a.mcap");
  ASSERT_TRUE(bytes.ok());
  const std::span<const std::byte> file{*bytes};
  const auto records = records_of(file.subspan(8, file.size() - 16));
  std::string ops;
  for (const Record& record : records) ops += "0123456789ABCDEF"[record.op & 15];
  // header, chunk and its two indexes, chunk and its one, end of data; schema, two channels, statistics, chunk indexes,
  // footer
  EXPECT_EQ(ops,
            "1677"
            "67"
            "F"
            "344"
            "B"
            "88"
            "2");
  const auto chunk = unpacked(records[1].content);
  const auto inside = records_of(chunk);
  ASSERT_EQ(inside.size(), 5U);  // schema, channel, message, channel, message
  EXPECT_EQ(inside[0].op, 3);
  ByteReader message{inside[2].content};
  EXPECT_EQ(message.value<std::uint16_t>(), 0);
  EXPECT_EQ(message.value<std::uint32_t>(), 0U);
  EXPECT_EQ(message.value<std::uint64_t>(), 7'000'000'005U);
  EXPECT_EQ(message.value<std::uint64_t>(), 7'000'000'005U);
  EXPECT_EQ(read_message<String>(Wire::cdr, message.take(message.left()))->data, "first");

  ByteReader statistics{records[10].content};
  EXPECT_EQ(statistics.value<std::uint64_t>(), 3U);
  ByteReader footer{records.back().content};
  const auto summary = footer.value<std::uint64_t>();
  static_cast<void>(footer.value<std::uint64_t>());
  EXPECT_EQ(footer.value<std::uint32_t>(), crc32(file.subspan(summary, file.size() - 8 - 4 - summary)));
  ByteReader index{records[11].content};
  EXPECT_EQ(index.value<std::uint64_t>(), 6'000'000'005U);
  EXPECT_EQ(index.value<std::uint64_t>(), 7'000'000'005U);
  const auto start = index.value<std::uint64_t>();
  EXPECT_EQ(file[start], std::byte{6});
}

TEST(McapWriter, WhatWasFlushedIsThereWithoutAnEnd) {
  const test::TempFolder folder;
  auto writer = McapWriter::create(folder / "a.mcap");
  ASSERT_TRUE(writer.ok());
  ASSERT_TRUE(add_text(*writer, "/one", "kept", 1).ok());
  ASSERT_TRUE(writer->flush().ok());
  ASSERT_TRUE(add_text(*writer, "/one", "not yet", 2).ok());
  const auto bytes = read_file(folder / "a.mcap");
  ASSERT_TRUE(bytes.ok());
  const auto records = records_of(std::span<const std::byte>{*bytes}.subspan(8));
  ASSERT_EQ(records.size(), 3U);
  EXPECT_EQ(records_of(unpacked(records[1].content)).size(), 3U);
}

TEST(McapWriter, AFolderThatIsNotThereAndAFullDiskAreSaid) {
  const auto none = McapWriter::create("/nowhere/a.mcap");
  ASSERT_FALSE(none.ok());
  EXPECT_EQ(none.error().code, Errc::io_failure);
  EXPECT_NE(none.error().to_string().find("/nowhere/a.mcap"), std::string::npos);
  auto full = McapWriter::create("/dev/full");
  ASSERT_FALSE(full.ok());
  EXPECT_EQ(full.error().code, Errc::io_failure);
}

}  // namespace
}  // namespace saccade::messages

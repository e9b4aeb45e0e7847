// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/sessions/annotation_session.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>

#include "saccade/io/files/crc32.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/sessions/internal/annotation_records.hpp"
#include "support/annotated_cloud.hpp"

namespace saccade {
namespace {

using Bytes = std::vector<std::byte>;

constexpr std::size_t kRecordHeaderBytes{12};

SessionSubject subject_of_journal() {
  return {
      "k\xC3\xBC"
      "che.pcd",
      1000,
      0x123456789abcdef0ULL,
      {}};
}

/// One of each kind, with text, many points and none.
std::vector<AnnotationAction> actions_of_every_kind() {
  return {{1, SetControlPoints{{3, 1, 999}, 4, 0.25}},
          {2, RemoveControlPoints{{3, 4}}},
          {1, MoveControlPoint{1, 2}},
          {0xFFFFFFFFFFFFFFFFULL, PaintPoints{{0, 7, 8, 9}, kNoLabel}},
          {2, DefineLabels{{{4, {"cup", {1, 2, 255}, "tableware", 3}}, {kMaxLabel, {}}}}},
          {3, ClearAnnotation{}},
          {3, UndoAction{}},
          {3, RedoAction{}},
          {2, LockLabel{4, true, {3, 5}}},
          {1, PaintLabels{{0, 7, 999}, {5, 6, 5}}}};
}

Bytes joined(const std::vector<Bytes>& parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

struct Journal {
  std::vector<AnnotationAction> actions{actions_of_every_kind()};
  std::vector<std::size_t> ends;  ///< ends of the header, then of each record
  Bytes bytes;

  Journal() {
    std::vector<Bytes> parts{encode_journal_header(subject_of_journal())};
    for (const AnnotationAction& action : actions) parts.push_back(encode_journal_record(action));
    for (const Bytes& part : parts) ends.push_back((ends.empty() ? 0 : ends.back()) + part.size());
    bytes = joined(parts);
  }
  /// Whole records within the first bytes.
  [[nodiscard]] std::size_t records_within(std::size_t size) const {
    std::size_t records = 0;
    while (records + 1 < ends.size() && ends[records + 1] <= size) ++records;
    return records;
  }
};

void expect_first_actions(const Result<SavedSession>& saved, const Journal& journal, std::size_t count) {
  ASSERT_TRUE(saved) << saved.error().to_string();
  ASSERT_EQ(saved->actions.size(), count);
  EXPECT_TRUE(std::equal(saved->actions.begin(), saved->actions.end(), journal.actions.begin()));
  EXPECT_EQ(saved->good_bytes, journal.ends[count]);
}

/// A record with these bytes as payload and right checksums.
Bytes record_of(const Bytes& payload) {
  Bytes out(kRecordHeaderBytes);
  const std::array<std::uint32_t, 2> head{static_cast<std::uint32_t>(payload.size()), crc32(payload)};
  const std::uint32_t crc = crc32(std::as_bytes(std::span{head}));
  std::memcpy(out.data(), head.data(), sizeof head);
  std::memcpy(out.data() + sizeof head, &crc, sizeof crc);
  out.insert(out.end(), payload.begin(), payload.end());
  return out;
}

TEST(AnnotationRecords, AreReadAsTheyWereWritten) {
  for (const AnnotationAction& action : actions_of_every_kind()) {
    Bytes bytes;
    append_action(action, bytes);
    const auto read = read_action(bytes);
    ASSERT_TRUE(read) << read.error().to_string();
    EXPECT_EQ(*read, action);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const auto shorter = read_action(std::span{bytes}.first(size));
      ASSERT_FALSE(shorter);
      EXPECT_EQ(shorter.error().code, Errc::corrupt_data);
    }
    bytes.push_back(std::byte{0});
    EXPECT_FALSE(read_action(bytes));
  }
}

TEST(AnnotationJournalFormat, HoldsSubjectAndActions) {
  const Journal journal;
  const auto saved = decode_journal(journal.bytes);
  expect_first_actions(saved, journal, journal.actions.size());
  EXPECT_EQ(saved->torn_bytes, 0U);
  EXPECT_EQ(saved->subject.cloud_name, subject_of_journal().cloud_name);
  EXPECT_TRUE(check_same_subject(saved->subject, subject_of_journal()));
}

TEST(AnnotationJournalFormat, TruncatedAnywhereGivesTheWholeRecords) {
  const Journal journal;
  for (std::size_t size = 0; size < journal.bytes.size(); ++size) {
    SCOPED_TRACE(size);
    const auto saved = decode_journal(std::span{journal.bytes}.first(size));
    if (size < journal.ends[0]) {  // no header is ever there in part: the file appears whole
      ASSERT_FALSE(saved);
      EXPECT_EQ(saved.error().code, Errc::corrupt_data);
      continue;
    }
    const std::size_t records = journal.records_within(size);
    expect_first_actions(saved, journal, records);
    EXPECT_EQ(saved->torn_bytes, size - journal.ends[records]);
  }
}

TEST(AnnotationJournalFormat, AFlippedBitIsFoundAnywhere) {
  const Journal journal;
  const std::size_t last = journal.ends[journal.actions.size() - 1];
  for (std::size_t at = 0; at < journal.bytes.size(); ++at) {
    for (const int bit : {0, 3, 7}) {
      SCOPED_TRACE(std::to_string(at) + ", bit " + std::to_string(bit));
      Bytes flipped = journal.bytes;
      flipped[at] ^= std::byte{1} << bit;
      const auto saved = decode_journal(flipped);
      if (at >= last) {
        expect_first_actions(saved, journal, journal.actions.size() - 1);
        continue;
      }
      ASSERT_FALSE(saved);
      const bool version = at >= 8 && at < 12;
      EXPECT_EQ(saved.error().code, version ? Errc::unsupported : Errc::corrupt_data);
      if (at < journal.ends[0]) continue;
      const std::size_t begin = journal.ends[journal.records_within(at)];
      EXPECT_NE(saved.error().message.find("at byte " + std::to_string(begin) + ":"), std::string::npos);
    }
  }
}

TEST(AnnotationJournalFormat, WhatAPowerCutLeavesAtTheEndIsDropped) {
  const Journal journal;
  const std::size_t all = journal.actions.size();
  for (const std::size_t zeros : {1U, 11U, 12U, 13U, 5000U}) {  // the file grew, its new bytes were not written
    const auto saved = decode_journal(joined({journal.bytes, Bytes(zeros)}));
    expect_first_actions(saved, journal, all);
    EXPECT_EQ(saved->torn_bytes, zeros);
  }
  std::vector<std::uint32_t> points(1000);
  for (std::uint32_t i = 0; i < points.size(); ++i) points[i] = i;
  const Bytes record = encode_journal_record({1, PaintPoints{points, 1}});
  for (const std::size_t begin : {0U, 1000U, 3000U}) {  // some of its pages were written
    Bytes partly = record;
    std::fill_n(partly.begin() + static_cast<std::ptrdiff_t>(begin), 512, std::byte{0});
    expect_first_actions(decode_journal(joined({journal.bytes, partly})), journal, all);
    EXPECT_FALSE(decode_journal(joined({journal.bytes, partly, encode_journal_record({1, ClearAnnotation{}})})));
  }
}

TEST(AnnotationJournalFormat, SoundRecordsOfWhatNoSessionWritesAreDamage) {
  const Bytes header = encode_journal_header(subject_of_journal());
  const auto payload = [](const AnnotationAction& action) {
    Bytes bytes;
    append_action(action, bytes);
    return bytes;
  };
  Bytes unknown = payload({1, UndoAction{}});
  unknown.back() = std::byte{200};
  for (const Bytes& bad : {Bytes{}, unknown, payload({1, PaintPoints{{1000}, 1}}), payload({1, PaintPoints{{1, 1}, 1}}),
                           payload({1, SetControlPoints{{1}, 0, 0.0}}), payload({1, SetControlPoints{{1}, 1, 100.0}}),
                           payload({1, DefineLabels{{{1, {"a\nb", {}, "", 0}}}}})}) {
    const auto saved = decode_journal(joined({header, record_of(bad)}));
    ASSERT_FALSE(saved);
    EXPECT_EQ(saved.error().code, Errc::corrupt_data);
    EXPECT_NE(saved.error().message.find("at byte " + std::to_string(header.size())), std::string::npos);
  }
  EXPECT_TRUE(decode_journal(joined({header, record_of(payload({1, PaintPoints{{999}, 1}}))})));
}

TEST(AnnotationJournalFormat, OtherFilesAndVersionsAreNamed) {
  const std::string text =
      "not a session at all, but long enough that its header could be there, or so it is hoped here";
  EXPECT_EQ(decode_journal(as_byte_span(text)).error().message, "this is not an annotation session");
  EXPECT_EQ(decode_journal({}).error().message, "this is not an annotation session");
  Bytes newer = encode_journal_header(subject_of_journal());
  newer[8] = std::byte{2};
  EXPECT_EQ(decode_journal(newer).error().code, Errc::unsupported);
  SessionSubject bad = subject_of_journal();
  bad.graph.max_path = -1.0;
  EXPECT_EQ(decode_journal(encode_journal_header(bad)).error().code, Errc::corrupt_data);
}

TEST(SessionSubject, SaysWhatDiffers) {
  const SessionSubject saved = subject_of_journal();
  const auto why_not = [&](const auto& change) {
    SessionSubject other = saved;
    change(other);
    const Status same = check_same_subject(saved, other);
    return same ? "" : same.error().message;
  };
  EXPECT_EQ(why_not([](auto& other) { other.cloud_name = "moved.pcd"; }), "");
  EXPECT_EQ(why_not([](auto& other) {
              other.points = 7;
              other.cloud_name = "b.pcd";
            }),
            "the session belongs to the cloud \"k\xC3\xBC"
            "che.pcd\" of 1000 points; \"b.pcd\" has 7");
  EXPECT_NE(why_not([](auto& other) { other.positions_hash = 7; }).find("at other positions"), std::string::npos);
  EXPECT_NE(why_not([](auto& other) { other.graph.neighbours = 7; }).find("another graph"), std::string::npos);
  EXPECT_NE(why_not([](auto& other) { other.graph.normal_weight = 7; }).find("another graph"), std::string::npos);
  EXPECT_NE(why_not([](auto& other) { other.graph.adapt_to_density = true; }).find("another graph"), std::string::npos);
  EXPECT_NE(why_not([](auto& other) { other.graph.strong_borders = true; }).find("another graph"), std::string::npos);
}

TEST(SessionSubject, HashIsOfPositionsInTheirOrder) {
  PointCloud cloud = test::patchy_cloud(5);
  const std::uint64_t hash = hash_positions(cloud);
  EXPECT_EQ(hash_positions(test::patchy_cloud(5)), hash);
  cloud.colors[0].x() = 0.1F;
  EXPECT_EQ(hash_positions(cloud), hash);
  std::swap(cloud.positions_m[0], cloud.positions_m[1]);
  EXPECT_NE(hash_positions(cloud), hash);
  std::swap(cloud.positions_m[0], cloud.positions_m[1]);
  cloud.positions_m[3].z() = std::nextafter(cloud.positions_m[3].z(), 1.0F);
  EXPECT_NE(hash_positions(cloud), hash);
  EXPECT_EQ(hash_positions(PointCloud{}), 0xa8c7f832281a39c5ULL);  // hash of eight zero bytes
}

}  // namespace
}  // namespace saccade

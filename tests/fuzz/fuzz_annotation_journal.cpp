// SPDX-License-Identifier: Apache-2.0
// Feeds the reader of annotation sessions: as they are (first byte even), or with the checksums of records put right.
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "saccade/annotate/action.hpp"
#include "saccade/io/files/crc32.hpp"
#include "saccade/io/sessions/annotation_session.hpp"

namespace {

using Bytes = std::vector<std::byte>;

constexpr std::size_t kFixedHeaderBytes{72};
constexpr std::size_t kRecordHeaderBytes{12};
constexpr std::size_t kMostPoints{1000};

void require(bool condition) {
  if (!condition) std::abort();
}

std::uint32_t number_at(const Bytes& file, std::size_t offset) {
  std::uint32_t number = 0;
  std::memcpy(&number, &file[offset], sizeof number);
  return number;
}

/// Writes the checksum of `size` bytes right behind them.
void repair(Bytes& file, std::size_t offset, std::size_t size) {
  const std::uint32_t crc = saccade::crc32(std::span{file}.subspan(offset, size));
  std::memcpy(&file[offset + size], &crc, sizeof crc);
}

void repair_all(Bytes& file) {
  if (file.size() < kFixedHeaderBytes + 4) return;
  const std::size_t name = number_at(file, 12);
  std::size_t at = kFixedHeaderBytes + name + 4;
  if (at > file.size()) return;
  repair(file, 0, kFixedHeaderBytes + name);
  while (at + kRecordHeaderBytes <= file.size()) {
    const std::size_t payload = number_at(file, at);
    const std::size_t next = at + kRecordHeaderBytes + payload;
    if (next > file.size()) return;
    const std::uint32_t crc = saccade::crc32(std::span{file}.subspan(at + kRecordHeaderBytes, payload));
    std::memcpy(&file[at + 4], &crc, sizeof crc);
    repair(file, at, 8);
    at = next;
  }
}

void check_journal(const Bytes& file) {
  const auto saved = saccade::decode_journal(file);
  if (!saved) return;
  require(saved->good_bytes + saved->torn_bytes == file.size());
  Bytes again = saccade::encode_journal_header(saved->subject);
  for (const saccade::AnnotationAction& action : saved->actions) {
    const Bytes record = saccade::encode_journal_record(action);
    again.insert(again.end(), record.begin(), record.end());
  }
  require(again.size() == saved->good_bytes && std::equal(again.begin(), again.end(), file.begin()));
  if (saved->subject.points > kMostPoints) return;
  saccade::ActionHistory history{static_cast<std::size_t>(saved->subject.points)};
  for (const saccade::AnnotationAction& action : saved->actions) history.push(action);
  saccade::ActionHistory active{static_cast<std::size_t>(saved->subject.points)};
  for (const saccade::AnnotationAction& action : history.active()) active.push(action);
  for (std::uint32_t point = 0; point < saved->subject.points; ++point) {
    require(history.control_point(point) == active.control_point(point));
    require(history.painted(point) == active.painted(point));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const auto* first = reinterpret_cast<const std::byte*>(data);
  Bytes file(first + 1, first + size);
  if (data[0] % 2 == 1) repair_all(file);
  check_journal(file);
  return 0;
}

// SPDX-License-Identifier: Apache-2.0
// Bytes of a journal: decode_journal and the encoders of annotation_journal.hpp.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <type_traits>

#include "saccade/core/fnv1a.hpp"
#include "saccade/io/files/crc32.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/little_endian.hpp"
#include "saccade/io/files/text_scan.hpp"
#include "saccade/io/sessions/annotation_session.hpp"
#include "saccade/io/sessions/internal/annotation_records.hpp"

namespace saccade {
namespace {

using Bytes = std::vector<std::byte>;

constexpr std::array<char, 8> kMagic{'S', 'A', 'C', 'A', 'N', 'N', '\n', '\x1A'};
constexpr std::uint32_t kJournalVersion{1};
constexpr std::size_t kMaxNameBytes{4096};

constexpr std::uint32_t kAdaptToDensity{1};
constexpr std::uint32_t kStrongBorders{2};

/// Header before the cloud's name, which the header's checksum follows.
struct FixedHeader {
  std::array<char, 8> magic{kMagic};
  std::uint32_t version{kJournalVersion};
  std::uint32_t name_bytes{0};
  std::uint64_t points{0};
  std::uint64_t positions_hash{0};
  std::int32_t neighbours{0};
  std::uint32_t flags{0};  ///< kAdaptToDensity, kStrongBorders
  double position_weight_per_m{0.0};
  double normal_weight{0.0};
  double color_weight{0.0};
  double max_path{0.0};
};
static_assert(sizeof(FixedHeader) == 72 && std::is_trivially_copyable_v<FixedHeader>);

/// Header before each payload. Its own checksum distinguishes a damaged length from an incomplete end.
struct RecordHeader {
  std::uint32_t payload_bytes{0};
  std::uint32_t payload_crc{0};
  std::uint32_t header_crc{0};  ///< checksum of the eight bytes before

  [[nodiscard]] std::uint32_t own_crc() const { return crc32(std::as_bytes(std::span{this, 1}).first(8)); }
};
static_assert(sizeof(RecordHeader) == 12 && std::is_trivially_copyable_v<RecordHeader>);

Error damaged(std::size_t offset, const std::string& what) {
  return {Errc::corrupt_data, "the session is damaged at byte " + std::to_string(offset) + ": " + what, {}};
}

/// Returns the payload of a sound record at the reader's position, and moves behind it; nullopt where there is none.
std::optional<std::span<const std::byte>> take_record(ByteReader& reader) {
  ByteReader ahead = reader;
  if (!ahead.has(sizeof(RecordHeader))) return std::nullopt;
  const auto header = ahead.value<RecordHeader>();
  if (header.header_crc != header.own_crc() || !ahead.has(header.payload_bytes)) return std::nullopt;
  const auto payload = ahead.take(header.payload_bytes);
  if (crc32(payload) != header.payload_crc) return std::nullopt;
  reader = ahead;
  return payload;
}

/// Tells whether a record follows the unsound bytes at the reader's position.
bool another_follows(const ByteReader& reader) {
  ByteReader ahead = reader;
  if (ahead.has(sizeof(RecordHeader))) {
    const auto header = ahead.value<RecordHeader>();
    if (header.header_crc == header.own_crc()) return ahead.left() > header.payload_bytes;
  }
  ByteReader later = reader;
  while (later.left() > sizeof(RecordHeader)) {
    static_cast<void>(later.take(1));
    ByteReader record = later;
    if (take_record(record)) return true;
  }
  return false;
}

Result<SessionSubject> read_header(ByteReader& reader) {
  const ByteReader start = reader;
  const std::size_t present = std::min(reader.left(), kMagic.size());
  const bool is_session =
      present > 0 && std::memcmp(ByteReader{reader}.take(present).data(), kMagic.data(), present) == 0;
  if (!is_session) return Error{Errc::corrupt_data, "this is not an annotation session", {}};
  const Error short_header = damaged(reader.left(), "the file ends within its header");
  if (!reader.has(sizeof(FixedHeader))) return short_header;
  const auto header = reader.value<FixedHeader>();
  if (header.version != kJournalVersion) {
    return Error{Errc::unsupported,
                 "the session has format version " + std::to_string(header.version) + ", this program reads version " +
                     std::to_string(kJournalVersion),
                 {}};
  }
  if (header.name_bytes > kMaxNameBytes) return damaged(12, "the cloud's name is too long");
  if (!reader.has(header.name_bytes + sizeof(std::uint32_t))) return short_header;
  const auto name = reader.take(header.name_bytes);
  const std::uint32_t crc = crc32(ByteReader{start}.take(sizeof(FixedHeader) + header.name_bytes));
  if (reader.value<std::uint32_t>() != crc) return damaged(0, "the header's checksum is wrong");
  SessionSubject subject{std::string{as_text(name)}, header.points, header.positions_hash, {}};
  subject.graph = {header.neighbours,
                   header.position_weight_per_m,
                   header.normal_weight,
                   header.color_weight,
                   header.max_path,
                   (header.flags & kAdaptToDensity) != 0,
                   (header.flags & kStrongBorders) != 0};
  if (const Status valid = subject.graph.validate(); !valid) return damaged(0, valid.error().message);
  if (subject.points >= kUnlabelled || header.flags > (kAdaptToDensity | kStrongBorders))
    return damaged(0, "the header makes no sense");
  return subject;
}

}  // namespace

std::uint64_t hash_positions(const PointCloud& cloud) {
  Fnv1a hash;
  hash.add(std::uint64_t{cloud.positions_m.size()});
  for (const Eigen::Vector3f& p : cloud.positions_m) {
    const auto bits = [&](int axis) { return std::uint64_t{std::bit_cast<std::uint32_t>(p[axis])}; };
    hash.add(bits(0) | bits(1) << 32U);
    hash.add(bits(2));
  }
  return hash.value();
}

Status check_same_subject(const SessionSubject& saved, const SessionSubject& wanted) {
  const auto differs = [](const std::string& what) { return Error{Errc::invalid_argument, what, {}}; };
  constexpr std::size_t kShownBytes{200};
  const std::string name = readable(wanted.cloud_name, kShownBytes);
  const std::string begin = "the session belongs to the cloud \"" + readable(saved.cloud_name, kShownBytes) + "\" of ";
  if (saved.points != wanted.points) {
    return differs(begin + std::to_string(saved.points) + " points; \"" + name + "\" has " +
                   std::to_string(wanted.points));
  }
  if (saved.positions_hash != wanted.positions_hash) {
    return differs(begin + "as many points, but at other positions than those of \"" + name + "\"");
  }
  const NeighbourhoodConfig& a = saved.graph;
  const NeighbourhoodConfig& b = wanted.graph;
  const bool same = a.neighbours == b.neighbours && a.position_weight_per_m == b.position_weight_per_m &&
                    a.normal_weight == b.normal_weight && a.color_weight == b.color_weight &&
                    a.max_path == b.max_path && a.adapt_to_density == b.adapt_to_density &&
                    a.strong_borders == b.strong_borders;
  return same ? Status{} : differs("the session was begun with another graph; take its neighbours, weights and path");
}

Bytes encode_journal_header(const SessionSubject& subject) {
  FixedHeader header;
  const auto name = as_byte_span(subject.cloud_name).first(std::min(subject.cloud_name.size(), kMaxNameBytes));
  header.name_bytes = static_cast<std::uint32_t>(name.size());
  header.points = subject.points;
  header.positions_hash = subject.positions_hash;
  header.neighbours = subject.graph.neighbours;
  header.flags =
      (subject.graph.adapt_to_density ? kAdaptToDensity : 0) | (subject.graph.strong_borders ? kStrongBorders : 0);
  header.position_weight_per_m = subject.graph.position_weight_per_m;
  header.normal_weight = subject.graph.normal_weight;
  header.color_weight = subject.graph.color_weight;
  header.max_path = subject.graph.max_path;
  Bytes out;
  out.reserve(sizeof header + name.size() + sizeof(std::uint32_t));
  append_value(out, header);
  out.insert(out.end(), name.begin(), name.end());
  append_value(out, crc32(out));
  return out;
}

Bytes encode_journal_record(const AnnotationAction& action) {
  Bytes out(sizeof(RecordHeader));
  append_action(action, out);
  const auto payload = std::span{out}.subspan(sizeof(RecordHeader));
  SACCADE_EXPECTS(payload.size() <= std::numeric_limits<std::uint32_t>::max());
  RecordHeader header{static_cast<std::uint32_t>(payload.size()), crc32(payload), 0};
  header.header_crc = header.own_crc();
  std::memcpy(out.data(), &header, sizeof header);
  return out;
}

Result<SavedSession> decode_journal(std::span<const std::byte> file) {
  ByteReader reader{file};
  SavedSession saved;
  SACCADE_TRY(saved.subject, read_header(reader));
  while (reader.left() > 0) {
    const std::size_t offset = reader.offset();
    const auto payload = take_record(reader);
    if (!payload) {
      if (another_follows(reader)) return damaged(offset, "the record of an action is not what was written");
      break;
    }
    auto action = read_action(*payload);
    if (!action) return damaged(offset, action.error().message);
    const Status valid = check_action(*action, saved.subject.points, saved.subject.graph.max_path);
    if (!valid) return damaged(offset, valid.error().message);
    saved.actions.push_back(*std::move(action));
  }
  saved.good_bytes = reader.offset();
  saved.torn_bytes = reader.left();
  return saved;
}

Result<SavedSession> read_journal(const std::filesystem::path& path) {
  SACCADE_TRY(const Bytes bytes, read_file(path));
  auto saved = decode_journal(bytes);
  if (!saved) return in_file(saved.error(), path);
  return saved;
}

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#pragma once
// AnnotationJournal: the file of an annotation session, one record per action. docs/formats.md.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "saccade/annotate/action.hpp"
#include "saccade/annotate/neighbourhood.hpp"
#include "saccade/io/files/descriptor.hpp"

namespace saccade {

/// What a session is about: its actions mean something for these points and this graph only.
struct SessionSubject {
  std::string cloud_name;  ///< for messages; a file that was moved is the same cloud
  std::uint64_t points{0};
  std::uint64_t positions_hash{0};
  NeighbourhoodConfig graph;
};

/// Of the bits of all positions in their order; the same on every machine.
[[nodiscard]] std::uint64_t hash_positions(const PointCloud& cloud);

/// invalid_argument, saying what differs, unless points, positions and graph are the same.
[[nodiscard]] Status check_same_subject(const SessionSubject& saved, const SessionSubject& wanted);

/// What a journal holds.
struct SavedSession {
  SessionSubject subject;
  std::vector<AnnotationAction> actions;
  std::uint64_t good_bytes{0};  ///< up to the end of the last whole record
  std::uint64_t torn_bytes{0};  ///< after them, of an action that was not acknowledged
};

/// An end that is no whole record is torn_bytes. corrupt_data with the byte for damage before that, and for records
/// that no session writes; unsupported for another version.
[[nodiscard]] Result<SavedSession> decode_journal(std::span<const std::byte> file);
[[nodiscard]] Result<SavedSession> read_journal(const std::filesystem::path& path);

// Both parts of a journal.
[[nodiscard]] std::vector<std::byte> encode_journal_header(const SessionSubject& subject);
[[nodiscard]] std::vector<std::byte> encode_journal_record(const AnnotationAction& action);

/// Appends actions. Where this fails, what was written of the action is taken back, and the journal refuses everything
/// from then on. No other process can open it meanwhile. One thread.
class AnnotationJournal {
 public:
  struct Opened;

  /// Opens a journal, or begins one: the file appears whole, with no action. A torn end is cut off. A file that cannot
  /// be written but read is opened read-only, with refusal() to say so.
  /// @return errors of read_journal; unavailable when another process has it open; io_failure; errors of
  /// check_same_subject: the file stays as it is.
  [[nodiscard]] static Result<Opened> open_or_create(const std::filesystem::path& path, const SessionSubject& subject);

  /// The action is on the disk when this returns well: one write and fdatasync. io_failure otherwise.
  [[nodiscard]] Status append(const AnnotationAction& action);
  /// Why append refuses; none: it does not.
  [[nodiscard]] const std::optional<Error>& refusal() const { return refusal_; }

 private:
  AnnotationJournal() = default;
  [[nodiscard]] Status open(const std::filesystem::path& path);
  void refuse(const std::string& what, int code);

  std::filesystem::path path_;
  Descriptor file_;
  std::uint64_t end_{0};
  std::optional<Error> refusal_;
};

struct AnnotationJournal::Opened {
  AnnotationJournal journal;
  SavedSession saved;  ///< before its torn end was cut off
  bool created{false};
};

}  // namespace saccade

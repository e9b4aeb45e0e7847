// SPDX-License-Identifier: Apache-2.0
#pragma once
// AnnotationSession: an annotation whose every action is on the disk before it counts; AnnotationJournal: its file, one
// record per action. docs/formats.md.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "saccade/annotate/action.hpp"
#include "saccade/annotate/annotation.hpp"
#include "saccade/annotate/neighbourhood.hpp"
#include "saccade/io/files/file_io.hpp"

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

/// How a session was found.
struct SessionOpening {
  bool created{false};
  std::uint64_t actions{0};     ///< undo and redo among them
  std::uint64_t torn_bytes{0};  ///< at the end, of an action that was not acknowledged; they are gone
};

/// However a session ends, also by kill −9 or a loss of power within a write, what apply returned well is there when it
/// is opened again, and nothing else but at most one action that was being applied. A disk that is full or fails leaves
/// a session that can be read. The cloud itself is never touched. One thread; clients are told apart by
/// AnnotationAction::client.
class AnnotationSession {
 public:
  /// Opens the session in this file, or begins one. A session that exists must be of the same positions and graph: its
  /// graph's configuration is in read_journal(path)->subject.
  /// @return errors of AnnotationJournal::open_or_create. 10⁴ actions: milliseconds, and one build of the forest.
  [[nodiscard]] static Result<AnnotationSession> open_or_create(
      const std::filesystem::path& path, std::string cloud_name, std::uint64_t positions_hash,
      const std::shared_ptr<const Neighbourhood>& neighbourhood, const Executor& executor = {});

  /// The same in two steps: the journal is locked and read before there is a graph. Expects one that fits the subject
  /// with which the journal was opened.
  [[nodiscard]] static AnnotationSession restore(AnnotationJournal::Opened opened,
                                                 const std::shared_ptr<const Neighbourhood>& neighbourhood,
                                                 const Executor& executor = {});

  /// Errors of Annotation::validate; io_failure when the action could not be written: it was not done, and the session
  /// is read-only from then on. Undo and redo with nothing to do are no errors (Applied::done) and are not written.
  [[nodiscard]] Result<Applied> apply(AnnotationAction action);

  [[nodiscard]] const Annotation& annotation() const { return annotation_; }
  [[nodiscard]] const SessionOpening& opening() const { return opening_; }
  /// Why nothing can be changed; none: it can.
  [[nodiscard]] const std::optional<Error>& read_only() const { return journal_.refusal(); }

 private:
  AnnotationSession(AnnotationJournal journal, Annotation annotation, SessionOpening opening)
      : journal_{std::move(journal)}, annotation_{std::move(annotation)}, opening_{opening} {}

  AnnotationJournal journal_;
  Annotation annotation_;
  SessionOpening opening_;
};

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#pragma once
// AnnotationSession: an annotation whose every action is on the disk before it counts. AnnotationJournal: its file,
// with one record per action. docs/reference/formats.md.

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

/// Subject of a session: its actions are valid only for these points and this graph.
struct SessionSubject {
  std::string cloud_name;  ///< for messages; a moved file is the same cloud
  std::uint64_t points{0};
  std::uint64_t positions_hash{0};
  NeighbourhoodConfig graph;
};

/// Returns a hash of the bits of all positions in order; equal on every machine.
[[nodiscard]] std::uint64_t hash_positions(const PointCloud& cloud);

/// Answers invalid_argument, naming the difference, unless points, positions and graph are equal.
[[nodiscard]] Status check_same_subject(const SessionSubject& saved, const SessionSubject& wanted);

/// Content of a journal.
struct SavedSession {
  SessionSubject subject;
  std::vector<AnnotationAction> actions;
  std::uint64_t good_bytes{0};  ///< up to the end of the last complete record
  std::uint64_t torn_bytes{0};  ///< bytes after them, of an action that was not acknowledged
};

/// Decodes a journal; an incomplete record at the end is torn_bytes. Answers corrupt_data with the byte for damage
/// before that, and for records that no session writes; unsupported for another version.
[[nodiscard]] Result<SavedSession> decode_journal(std::span<const std::byte> file);
[[nodiscard]] Result<SavedSession> read_journal(const std::filesystem::path& path);

// Return the two parts of a journal.
[[nodiscard]] std::vector<std::byte> encode_journal_header(const SessionSubject& subject);
[[nodiscard]] std::vector<std::byte> encode_journal_record(const AnnotationAction& action);

/// Journal to which actions are appended. If that fails, the partial record is removed, and the journal rejects
/// everything from then on. No other process can open it meanwhile. One thread.
class AnnotationJournal {
 public:
  struct Opened;

  /// Opens a journal, or begins one: the file appears complete, without actions. A torn end is cut off. A file that can
  /// be read but not written is opened read-only; refusal() then tells why.
  /// @return errors of read_journal; unavailable when another process has it open; io_failure; errors of
  /// check_same_subject: the file stays unchanged.
  [[nodiscard]] static Result<Opened> open_or_create(const std::filesystem::path& path, const SessionSubject& subject);

  /// Appends an action, which is on the disk after success: one write and fdatasync. Answers io_failure otherwise.
  [[nodiscard]] Status append(const AnnotationAction& action);
  /// Returns why append refuses; nullopt: it does not.
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

/// State in which a session was found.
struct SessionOpening {
  bool created{false};
  std::uint64_t actions{0};     ///< including undo and redo
  std::uint64_t torn_bytes{0};  ///< bytes of an action at the end that was not acknowledged; they are removed
};

/// Annotation on disk. However a session ends, even by kill −9 or a loss of power within a write, every acknowledged
/// action is there when it is opened again, and at most one more that was being applied. After a full or failing disk
/// the session can still be read. The cloud itself is never changed. One thread; clients are distinguished by
/// AnnotationAction::client.
class AnnotationSession {
 public:
  /// Opens the session in this file, or begins one. An existing session must have equal positions and graph: its
  /// graph's configuration is in read_journal(path)->subject.
  /// @return errors of AnnotationJournal::open_or_create. 10⁴ actions: milliseconds, and one build of the forest.
  [[nodiscard]] static Result<AnnotationSession> open_or_create(
      const std::filesystem::path& path, std::string cloud_name, std::uint64_t positions_hash,
      const std::shared_ptr<const Neighbourhood>& neighbourhood, const Executor& executor = {});

  /// Completes opening in two steps: the journal is locked and read before there is a graph. Expects a graph that fits
  /// the subject with which the journal was opened.
  [[nodiscard]] static AnnotationSession restore(AnnotationJournal::Opened opened,
                                                 const std::shared_ptr<const Neighbourhood>& neighbourhood,
                                                 const Executor& executor = {});

  /// Applies an action. Answers the errors of Annotation::validate; io_failure when the action could not be written: it
  /// was not performed, and the session is read-only from then on. Undo and redo with nothing to do are not errors
  /// (Applied::done) and are not written.
  [[nodiscard]] Result<Applied> apply(AnnotationAction action);

  [[nodiscard]] const Annotation& annotation() const { return annotation_; }
  [[nodiscard]] const SessionOpening& opening() const { return opening_; }
  /// Returns why nothing can be changed; nullopt: changes are possible.
  [[nodiscard]] const std::optional<Error>& read_only() const { return journal_.refusal(); }

 private:
  AnnotationSession(AnnotationJournal journal, Annotation annotation, SessionOpening opening)
      : journal_{std::move(journal)}, annotation_{std::move(annotation)}, opening_{opening} {}

  AnnotationJournal journal_;
  Annotation annotation_;
  SessionOpening opening_;
};

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#pragma once
// AnnotationSession: an annotation whose every action is on the disk before it counts.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "saccade/annotate/annotation.hpp"
#include "saccade/io/sessions/annotation_journal.hpp"

namespace saccade {

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

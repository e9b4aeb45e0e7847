// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/sessions/annotation_session.hpp"

#include <utility>

namespace saccade {

Result<AnnotationSession> AnnotationSession::open_or_create(const std::filesystem::path& path, std::string cloud_name,
                                                            std::uint64_t positions_hash,
                                                            const std::shared_ptr<const Neighbourhood>& neighbourhood,
                                                            const Executor& executor) {
  const SessionSubject subject{std::move(cloud_name), neighbourhood->size(), positions_hash, neighbourhood->config()};
  SACCADE_TRY(AnnotationJournal::Opened opened, AnnotationJournal::open_or_create(path, subject));
  return restore(std::move(opened), neighbourhood, executor);
}

AnnotationSession AnnotationSession::restore(AnnotationJournal::Opened opened,
                                             const std::shared_ptr<const Neighbourhood>& neighbourhood,
                                             const Executor& executor) {
  SACCADE_EXPECTS(opened.saved.subject.points == neighbourhood->size());
  Annotation annotation{neighbourhood, executor};
  annotation.restore(opened.saved.actions);
  const SessionOpening opening{opened.created, annotation.history().size(), opened.saved.torn_bytes};
  return AnnotationSession{std::move(opened.journal), std::move(annotation), opening};
}

Result<Applied> AnnotationSession::apply(AnnotationAction action) {
  SACCADE_CHECK(annotation_.validate(action));
  const ActionHistory& history = annotation_.history();
  const bool nothing = (std::holds_alternative<UndoAction>(action.change) && !history.can_undo(action.client)) ||
                       (std::holds_alternative<RedoAction>(action.change) && !history.can_redo(action.client));
  if (!nothing) SACCADE_CHECK(journal_.append(action));
  return annotation_.apply(std::move(action));
}

}  // namespace saccade

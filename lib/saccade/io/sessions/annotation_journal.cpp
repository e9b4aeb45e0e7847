// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/sessions/annotation_session.hpp"

#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/sessions/internal/annotation_records.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// Writes all bytes from an offset on; returns errno of the failure, or 0.
int write_at(int fd, std::span<const std::byte> bytes, std::uint64_t offset) {
  while (!bytes.empty()) {
    const ssize_t put = ::pwrite(fd, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) return errno;
    if (put == 0) return EIO;
    bytes = bytes.subspan(static_cast<std::size_t>(put));
    offset += static_cast<std::uint64_t>(put);
  }
  return 0;
}

bool cut_off(int fd, std::uint64_t end) {
  return ::ftruncate(fd, static_cast<off_t>(end)) == 0 && ::fdatasync(fd) == 0;
}

}  // namespace

Status AnnotationJournal::open(const fs::path& path) {
  path_ = path;
  file_ = Descriptor{::open(path.c_str(), O_RDWR | O_CLOEXEC)};
  const int code = errno;
  if (file_.get() < 0 && (code == EACCES || code == EPERM || code == EROFS)) {
    file_ = Descriptor{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
    refuse("the session cannot be written", code);
  }
  struct stat info {};
  if (file_.get() < 0 || ::fstat(file_.get(), &info) != 0) {
    return Error{code == ENOENT ? Errc::not_found : Errc::io_failure,
                 std::string{"cannot open the session: "} + std::strerror(code), path.string()};
  }
  if (!S_ISREG(info.st_mode))
    return Error{Errc::invalid_argument, "is not a file of an annotation session", path.string()};
  if (refusal_ || ::flock(file_.get(), LOCK_EX | LOCK_NB) == 0) return {};
  if (errno == EWOULDBLOCK) {
    return Error{Errc::unavailable, "another program has this session open; end it there, or work on a copy",
                 path.string()};
  }
  return Error{Errc::io_failure, std::string{"cannot lock the session: "} + std::strerror(errno), path.string()};
}

void AnnotationJournal::refuse(const std::string& what, int code) {
  const bool full = code == ENOSPC || code == EDQUOT || code == EFBIG;
  refusal_ = Error{Errc::io_failure,
                   what + ": " + std::strerror(code) + "; it can be read, but not changed" +
                       (full ? " until there is room and it is opened again" : ""),
                   path_.string()};
}

Result<AnnotationJournal::Opened> AnnotationJournal::open_or_create(const fs::path& path,
                                                                    const SessionSubject& subject) {
  Opened opened{AnnotationJournal{}, {}, false};
  AnnotationJournal& journal = opened.journal;
  Status status = journal.open(path);
  if (!status && status.error().code == Errc::not_found) {
    SACCADE_TRY(AtomicFile file, AtomicFile::create(path));
    SACCADE_CHECK(file.write(encode_journal_header(subject)));
    SACCADE_TRY(opened.created, file.commit_new());
    status = journal.open(path);
  }
  if (!status) return status.error();
  SACCADE_TRY(opened.saved, read_journal(path));
  if (const Status same = check_same_subject(opened.saved.subject, subject); !same) {
    return in_file(same.error(), path);
  }
  journal.end_ = opened.saved.good_bytes;
  if (opened.saved.torn_bytes > 0 && !journal.refusal_ && !cut_off(journal.file_.get(), journal.end_)) {
    journal.refuse("the end of the session cannot be repaired", errno);
  }
  return opened;
}

Status AnnotationJournal::append(const AnnotationAction& action) {
  if (refusal_) return *refusal_;
  const std::vector<std::byte> record = encode_journal_record(action);
  int code = write_at(file_.get(), record, end_);
  if (code == 0 && ::fdatasync(file_.get()) != 0) code = errno;
  if (code != 0) {
    cut_off(file_.get(), end_);
    refuse("the action was not done, since the session cannot be written", code);
    return *refusal_;
  }
  end_ += record.size();
  return {};
}

}  // namespace saccade

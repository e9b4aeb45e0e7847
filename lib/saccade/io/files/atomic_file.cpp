// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/files/file_io.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "saccade/io/files/leftovers.hpp"

namespace saccade {
namespace {

constexpr std::size_t kBufferBytes{std::size_t{1} << 18U};

/// Makes the rename itself durable; ignores file systems that cannot do this for folders.
void sync_folder(const std::filesystem::path& folder) {
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;
  ::fsync(fd);
  ::close(fd);
}

}  // namespace

Result<AtomicFile> AtomicFile::create(const std::filesystem::path& destination) {
  AtomicFile file;
  file.shown_ = destination;
  if (!destination.has_filename()) {
    return Error{Errc::invalid_argument, "is not the name of a file to write", destination.string()};
  }
  std::error_code ignored;
  const auto status = std::filesystem::status(destination, ignored);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    return Error{Errc::invalid_argument, "exists and is not a regular file; name another one", destination.string()};
  }
  file.destination_ = std::filesystem::exists(status) ? std::filesystem::canonical(destination, ignored) : destination;
  if (!file.destination_.has_parent_path()) file.destination_ = "." / file.destination_;
  remove_leftovers(file.destination_);
  file.temporary_ = file.destination_.parent_path() / make_temporary_name(file.destination_.filename().string());
  file.fd_ = ::open(file.temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file.fd_ < 0) {
    file.temporary_.clear();
    return file.failure("cannot create a file in this folder");
  }
  ::flock(file.fd_, LOCK_EX | LOCK_NB);  // keeps others from removing it
  if (struct stat info{}; ::stat(file.destination_.c_str(), &info) == 0) ::fchmod(file.fd_, info.st_mode & 07777U);
  return file;
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : fd_{std::exchange(other.fd_, -1)},
      shown_{std::move(other.shown_)},
      destination_{std::move(other.destination_)},
      temporary_{std::exchange(other.temporary_, {})},
      buffer_{std::move(other.buffer_)} {}

AtomicFile& AtomicFile::operator=(AtomicFile&& other) noexcept {
  if (this == &other) return *this;
  discard();
  fd_ = std::exchange(other.fd_, -1);
  shown_ = std::move(other.shown_);
  destination_ = std::move(other.destination_);
  temporary_ = std::exchange(other.temporary_, {});
  buffer_ = std::move(other.buffer_);
  return *this;
}

AtomicFile::~AtomicFile() { discard(); }

void AtomicFile::discard() noexcept {
  if (fd_ >= 0) ::close(std::exchange(fd_, -1));
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
}

Error AtomicFile::failure(const char* what) const {
  const int code = errno;
  const char* advice = code == ENOSPC || code == EDQUOT ? "; make room or write elsewhere" : "";
  return {Errc::io_failure, std::string{what} + ": " + std::strerror(code) + advice, shown_.string()};
}

Status AtomicFile::flush() {
  std::size_t done = 0;
  while (done < buffer_.size()) {
    const ssize_t put = ::write(fd_, buffer_.data() + done, buffer_.size() - done);
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) {
      Error error = failure("cannot write");
      discard();
      return error;
    }
    done += static_cast<std::size_t>(put);
  }
  buffer_.clear();
  return {};
}

Status AtomicFile::write(std::span<const std::byte> bytes) { return write(as_text(bytes)); }

Status AtomicFile::write(std::string_view text) {
  if (fd_ < 0) return Error{Errc::io_failure, "cannot write: an earlier write failed", shown_.string()};
  while (!text.empty()) {
    const std::size_t part = std::min(text.size(), kBufferBytes - buffer_.size());
    buffer_.append(text.substr(0, part));
    text.remove_prefix(part);
    if (buffer_.size() == kBufferBytes) SACCADE_CHECK(flush());
  }
  return {};
}

/// Flushes everything to the disk under the temporary's name, and closes the file.
Status AtomicFile::finish() {
  if (fd_ < 0) return Error{Errc::io_failure, "cannot write: an earlier write failed", shown_.string()};
  SACCADE_CHECK(flush());
  const bool synced = ::fsync(fd_) == 0 || errno == EINVAL || errno == EROFS;
  if (synced && ::close(std::exchange(fd_, -1)) == 0) return {};
  Error error = failure("cannot write");
  discard();
  return error;
}

Status AtomicFile::rename() {
  if (::rename(temporary_.c_str(), destination_.c_str()) != 0) {
    Error error = failure("cannot rename the finished file");
    discard();
    return error;
  }
  temporary_.clear();
  sync_folder(destination_.parent_path());
  return {};
}

Status AtomicFile::commit() {
  SACCADE_CHECK(finish());
  return rename();
}

Result<bool> AtomicFile::commit_new() {
  SACCADE_CHECK(finish());
  // A second name is rejected where a file exists; on file systems without links this protection is lost.
  const bool linked = ::link(temporary_.c_str(), destination_.c_str()) == 0;
  const bool taken = !linked && errno == EEXIST;
  if (!linked && !taken) SACCADE_CHECK(rename());
  discard();
  sync_folder(destination_.parent_path());
  return !taken;
}

Status write_file_atomically(const std::filesystem::path& destination, std::span<const std::byte> bytes) {
  SACCADE_TRY(AtomicFile file, AtomicFile::create(destination));
  SACCADE_CHECK(file.write(bytes));
  return file.commit();
}

Status write_file_atomically(const std::filesystem::path& destination, std::string_view text) {
  return write_file_atomically(destination, as_byte_span(text));
}

}  // namespace saccade

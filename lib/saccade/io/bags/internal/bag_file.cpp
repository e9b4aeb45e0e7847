// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/bags/internal/bag_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace saccade::internal::io_bags {

Result<BagFile> BagFile::open(const std::filesystem::path& path) {
  Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  struct stat about {};
  if (file.get() < 0 || ::fstat(file.get(), &about) != 0) {
    const int reason = errno;
    return Error{reason == ENOENT || reason == ENOTDIR ? Errc::not_found : Errc::io_failure,
                 std::string{"cannot be opened: "} + std::strerror(reason), path.string()};
  }
  if (!S_ISREG(about.st_mode)) return Error{Errc::io_failure, "this is not a file", path.string()};
  return BagFile{std::move(file), static_cast<std::uint64_t>(about.st_size)};
}

std::size_t BagFile::read(std::uint64_t offset, std::span<std::byte> out) const {
  std::size_t done = 0;
  while (done < out.size() && offset + done < size_) {
    const ::ssize_t count =
        ::pread(file_.get(), out.data() + done, out.size() - done, static_cast<::off_t>(offset + done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    done += static_cast<std::size_t>(count);
  }
  return done;
}

ByteWindow::ByteWindow(const BagFile& file, std::uint64_t begin, std::uint64_t size) : file_{&file} {
  move_to(begin, size);
}

void ByteWindow::move_to(std::uint64_t begin, std::uint64_t size) {
  SACCADE_EXPECTS(file_ != nullptr);
  begin_ = std::min(begin, file_->size());
  size_ = std::min(size, file_->size() - begin_);
  buffer_.clear();
}

std::span<const std::byte> ByteWindow::at(std::uint64_t offset, std::size_t count) {
  constexpr std::uint64_t kAhead{std::uint64_t{1} << 16U};
  if (offset >= size_) return {};
  count = static_cast<std::size_t>(std::min<std::uint64_t>(count, size_ - offset));
  if (file_ == nullptr) return memory_.subspan(static_cast<std::size_t>(offset), count);
  SACCADE_EXPECTS(count <= kMaxPieceBytes);
  if (offset < buffer_at_ || offset + count > buffer_at_ + buffer_.size()) {
    buffer_.resize(static_cast<std::size_t>(std::min(std::max<std::uint64_t>(count, kAhead), size_ - offset)));
    buffer_.resize(file_->read(begin_ + offset, buffer_));
    buffer_at_ = offset;
  }
  const auto from = static_cast<std::size_t>(offset - buffer_at_);
  return std::span<const std::byte>{buffer_}.subspan(from, std::min(count, buffer_.size() - from));
}

}  // namespace saccade::internal::io_bags

// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/files/file_io.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace saccade {
namespace {

Error open_error(const std::filesystem::path& path) {
  const int code = errno;
  if (code == ENOENT || code == ENOTDIR) return {Errc::not_found, "no such file", path.string()};
  return {Errc::io_failure, std::string{"cannot open: "} + std::strerror(code), path.string()};
}

template <class Container>
Result<Container> read_all(const std::filesystem::path& path, std::uintmax_t max_bytes) {
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  struct stat info {};
  if (file.get() < 0 || ::fstat(file.get(), &info) != 0) return open_error(path);
  if (S_ISDIR(info.st_mode)) return Error{Errc::io_failure, "is a folder, not a file", path.string()};
  constexpr std::size_t kStep{1 << 16};
  Container content;
  content.resize(std::min<std::uintmax_t>(info.st_size > 0 ? static_cast<std::uintmax_t>(info.st_size) : 0, max_bytes) +
                 1);
  std::size_t used = 0;
  while (true) {
    const ssize_t got = ::read(file.get(), content.data() + used, content.size() - used);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return Error{Errc::io_failure, std::string{"cannot read: "} + std::strerror(errno), path.string()};
    if (got == 0) break;
    used += static_cast<std::size_t>(got);
    if (used > max_bytes) {
      return Error{Errc::unsupported, "larger than the " + std::to_string(max_bytes) + " bytes read here",
                   path.string()};
    }
    if (used == content.size()) content.resize(used + std::max(used / 2, kStep));
  }
  content.resize(used);
  return content;
}

}  // namespace

Error in_file(Error error, const std::filesystem::path& path) {
  error.context = error.context.empty() ? path.string() : path.string() + ", " + error.context;
  return error;
}

Result<std::vector<std::byte>> read_file(const std::filesystem::path& path, std::uintmax_t max_bytes) {
  return read_all<std::vector<std::byte>>(path, max_bytes);
}

Result<std::string> read_text_file(const std::filesystem::path& path, std::uintmax_t max_bytes) {
  return read_all<std::string>(path, max_bytes);
}

std::span<const std::byte> as_byte_span(std::string_view text) {
  return std::as_bytes(std::span{text.data(), text.size()});
}

std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace saccade

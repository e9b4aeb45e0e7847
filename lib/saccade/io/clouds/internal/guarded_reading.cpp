// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/internal/guarded_reading.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "saccade/io/files/little_endian.hpp"

namespace saccade {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized{true};
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool kSanitized{true};
#else
constexpr bool kSanitized{false};
#endif
#else
constexpr bool kSanitized{false};
#endif

constexpr int kOutOfMemory{99};  // exit status of a child

/// First bytes of the child's answer.
struct Answer {
  std::uint32_t code{0};   ///< Errc where `error` > 0
  std::uint32_t error{0};  ///< bytes of the message that follows
  std::uint64_t vertices{0};
  std::uint64_t normals{0};
  std::uint64_t colors{0};
  std::uint64_t triangles{0};
};

bool write_all(int file, const void* data, std::size_t bytes) {
  const char* at = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t written = ::write(file, at, bytes);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    at += written;
    bytes -= static_cast<std::size_t>(written);
  }
  return true;
}

template <class T>
bool write_all(int file, const std::vector<T>& values) {
  return write_all(file, values.data(), values.size() * sizeof(T));
}

void set_limit(int resource, rlim_t limit) {
  rlimit current{};
  if (::getrlimit(static_cast<__rlimit_resource_t>(resource), &current) != 0) return;
  current.rlim_cur = std::min(limit, current.rlim_max);
  ::setrlimit(static_cast<__rlimit_resource_t>(resource), &current);
}

/// Address space of this process, bytes.
std::size_t address_space() {
  std::size_t pages{0};
  std::ifstream{"/proc/self/statm"} >> pages;
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

[[noreturn]] void answer(int file, const ReadLimits& limits, std::size_t space,
                         const std::function<Result<TriangleMesh>()>& read) {
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);  // assertions of a library say nothing to the user
  if (nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);
  for (const int each : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGXCPU, SIGTERM, SIGINT, SIGHUP}) {
    if (!kSanitized) std::signal(each, SIG_DFL);
  }
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_CPU, static_cast<rlim_t>(std::ceil(limits.seconds)));
  if (!kSanitized) set_limit(RLIMIT_AS, space + limits.bytes);
  try {
    const Result<TriangleMesh> mesh = read();
    Answer head;
    std::string message;
    if (mesh) {
      head = {0, 0, mesh->vertices.size(), mesh->normals.size(), mesh->colors.size(), mesh->triangles.size()};
    } else {
      message = mesh.error().message;
      head.code = static_cast<std::uint32_t>(mesh.error().code);
      head.error = static_cast<std::uint32_t>(message.size());
    }
    const bool sent = write_all(file, &head, sizeof(head)) && write_all(file, message.data(), message.size()) &&
                      (!mesh || (write_all(file, mesh->vertices) && write_all(file, mesh->normals) &&
                                 write_all(file, mesh->colors) && write_all(file, mesh->triangles)));
    ::_exit(sent ? 0 : 1);
  } catch (const std::bad_alloc&) {
    ::_exit(kOutOfMemory);
  } catch (...) {
    ::_exit(1);
  }
}

/// Reads until the child closes its end; false after the deadline.
bool read_until(int file, std::chrono::steady_clock::time_point deadline, std::vector<std::byte>& bytes) {
  constexpr std::size_t kChunk{1 << 20};
  while (true) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now()).count();
    if (left <= 0) return false;
    pollfd wait{file, POLLIN, 0};
    const int ready = ::poll(&wait, 1, static_cast<int>(std::min<long long>(left, 1000)));
    if (ready < 0 && errno != EINTR) return true;
    if (ready <= 0) continue;
    const std::size_t begin = bytes.size();
    bytes.resize(begin + kChunk);
    const ssize_t count = ::read(file, bytes.data() + begin, kChunk);
    bytes.resize(begin + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    if (count == 0 || (count < 0 && errno != EINTR)) return true;
  }
}

template <class T>
void take(ByteReader& reader, std::uint64_t count, std::vector<T>& values) {
  values.resize(count);
  const auto bytes = reader.take(count * sizeof(T));
  if (count > 0) std::memcpy(static_cast<void*>(values.data()), bytes.data(), bytes.size());
}

Result<TriangleMesh> mesh_of(std::span<const std::byte> bytes, const std::filesystem::path& path) {
  const Error cut{Errc::corrupt_data, "the reader ended in the middle of its answer", path.string()};
  ByteReader reader{bytes};
  if (!reader.has(sizeof(Answer))) return cut;
  const auto head = reader.value<Answer>();
  if (head.error > 0) {
    if (!reader.has(head.error)) return cut;
    const auto text = reader.take(head.error);
    return Error{
        static_cast<Errc>(head.code), {reinterpret_cast<const char*>(text.data()), text.size()}, path.string()};
  }
  const std::size_t expected = (head.vertices + head.normals) * sizeof(Eigen::Vector3f) + head.colors * sizeof(Rgb8) +
                               head.triangles * sizeof(std::array<std::uint32_t, 3>);
  if (reader.left() != expected) return cut;
  TriangleMesh mesh;
  take(reader, head.vertices, mesh.vertices);
  take(reader, head.normals, mesh.normals);
  take(reader, head.colors, mesh.colors);
  take(reader, head.triangles, mesh.triangles);
  return mesh;
}

}  // namespace

ReadLimits limits_for(const std::filesystem::path& path) {
  constexpr double kMebibyte{1 << 20};
  constexpr std::size_t kTimesItsSize{128};
  std::error_code code;
  const std::uintmax_t size = std::filesystem::file_size(path, code);
  ReadLimits limits;
  if (code) return limits;
  limits.seconds += static_cast<double>(size) / kMebibyte;
  limits.bytes += kTimesItsSize * static_cast<std::size_t>(size);
  return limits;
}

Result<TriangleMesh> read_guarded(const std::filesystem::path& path, const ReadLimits& limits,
                                  const std::function<Result<TriangleMesh>()>& read) {
  const auto fail = [&](Errc code, std::string what) { return Error{code, std::move(what), path.string()}; };
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    return fail(Errc::io_failure, std::string{"no pipe to a reader: "} + std::strerror(errno));
  }
  const std::size_t space = address_space();
  const pid_t child = ::fork();
  if (child == 0) answer(ends[1], limits, space, read);
  ::close(ends[1]);
  if (child < 0) {
    ::close(ends[0]);
    return fail(Errc::io_failure, std::string{"no process for a reader: "} + std::strerror(errno));
  }
  constexpr double kWallTimes{3.0};
  const auto deadline = std::chrono::steady_clock::now() +
                        std::chrono::milliseconds{static_cast<long long>(1000.0 * kWallTimes * limits.seconds)};
  std::vector<std::byte> bytes;
  const bool in_time = read_until(ends[0], deadline, bytes);
  ::close(ends[0]);
  if (!in_time) ::kill(child, SIGKILL);
  int status{0};
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  const bool too_long = !in_time || signal == SIGXCPU || signal == SIGKILL;
  if (too_long) {
    return fail(Errc::corrupt_data, "reading it took more than " +
                                        std::to_string(static_cast<long long>(std::ceil(limits.seconds))) +
                                        " s and was given up; is the file damaged?");
  }
  if (signal == SIGINT || signal == SIGTERM || signal == SIGHUP) {
    return fail(Errc::cancelled, "reading it was interrupted");
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == kOutOfMemory) {
    return fail(Errc::corrupt_data, "reading it takes more than " + std::to_string(limits.bytes >> 20U) +
                                        " MiB of memory and was given up; is the file damaged?");
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    return fail(Errc::corrupt_data, "its reader crashed; the file is damaged, or of another format than its name says");
  }
  return mesh_of(bytes, path);
}

}  // namespace saccade

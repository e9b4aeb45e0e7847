// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/files/leftovers.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <memory>
#include <random>
#include <vector>

namespace saccade {
namespace {

constexpr std::string_view kEnd{".tmp"};
constexpr int kMostNames{2000};  // read of a folder, so that thousands of files are not listed at each write

/// Removes the digits at the end of the text, and returns them.
std::string_view take_digits(std::string_view& text) {
  const std::size_t begin = text.find_last_not_of("0123456789") + 1;
  const std::string_view digits = text.substr(begin);
  text = text.substr(0, begin);
  return digits;
}

bool take(std::string_view& text, char last) {
  if (!text.ends_with(last)) return false;
  text.remove_suffix(1);
  return true;
}

bool is_gone(int process) { return ::kill(process, 0) != 0 && errno == ESRCH; }

}  // namespace

bool is_written_to(const std::filesystem::path& temporary) {
  const int fd = ::open(temporary.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (fd < 0) return true;
  const bool locked = ::flock(fd, LOCK_EX | LOCK_NB) != 0;
  ::close(fd);
  return locked;
}

std::string make_temporary_name(std::string_view destination) {
  static std::atomic<unsigned> counter{std::random_device{}()};  // containers have the same process numbers
  std::string name{'.'};
  name += destination;
  name += '.' + std::to_string(::getpid()) + '-' + std::to_string(counter.fetch_add(1));
  return name += kEnd;
}

std::optional<TemporaryName> parse_temporary_name(std::string_view name) {
  if (!name.starts_with('.') || !name.ends_with(kEnd)) return std::nullopt;
  name.remove_prefix(1);
  name.remove_suffix(std::min(name.size(), kEnd.size()));
  if (take_digits(name).empty() || !take(name, '-')) return std::nullopt;
  const std::string_view process = take_digits(name);
  if (!take(name, '.') || name.empty()) return std::nullopt;
  TemporaryName parsed{std::string{name}, 0};
  const auto read = std::from_chars(process.data(), process.data() + process.size(), parsed.process);
  if (read.ec != std::errc{} || parsed.process <= 0) return std::nullopt;
  return parsed;
}

void remove_leftovers(const std::filesystem::path& destination) {
  const std::string name = destination.filename().string();
  const std::filesystem::path folder = destination.has_parent_path() ? destination.parent_path() : ".";
  const std::unique_ptr<DIR, int (*)(DIR*)> listing{::opendir(folder.c_str()), ::closedir};
  if (!listing) return;
  std::vector<std::filesystem::path> leftovers;
  int names{0};
  for (const dirent* entry = nullptr; names < kMostNames && (entry = ::readdir(listing.get())) != nullptr; ++names) {
    const std::string_view file{entry->d_name};
    if (!file.starts_with('.') || file.substr(1, name.size()) != name) continue;
    const auto temporary = parse_temporary_name(file);
    if (!temporary || temporary->destination != name || !is_gone(temporary->process)) continue;
    leftovers.push_back(folder / file);
  }
  for (const std::filesystem::path& leftover : leftovers) {
    if (!is_written_to(leftover)) ::unlink(leftover.c_str());
  }
}

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#include "run_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string_view>
#include <utility>
#include <vector>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/files/leftovers.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kProbeBytes{std::size_t{1} << 20U};

bool is_leftover(std::string_view name) { return parse_temporary_name(name).has_value(); }

bool is_free_to_use(const fs::path& path, std::span<const std::string_view> own_files, std::string_view marker) {
  std::error_code ignored;
  if (!marker.empty() && fs::exists(path / marker, ignored)) return true;
  for (const fs::directory_entry& entry : fs::directory_iterator{path, ignored}) {
    const std::string name = entry.path().filename().string();
    if (is_leftover(name)) continue;
    if (std::find(own_files.begin(), own_files.end(), name) == own_files.end()) return false;
  }
  return true;
}

/// Tells whether a document is of a run whose frames no command brings back: result.unrepeatable.
bool is_unrepeatable(const fs::path& document) {
  std::error_code ignored;
  if (document.extension() != ".json" || !fs::is_regular_file(document, ignored)) return false;
  const Result<nlohmann::json> read = read_json(document);
  if (!read.ok() || !read->is_object()) return false;
  const auto result = read->find("result");
  return result != read->end() && result->is_object() && result->value("unrepeatable", nlohmann::json(false)) == true;
}

/// Removes the unfinished files of runs that were killed. No other run writes here: the caller holds the lock. Slices
/// of a campaign write its page without it.
void sweep(const fs::path& path) {
  std::error_code ignored;
  std::vector<fs::path> leftovers;
  for (const fs::directory_entry& entry : fs::directory_iterator{path, ignored}) {
    if (is_leftover(entry.path().filename().string())) leftovers.push_back(entry.path());
  }
  for (const fs::path& leftover : leftovers) {
    if (!is_written_to(leftover)) fs::remove(leftover, ignored);
  }
}

Status probe(const fs::path& path) {
  SACCADE_TRY(AtomicFile file, AtomicFile::create(path / "write-test"));
  Status written = file.write(std::string(kProbeBytes, '\0'));
  if (written) return {};
  Error error = written.error();
  error.context = path.string();
  return error;
}

}  // namespace

Result<RunFolder> RunFolder::open(const fs::path& path, std::span<const std::string_view> own_files,
                                  std::string_view marker, bool force) {
  std::error_code code;
  const bool there = fs::exists(path, code);
  if (there && !fs::is_directory(path, code)) {
    return Error{Errc::invalid_argument, "is a file; the results need a folder", path.string()};
  }
  if (there && !force && !is_free_to_use(path, own_files, marker)) {
    return Error{Errc::invalid_argument,
                 "the folder holds other files; choose another one, or pass --force to write among them",
                 path.string()};
  }
  if (there && !force && is_unrepeatable(path / marker)) {
    return Error{
        Errc::invalid_argument,
        "the folder holds a run of a real camera or robot, which no command brings back; choose another one, or "
        "pass --force to replace it",
        path.string()};
  }
  if (!there && !fs::create_directories(path, code) && code) {
    return Error{Errc::io_failure, "cannot make the folder: " + code.message(), path.string()};
  }
  RunFolder folder{path, !there};
  folder.lock_ = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder.lock_ >= 0 && ::flock(folder.lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    folder.made_ = false;  // it is the other run's
    return Error{Errc::invalid_argument, "another run is writing into this folder; choose another one", path.string()};
  }
  struct stat locked {};
  struct stat named {};
  if (folder.lock_ >= 0 && ::fstat(folder.lock_, &locked) == 0 &&
      (::stat(path.c_str(), &named) != 0 || locked.st_ino != named.st_ino)) {
    folder.made_ = false;
    return open(path, own_files, marker, force);  // a run that made the folder and wrote nothing has removed it
  }
  sweep(path);
  if (Status writable = probe(path); !writable) {
    Error error = writable.error();
    error.context = path.string();
    return error;
  }
  return folder;
}

RunFolder::RunFolder(RunFolder&& other) noexcept
    : path_{std::move(other.path_)}, made_{std::exchange(other.made_, false)}, lock_{std::exchange(other.lock_, -1)} {}

RunFolder::~RunFolder() {
  std::error_code ignored;
  if (made_) fs::remove(path_, ignored);  // only succeeds when it is empty
  if (lock_ >= 0) ::close(lock_);
}

Status RunFolder::remove(std::span<const std::string_view> names) const {
  for (const std::string_view name : names) {
    std::error_code code;
    fs::remove(path_ / name, code);
    if (code) return Error{Errc::io_failure, "cannot be replaced: " + code.message(), (path_ / name).string()};
  }
  return {};
}

}  // namespace saccade::cli

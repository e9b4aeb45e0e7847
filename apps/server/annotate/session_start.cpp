// SPDX-License-Identifier: Apache-2.0
#include "server/annotate/session_start.hpp"

#include <fcntl.h>
#include <stdio.h>

#include <cerrno>
#include <cstring>

namespace saccade::server {
namespace {

namespace fs = std::filesystem;

/// Renames without overwriting. Returns errno, or 0.
int rename_new(const fs::path& from, const fs::path& to) {
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return 0;
  if (errno != EINVAL && errno != ENOSYS) return errno;
  std::error_code code;  // for file systems that lack an exclusive rename
  if (fs::exists(fs::symlink_status(to, code))) return EEXIST;
  return ::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

}  // namespace

Result<AnnotationJournal::Opened> open_journal(const fs::path& path, SessionSubject subject,
                                               std::span<const GraphCheck> checks) {
  std::error_code ignored;
  if (fs::exists(path, ignored)) {
    SACCADE_TRY(const SavedSession saved, read_journal(path));
    subject.graph = saved.subject.graph;
    for (const GraphCheck& check : checks) {
      if (const auto differs = check(subject.graph)) return Error{Errc::invalid_argument, *differs, path.string()};
    }
  }
  return AnnotationJournal::open_or_create(path, subject);
}

std::optional<std::size_t> planted_before(const LabelSeeds& seeds, std::uint64_t client,
                                          std::span<const AnnotationAction> actions) {
  if (actions.size() >= seeds.actions.size()) return std::nullopt;
  for (std::size_t i = 0; i < actions.size(); ++i) {
    if (!(actions[i] == AnnotationAction{client, seeds.actions[i]})) return std::nullopt;
  }
  return actions.size();
}

std::vector<NumberedLabel> missing_presets(std::span<const NumberedLabel> presets, const Annotation& annotation) {
  std::vector<NumberedLabel> missing;
  const auto& defined = annotation.label_table().defined();
  for (const NumberedLabel& label : presets) {
    const auto known = defined.find(label.number);
    if (known == defined.end() || !(known->second == label.info)) missing.push_back(label);
  }
  return missing;
}

Result<fs::path> keep_aside(const fs::path& file) {
  constexpr int kMost{10'000};
  int code{EEXIST};
  for (int n = 1; n <= kMost && code == EEXIST; ++n) {
    const fs::path kept{file.string() + "." + std::to_string(n)};
    code = rename_new(file, kept);
    if (code == 0) return kept;
  }
  return Error{Errc::io_failure, std::string{"cannot be given another name: "} + std::strerror(code), file.string()};
}

}  // namespace saccade::server

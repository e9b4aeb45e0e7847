// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/frames/internal/layout_files.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include "saccade/io/files/text_scan.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Matches a name with a pattern of one folder; '#' takes at least one character, as many as possible.
bool matches(std::string_view pattern, std::string_view name, std::string& key) {
  if (pattern.empty()) return name.empty();
  const char first = pattern.front();
  if (first != '*' && first != '#') {
    return !name.empty() && name.front() == first && matches(pattern.substr(1), name.substr(1), key);
  }
  const std::size_t least = first == '#' ? 1 : 0;
  for (std::size_t taken = name.size() + 1; taken-- > least;) {
    if (!matches(pattern.substr(1), name.substr(taken), key)) continue;
    if (first == '#') key = name.substr(0, taken);
    return true;
  }
  return false;
}

/// Returns the place of the extension among those of a kind; nullopt for others.
std::optional<std::size_t> rank_of(const fs::path& path, FileKind kind) {
  constexpr std::array<std::string_view, 6> kDepth{".png", ".pgm", ".tif", ".tiff", ".npy", ".exr"};
  constexpr std::array<std::string_view, 7> kColor{".png", ".jpg", ".jpeg", ".ppm", ".pgm", ".tif", ".tiff"};
  if (kind == FileKind::any) return 0;
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto rank = [&](const auto& known) -> std::optional<std::size_t> {
    const auto found = std::find(known.begin(), known.end(), extension);
    return found == known.end() ? std::nullopt : std::optional{static_cast<std::size_t>(found - known.begin())};
  };
  return kind == FileKind::depth ? rank(kDepth) : rank(kColor);
}

/// Compares two runs of digits at the fronts by their value, and removes them; 0 where they are equal.
int compare_runs(std::string_view& a, std::string_view& b) {
  const auto take = [](std::string_view& text) {
    const std::size_t end = std::min(text.find_first_not_of("0123456789"), text.size());
    std::string_view run = text.substr(0, end);
    text.remove_prefix(end);
    run.remove_prefix(std::min(run.find_first_not_of('0'), run.size()));
    return run;
  };
  const std::string_view run_a = take(a);
  const std::string_view run_b = take(b);
  if (run_a.size() != run_b.size()) return run_a.size() < run_b.size() ? -1 : 1;
  return run_a.compare(run_b);
}

void search(const fs::path& folder, std::string_view pattern, FileKind kind, std::vector<KeyedFile>& found) {
  const std::size_t slash = pattern.find('/');
  const std::string_view name = pattern.substr(0, slash);
  const bool is_last = slash == std::string_view::npos;
  std::error_code code;
  if (!is_last && name.find_first_of("*#") == std::string_view::npos) {
    if (fs::is_directory(folder / name, code)) search(folder / name, pattern.substr(slash + 1), kind, found);
    return;
  }
  if (name.find_first_of("*#") == std::string_view::npos) {
    if (fs::is_regular_file(folder / name, code) && rank_of(name, kind)) found.push_back({{}, folder / name});
    return;
  }
  std::vector<fs::path> folders;
  for (fs::directory_iterator it{folder, code}; !code && it != fs::directory_iterator{}; it.increment(code)) {
    std::string key;
    std::error_code ignored;
    const std::string candidate = it->path().filename().string();
    const bool is_hidden = candidate.front() == '.';  // what other systems leave behind
    if (is_hidden || !matches(name, candidate, key)) continue;
    if (!is_last) {
      if (it->is_directory(ignored)) folders.push_back(it->path());
    } else if (it->is_regular_file(ignored) && rank_of(it->path(), kind)) {
      found.push_back({std::move(key), it->path()});
    }
  }
  std::sort(folders.begin(), folders.end());
  for (const fs::path& inner : folders) {
    if (found.empty()) search(inner, pattern.substr(slash + 1), kind, found);
  }
}

}  // namespace

bool comes_before(std::string_view a, std::string_view b) {
  const bool has_points = a.find('.') != std::string_view::npos || b.find('.') != std::string_view::npos;
  if (has_points) {
    const auto number_a = parse_number(a);
    const auto number_b = parse_number(b);
    if (number_a && number_b && *number_a != *number_b) return *number_a < *number_b;
  }
  const std::string_view whole_a = a;
  const std::string_view whole_b = b;
  while (!a.empty() && !b.empty()) {
    if (is_digit(a.front()) && is_digit(b.front())) {
      const int order = compare_runs(a, b);
      if (order != 0) return order < 0;
    } else if (a.front() != b.front()) {
      return static_cast<unsigned char>(a.front()) < static_cast<unsigned char>(b.front());
    } else {
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  if (a.empty() != b.empty()) return a.empty();
  return whole_a < whole_b;
}

std::optional<std::int64_t> number_in(std::string_view key) {
  const std::size_t dash = key.find('-');
  if (dash != std::string_view::npos) {
    const auto number = parse_integer<std::int64_t>(key.substr(0, dash));
    if (number && parse_integer<std::int64_t>(key.substr(dash + 1))) return number;
  }
  constexpr std::string_view kDigits{"0123456789"};
  const std::size_t blank = key.find(' ');
  if (blank != std::string_view::npos && key.substr(0, blank).find_first_of(kDigits) != std::string_view::npos &&
      key.substr(blank).find_first_of(kDigits) != std::string_view::npos) {
    return std::nullopt;  // such as a copy, "000006 (1)"
  }
  const std::size_t last = key.find_last_of(kDigits);
  if (last == std::string_view::npos) return std::nullopt;
  const std::size_t before = key.find_last_not_of("0123456789", last);
  const std::size_t begin = before == std::string_view::npos ? 0 : before + 1;
  return parse_integer<std::int64_t>(key.substr(begin, last + 1 - begin));
}

std::vector<KeyedFile> find_files(const fs::path& folder, std::string_view pattern, FileKind kind) {
  std::vector<KeyedFile> found;
  search(folder, pattern, kind, found);
  std::sort(found.begin(), found.end(), [kind](const KeyedFile& a, const KeyedFile& b) {
    if (a.key != b.key) return comes_before(a.key, b.key);
    const auto rank_a = rank_of(a.path, kind);
    const auto rank_b = rank_of(b.path, kind);
    return rank_a != rank_b ? rank_a < rank_b : a.path < b.path;
  });
  const auto same_key = [](const KeyedFile& a, const KeyedFile& b) { return !a.key.empty() && a.key == b.key; };
  found.erase(std::unique(found.begin(), found.end(), same_key), found.end());
  return found;
}

std::vector<KeyedFile> find_first(const fs::path& folder, std::span<const std::string_view> patterns, FileKind kind) {
  for (const std::string_view pattern : patterns) {
    auto found = find_files(folder, pattern, kind);
    if (!found.empty()) return found;
  }
  return {};
}

FilesByFrame::FilesByFrame(const std::vector<KeyedFile>& files) {
  for (const KeyedFile& file : files) {
    by_key_.emplace(file.key, file.path);
    if (const auto number = number_in(file.key)) by_number_[*number].push_back(file.path);
  }
}

const fs::path* FilesByFrame::find(const std::string& key) const {
  if (const auto exact = by_key_.find(key); exact != by_key_.end()) return &exact->second;
  const auto number = number_in(key);
  const auto found = number ? by_number_.find(*number) : by_number_.end();
  return found != by_number_.end() && found->second.size() == 1 ? &found->second.front() : nullptr;
}

}  // namespace saccade

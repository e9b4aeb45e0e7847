// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/urdf_packages.hpp"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "saccade/core/names.hpp"
#include "saccade/io/files/file_io.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using PathList = std::vector<fs::path>;

constexpr std::uintmax_t kMaxManifestBytes{1U << 20U};
constexpr int kDeepestPackage{6};            ///< folders below a search path
constexpr std::size_t kMostFolders{20'000};  ///< that are looked into for one package
constexpr std::size_t kMostPathsInMessage{6};

/// Returns the name that a package.xml states; empty without one.
std::string name_in_manifest(const fs::path& folder) {
  const fs::path manifest = folder / "package.xml";
  std::error_code ignored;
  if (!fs::is_regular_file(manifest, ignored)) return {};
  const auto text = read_text_file(manifest, kMaxManifestBytes);
  if (!text) return {};
  constexpr std::string_view kOpen{"<name>"};
  const std::size_t open = text->find(kOpen);
  const std::size_t close = open == std::string::npos ? open : text->find("</name>", open);
  if (close == std::string::npos) return {};
  const std::string_view name = std::string_view{*text}.substr(open + kOpen.size(), close - open - kOpen.size());
  const std::size_t first = name.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return std::string{name.substr(first, name.find_last_not_of(" \t\r\n") + 1 - first)};
}

bool is_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

bool is_package(const fs::path& folder, const std::string& name) {
  return is_folder(folder) && (folder.filename() == name || name_in_manifest(folder) == name);
}

/// Lists the folders in a folder by name, hidden ones left out.
PathList subfolders(const fs::path& folder) {
  PathList found;
  std::error_code stop;
  for (fs::directory_iterator entry{folder, stop}; !stop && entry != fs::directory_iterator{}; entry.increment(stop)) {
    if (!entry->path().filename().string().starts_with('.') && is_folder(entry->path())) found.push_back(entry->path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// Finds a package at or below a search path, the uppermost first. Like ROS, looks into no package for others.
PathList find_below(const fs::path& top, const std::string& package) {
  PathList found;
  if (is_package(top / package, package)) found.push_back(top / package);
  PathList level{top};
  std::size_t visited{0};
  for (int depth = 0; depth <= kDeepestPackage && found.empty() && !level.empty(); ++depth) {
    PathList next;
    for (const fs::path& folder : level) {
      if (++visited > kMostFolders) return found;
      if (is_package(folder, package)) {
        found.push_back(folder);
      } else if (!is_file(folder / "package.xml")) {
        const PathList below = subfolders(folder);
        next.insert(next.end(), below.begin(), below.end());
      }
    }
    level = std::move(next);
  }
  return found;
}

std::string environment(const char* name) {
  const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): nothing here changes it
  return value == nullptr ? "" : value;
}

const fs::path* first_with(const PathList& folders, const fs::path& inside) {
  const auto found = std::find_if(folders.begin(), folders.end(),
                                  [&inside](const fs::path& folder) { return is_file(folder / inside); });
  return found == folders.end() ? nullptr : &*found;
}

std::string in_words(const PathList& folders) {
  const PathList shown(folders.begin(),
                       folders.begin() + static_cast<std::ptrdiff_t>(std::min(folders.size(), kMostPathsInMessage)));
  return joined(shown, ", ", [](const fs::path& path) { return path.string(); }) +
         (shown.size() < folders.size() ? ", …" : "");
}

}  // namespace

std::vector<fs::path> split_paths(const std::string& list) {
  PathList paths;
  std::istringstream parts{list};
  for (std::string part; std::getline(parts, part, ':');) {
    if (!part.empty()) paths.emplace_back(part);
  }
  return paths;
}

std::vector<fs::path> package_search_paths(const UrdfConfig& config) {
  PathList paths;
  const auto add = [&paths](const fs::path& path) {
    if (std::find(paths.begin(), paths.end(), path) == paths.end()) paths.push_back(path);
  };
  for (const fs::path& path : config.package_paths) add(path);
  for (const fs::path& path : split_paths(environment("ROS_PACKAGE_PATH"))) add(path);
  for (const fs::path& path : split_paths(environment("AMENT_PREFIX_PATH"))) add(path / "share");
  return paths;
}

UrdfPackages::UrdfPackages(const fs::path& folder, const UrdfConfig& config)
    : folder_{folder}, config_{config}, paths_{package_search_paths(config)} {}

const UrdfPackages::Folders& UrdfPackages::around(const std::string& package) {
  const auto [known, is_new] = around_.try_emplace(package);
  if (!is_new) return known->second;
  fs::path above = fs::absolute(folder_.empty() ? "." : folder_).lexically_normal();
  for (; above.has_relative_path(); above = above.parent_path()) {
    for (const fs::path& candidate : {above, above / package}) {
      if (is_package(candidate, package)) known->second.push_back(candidate);
    }
  }
  return known->second;
}

const UrdfPackages::Folders& UrdfPackages::on_paths(const std::string& package) {
  const auto [known, is_new] = on_paths_.try_emplace(package);
  if (!is_new) return known->second;
  for (const fs::path& path : paths_) {
    const Folders found = find_below(path, package);
    known->second.insert(known->second.end(), found.begin(), found.end());
  }
  return known->second;
}

Error UrdfPackages::missing(const std::string& package, const std::string& uri) {
  Folders found = around(package);
  found.insert(found.end(), on_paths(package).begin(), on_paths(package).end());
  const std::string where = fs::absolute(folder_.empty() ? "." : folder_).lexically_normal().string();
  const std::string why = found.empty() ? "there is no package " + package + " in " + where + " and above it" +
                                              (paths_.empty() ? "; --package-path and ROS_PACKAGE_PATH name no folder"
                                                              : ", nor below " + in_words(paths_)) +
                                              "; give --package " + package +
                                              "=FOLDER, or --package-path with the folder that holds it"
                                        : "its package has no such file: " + in_words(found) +
                                              "; if another one is meant, give --package " + package + "=FOLDER";
  return {Errc::not_found, why, "mesh " + uri};
}

Result<fs::path> UrdfPackages::file(const std::string& uri) {
  constexpr std::string_view kPackage{"package://"};
  constexpr std::string_view kFile{"file://"};
  const auto not_there = [&uri](const std::string& why) { return Error{Errc::not_found, why, "mesh " + uri}; };
  if (!uri.starts_with(kPackage)) {
    if (!uri.starts_with(kFile) && uri.find("://") != std::string::npos)
      return Error{Errc::unsupported, "only package:// and file:// are read", "mesh " + uri};
    const fs::path path = uri.starts_with(kFile) ? fs::path{uri.substr(kFile.size())} : folder_ / uri;
    if (!is_file(path)) return not_there("there is no such file" + (uri == path.string() ? "" : ": " + path.string()));
    return path;
  }
  const std::string rest = uri.substr(kPackage.size());
  const std::size_t slash = rest.find('/');
  if (slash == std::string::npos || slash == 0) return not_there("names no file in a package");
  const std::string package = rest.substr(0, slash);
  const fs::path inside = rest.substr(slash + 1);
  if (const auto given = config_.packages.find(package); given != config_.packages.end()) {
    if (is_file(given->second / inside)) return given->second / inside;
    return not_there("is not in " + given->second.string() + ", the folder given for the package " + package);
  }
  if (const fs::path* folder = first_with(around(package), inside)) return *folder / inside;
  if (const fs::path* folder = first_with(on_paths(package), inside)) return *folder / inside;
  return missing(package, uri);
}

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <map>

#include "annotate.hpp"
#include "annotate_sequence.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSessionSuffix{".sacann"};

bool is_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

bool is_same(const fs::path& a, const fs::path& b) {
  std::error_code ignored;
  return fs::equivalent(a, b, ignored);
}

fs::path named_after(const fs::path& folder, const fs::path& cloud, const std::string& suffix) {
  return folder / (cloud.stem().string() + suffix);
}

/// The file of labels in a folder that has a cloud's name; the cloud itself where it lies there and has none beside it.
Result<fs::path> truth_of(const fs::path& folder, const fs::path& cloud) {
  std::vector<fs::path> found;
  for (const char* suffix : {".label", ".npy", ".pcd", ".ply", ".txt", ".csv", ".xyz"}) {
    const fs::path file = named_after(folder, cloud, suffix);
    std::error_code ignored;
    if (fs::is_regular_file(file, ignored) && !is_same(file, cloud)) found.push_back(file);
  }
  if (found.size() == 1) return found.front();
  if (found.size() > 1) {
    return Error{Errc::invalid_argument,
                 "both " + found[0].filename().string() + " and " + found[1].filename().string() +
                     " could be its labels; move one of them elsewhere",
                 cloud.string()};
  }
  if (is_same(cloud.parent_path().empty() ? "." : cloud.parent_path(), folder)) return cloud;
  return Error{Errc::not_found, "there are no labels of " + cloud.filename().string() + " in it", folder.string()};
}

Status check_stems(const std::vector<fs::path>& clouds) {
  std::map<std::string, fs::path> stems;
  for (const fs::path& cloud : clouds) {
    const auto [other, is_new] = stems.emplace(cloud.stem().string(), cloud);
    if (is_new) continue;
    return Error{Errc::invalid_argument,
                 "would share its files with " + other->second.filename().string() + "; rename one of the two",
                 cloud.string()};
  }
  return {};
}

/// Returns several clouds in their order.
Result<std::vector<fs::path>> clouds_of(const AnnotateOptions& options) {
  if (!options.of_folder()) return in_number_order(options.clouds, false);
  SACCADE_TRY(std::vector<fs::path> clouds, list_clouds(options.cloud));
  std::erase_if(clouds, [&](const fs::path& file) { return is_same(file, options.poses); });
  return options.is_sequence() ? in_number_order(std::move(clouds), true) : std::move(clouds);
}

Status make_folder(const fs::path& folder) {
  if (folder.empty()) return {};
  std::error_code code;
  fs::create_directories(folder, code);
  if (!code && is_folder(folder)) return {};
  return Error{Errc::io_failure, "cannot make the folder: " + (code ? code.message() : "a file has its name"),
               folder.string()};
}

}  // namespace

std::filesystem::path labels_beside(const fs::path& folder, const fs::path& cloud) {
  std::string suffix = cloud.extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (suffix == ".bin") return named_after(folder, cloud, ".label");
  return named_after(folder, cloud, suffix == ".pts" ? ".txt" : suffix);
}

Result<JobList> plan_jobs(const AnnotateOptions& options) {
  const LabelFiles files{options.out, options.names, options.picture, options.margins, options.boxes};
  if (!options.of_several()) {
    CloudJob job{options.cloud, options.truth, options.session, options.seeds, options.segments, files};
    if (is_folder(options.session)) job.session = named_after(options.session, options.cloud, kSessionSuffix);
    return JobList{{std::move(job)}, {}};
  }
  JobList list;
  SACCADE_TRY(const std::vector<fs::path> clouds, clouds_of(options));
  SACCADE_CHECK(check_stems(clouds));
  std::vector<Pose> poses(clouds.size(), Pose::Identity());
  if (!options.poses.empty()) {
    SACCADE_TRY(poses, read_cloud_poses(options.poses, clouds, list.notes));
  }
  if (options.begins_sessions()) SACCADE_CHECK(make_folder(options.session));
  for (const fs::path& folder : {options.truth, options.session, options.seeds, options.segments}) {
    if (folder.empty() || is_folder(folder)) continue;
    return Error{Errc::not_found, "is not a folder, as it must be for several clouds", folder.string()};
  }
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    const fs::path& cloud = clouds[i];
    CloudJob job{cloud, {}, {}, {}, {}, {}, poses[i]};
    if (!options.truth.empty()) {
      SACCADE_TRY(job.truth, truth_of(options.truth, cloud));
    }
    if (!options.seeds.empty()) {
      SACCADE_TRY(job.seeds, truth_of(options.seeds, cloud));
    }
    if (!options.segments.empty()) {
      SACCADE_TRY(job.segments, truth_of(options.segments, cloud));
    }
    if (!options.session.empty()) job.session = named_after(options.session, cloud, kSessionSuffix);
    if (!files.out.empty()) job.files.out = labels_beside(files.out, cloud);
    if (!files.picture.empty()) job.files.picture = named_after(files.picture, cloud, ".png");
    if (!files.boxes.empty()) {
      job.files.boxes = named_after(files.boxes, cloud, options.boxes_as == BoxFormat::json ? ".json" : ".txt");
    }
    list.jobs.push_back(std::move(job));
  }
  for (const fs::path& folder : {files.out, files.picture, files.boxes}) SACCADE_CHECK(make_folder(folder));
  return list;
}

}  // namespace saccade::cli

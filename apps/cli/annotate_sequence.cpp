// SPDX-License-Identifier: Apache-2.0
#include "annotate_sequence.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "saccade/io/frames/trajectory_io.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Returns the text with each number in it replaced by one 0.
std::string without_numbers(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (!is_digit(c)) {
      out += c;
    } else if (out.empty() || out.back() != '0') {
      out += '0';
    }
  }
  return out;
}

std::string digits_at(const std::string& text, std::size_t at) {
  std::size_t end = at;
  while (end < text.size() && is_digit(text[end])) ++end;
  while (at + 1 < end && text[at] == '0') ++at;
  return text.substr(at, end - at);
}

/// Numbers count by their value, of any length.
bool is_before(const std::string& a, const std::string& b) {
  std::size_t i{0};
  std::size_t j{0};
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::string m = digits_at(a, i);
      const std::string n = digits_at(b, j);
      if (m.size() != n.size()) return m.size() < n.size();
      if (m != n) return m < n;
      while (i < a.size() && is_digit(a[i])) ++i;
      while (j < b.size() && is_digit(b[j])) ++j;
    } else {
      if (a[i] != b[j]) return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[j]);
      ++i;
      ++j;
    }
  }
  if ((i < a.size()) != (j < b.size())) return i == a.size();
  return a < b;  // names that differ in leading zeros
}

/// Returns the number that is a cloud's name, without its suffix.
std::optional<std::size_t> number_in_name(const fs::path& cloud) {
  const std::string name = cloud.stem().string();
  std::size_t number{0};
  const auto [end, code] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (name.empty() || code != std::errc{} || end != name.data() + name.size()) return std::nullopt;
  return number;
}

std::string counted_of(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

}  // namespace

std::vector<fs::path> in_number_order(std::vector<fs::path> clouds, bool all) {
  const auto name = [](const fs::path& cloud) { return cloud.filename().string(); };
  const bool are_numbered = std::all_of(clouds.begin(), clouds.end(), [&](const fs::path& cloud) {
    return without_numbers(name(cloud)) == without_numbers(name(clouds.front()));
  });
  if (!all && !are_numbered) return clouds;
  std::stable_sort(clouds.begin(), clouds.end(),
                   [&](const fs::path& a, const fs::path& b) { return is_before(name(a), name(b)); });
  return clouds;
}

Result<std::vector<Pose>> read_cloud_poses(const fs::path& file, std::span<const fs::path> clouds,
                                           std::vector<std::string>& notes) {
  SACCADE_TRY(const std::vector<Pose> poses, read_poses(file));
  if (poses.size() == clouds.size()) return poses;
  std::vector<Pose> of_clouds;
  for (const fs::path& cloud : clouds) {
    const std::optional<std::size_t> number = number_in_name(cloud);
    if (poses.size() < clouds.size() || !number || *number >= poses.size()) break;
    of_clouds.push_back(poses[*number]);
  }
  if (of_clouds.size() == clouds.size()) {
    notes.push_back(file.string() + " has " + std::to_string(poses.size()) + " poses for " +
                    std::to_string(clouds.size()) + " clouds: each takes the one of its number, from 0 (" +
                    clouds.front().filename().string() + ": pose " + std::to_string(*number_in_name(clouds.front())) +
                    ")");
    return of_clouds;
  }
  return Error{Errc::invalid_argument,
               "has " + counted_of(poses.size(), "pose") + " for " + counted_of(clouds.size(), "cloud") +
                   "; give one per cloud, or name the clouds by the numbers of their poses, from 0 (000007.bin)",
               file.string()};
}

Result<std::vector<std::vector<ScriptedAction>>> lines_of_clouds(std::vector<ScriptedAction> script,
                                                                 std::span<const CloudJob> jobs, const fs::path& file) {
  std::vector<std::vector<ScriptedAction>> lines(jobs.size());
  std::size_t present{0};
  for (ScriptedAction& scripted : script) {
    const auto bad = [&](const std::string& what) {
      return in_file(Error{Errc::invalid_argument, what, "line " + std::to_string(scripted.line)}, file);
    };
    if (!scripted.cloud.empty()) {
      const auto found = std::find_if(jobs.begin(), jobs.end(), [&](const CloudJob& job) {
        return job.cloud.filename().string() == scripted.cloud;
      });
      if (found == jobs.end()) {
        return bad("there is no cloud " + scripted.cloud + " here; the first is " +
                   jobs.front().cloud.filename().string());
      }
      const auto place = static_cast<std::size_t>(found - jobs.begin());
      if (place < present) {
        return bad("goes back to " + scripted.cloud + "; a script takes the clouds in their order");
      }
      present = place;
    }
    lines[present].push_back(std::move(scripted));
  }
  return lines;
}

DoneClouds::DoneClouds(std::span<const CloudJob> jobs) {
  std::vector<fs::path> sessions;
  for (const CloudJob& job : jobs) sessions.push_back(job.session);
  labels_ = server::SequenceLabels::of_sessions(sessions);
}

void DoneClouds::add(const CloudJob& job, const LoadedCloud& cloud, const AnnotatedCloud& made) {
  any_ = true;
  T_world_last_ = job.T_world_cloud;
  offset_m_ = cloud.points.offset_m;
  positions_m_ = cloud.points.positions_m;
  last_labels_ = made.labels.labels;
  labels_.take(made.defined);
}

std::optional<CarrySource> DoneClouds::source_for(const CloudJob& job, const LoadedCloud& cloud) const {
  if (!any_) return std::nullopt;
  return CarrySource{positions_m_, last_labels_,
                     server::place_in(job.T_world_cloud, cloud.points.offset_m, T_world_last_, offset_m_)};
}

}  // namespace saccade::cli

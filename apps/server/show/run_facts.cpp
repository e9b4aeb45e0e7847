// SPDX-License-Identifier: Apache-2.0
#include "server/show/run_facts.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/io/runs/run_json.hpp"
#include "server/show/figures.hpp"

namespace saccade::server {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::optional<double> number(const json& object, const char* key) {
  if (!object.is_object()) return std::nullopt;
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) return std::nullopt;
  const double value = found->get<double>();
  return std::isfinite(value) ? std::optional{value} : std::nullopt;
}

std::optional<std::string> text(const json& object, const char* key) {
  if (!object.is_object()) return std::nullopt;
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? std::optional{found->get<std::string>()} : std::nullopt;
}

std::string voxels(std::size_t count) { return grouped(count) + " voxels"; }
std::string gain_words(double gain) {
  return gain >= 0.0 && gain == std::floor(gain) ? grouped(static_cast<std::size_t>(gain)) : decimals(gain, 2);
}

void add_refused(Facts& facts, const char* name, const RefusalCounts& refused) {
  if (refused.total() > 0) facts.emplace_back(name, in_words(refused));
}
void add_map(Facts& facts, const Measures& measures) {
  if (measures.coverage) facts.emplace_back("coverage", percent(*measures.coverage));
  facts.emplace_back("unknown left", voxels(measures.unknown_left));
}

void add_if_there(std::vector<StepPicture>& pictures, const fs::path& folder, const std::string& name,
                  const char* title) {
  std::error_code ignored;
  if (fs::is_regular_file(folder / name, ignored)) pictures.push_back({name, title, folder / name});
}

}  // namespace

Facts facts_of_run(const json& result) {
  Facts facts;
  const auto add_text = [&](const char* key) {
    if (const auto value = text(result, key)) facts.emplace_back(key, *value);
  };
  const auto add_number = [&](const json& object, const char* key, const char* name, const auto& words) {
    if (const auto value = number(object, key)) facts.emplace_back(name, words(*value));
  };
  const auto whole = [](double count) { return grouped(static_cast<std::size_t>(std::clamp(count, 0.0, 1e15))); };
  const auto whole_voxels = [&](double count) { return whole(count) + " voxels"; };
  for (const char* key : {"scene", "strategy", "robot"}) add_text(key);
  const json initial = result.value("initial", json());
  const json final = result.value("final", json());
  if (const json views = result.value("views", json()); views.is_array()) {
    facts.emplace_back("views", std::to_string(views.size()));
  }
  const auto before = number(initial, "coverage");
  const auto after = number(final, "coverage");
  if (after) facts.emplace_back("coverage", (before ? percent(*before) + " → " : "") + percent(*after));
  add_number(final, "unknown_left", "unknown left", whole_voxels);
  add_number(final, "accuracy_m", "accuracy", millimetres);
  add_number(final, "chamfer_m", "Chamfer distance", millimetres);
  add_number(final, "f_score", "F-score at 5 mm", [](double score) { return decimals(score, 3); });
  add_number(result, "voxel_size_m", "voxel size", millimetres);
  add_number(result, "frames", "frames", whole);
  add_text("tracking");
  if (auto why = text(result, "stopped_because")) {
    std::replace(why->begin(), why->end(), '_', ' ');
    facts.emplace_back("stopped", *why);
  }
  add_number(result, "unknown_after_task", "unknown after the task", whole_voxels);
  return facts;
}

Facts facts_of_scan(const ScanRecord& scan) {
  Facts facts{{"poses", std::to_string(scan.views)}};
  add_map(facts, scan.measures);
  add_refused(facts, "passed over", scan.refused);
  return facts;
}

Facts facts_of_view(const ViewRecord& view) {
  Facts facts;
  if (std::isfinite(view.gain_predicted)) facts.emplace_back("gain", gain_words(view.gain_predicted));
  if (std::isfinite(view.gain_observed)) facts.emplace_back("of it observed", gain_words(view.gain_observed));
  facts.emplace_back("candidates", grouped(view.candidates));
  facts.emplace_back("evaluated", grouped(view.evaluated));
  add_refused(facts, "refused", view.refused);
  add_map(facts, view.measures);
  if (view.attention) {
    facts.emplace_back("saliency", decimals(view.attention->saliency, 2));
    facts.emplace_back("attention", view.attention->why);
  }
  facts.emplace_back("frames", std::to_string(view.frames));
  facts.emplace_back("motion", decimals(view.motion_s, 1) + " s");
  facts.emplace_back("camera's way", decimals(view.path_m, 2) + " m");
  const double computing_ms = view.times.total_ms() - view.times.ms(Phase::motion);
  facts.emplace_back("computing", grouped(static_cast<std::size_t>(std::llround(computing_ms))) + " ms");
  return facts;
}

std::vector<StepPicture> pictures_of_view(const fs::path& folder, std::size_t view) {
  std::vector<StepPicture> pictures;
  add_if_there(pictures, folder, view_file(view, "-seen.png"), "What the camera saw");
  add_if_there(pictures, folder, view_file(view, "-choice.png"), "The choice among the candidates");
  add_if_there(pictures, folder, view_file(view, "-saliency.png"), "What drew the attention");
  add_if_there(pictures, folder, view_file(view, "-map.png"), "The map, unknown in grey");
  return pictures;
}

std::vector<StepPicture> pictures_in(const fs::path& folder) {
  std::vector<StepPicture> pictures;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator{folder, ignored}) {
    if (entry.path().extension() != ".png" || !entry.is_regular_file(ignored)) continue;
    pictures.push_back({entry.path().filename().string(), entry.path().stem().string(), entry.path()});
  }
  std::sort(pictures.begin(), pictures.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return pictures;
}

}  // namespace saccade::server

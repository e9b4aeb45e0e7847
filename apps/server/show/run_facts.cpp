// SPDX-License-Identifier: Apache-2.0
#include "server/show/run_facts.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "saccade/io/runs/view_choice.hpp"
#include "saccade/robot/refusal.hpp"
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

json part(const json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? json(nullptr) : *found;
}

/// Adds facts of numbers and texts where there are any.
class FactList {
 public:
  explicit FactList(const json& from) : from_{from} {}
  void text_of(const char* key, const char* name) {
    if (const auto value = text(from_, key)) facts_.emplace_back(name, *value);
  }
  template <class Words>
  void number_of(const char* key, const char* name, const Words& words) {
    number_in(from_, key, name, words);
  }
  template <class Words>
  void number_in(const json& part, const char* key, const char* name, const Words& words) {
    if (const auto value = number(part, key)) facts_.emplace_back(name, words(*value));
  }
  void add(const char* name, std::string words) { facts_.emplace_back(name, std::move(words)); }
  [[nodiscard]] Facts take() { return std::move(facts_); }

 private:
  const json& from_;
  Facts facts_;
};

std::string whole(double count) {
  constexpr double kMost{1e15};
  return grouped(static_cast<std::size_t>(std::clamp(count, 0.0, kMost)));
}
std::string voxels(double count) { return whole(count) + " voxels"; }
std::string gain_words(double gain) { return gain == std::floor(gain) ? whole(gain) : decimals(gain, 2); }

std::string why_refused(const std::string& reason) {
  const auto refusal = kRefusalNames.find(reason);
  return refusal ? std::string{kRefusalTexts.of(*refusal)} : reason;
}

std::string refused_words(const json& refused) {
  std::string words;
  if (!refused.is_object()) return words;
  for (const auto& [reason, count] : refused.items()) {
    if (!count.is_number()) continue;
    words += (words.empty() ? "" : ", ") + whole(count.get<double>()) + " " + why_refused(reason);
  }
  return words;
}

/// Sum of the phases that the program itself spent.
std::optional<double> thinking_ms(const json& view) {
  const json ms = part(view, "ms");
  if (!ms.is_object()) return std::nullopt;
  double sum{0.0};
  for (const auto& [phase, spent] : ms.items())
    sum += spent.is_number() && phase != "motion" ? spent.get<double>() : 0.0;
  return sum;
}

void add_if_there(std::vector<StepPicture>& pictures, const fs::path& folder, const std::string& name,
                  const char* title) {
  std::error_code ignored;
  if (fs::is_regular_file(folder / name, ignored)) pictures.push_back({name, title, folder / name});
}

}  // namespace

Facts facts_of_run(const json& result) {
  FactList facts{result};
  facts.text_of("scene", "scene");
  facts.text_of("strategy", "strategy");
  facts.text_of("robot", "robot");
  if (const json views = part(result, "views"); views.is_array()) facts.add("views", std::to_string(views.size()));
  const json final = part(result, "final");
  const auto before = number(part(result, "initial"), "coverage");
  const auto after = number(final, "coverage");
  if (after) facts.add("coverage", (before ? percent(*before) + " → " : "") + percent(*after));
  facts.number_in(final, "unknown_left", "unknown left", voxels);
  facts.number_in(final, "accuracy_m", "accuracy", millimetres);
  facts.number_in(final, "chamfer_m", "Chamfer distance", millimetres);
  facts.number_in(final, "f_score", "F-score at 5 mm", [](double score) { return decimals(score, 3); });
  facts.number_of("voxel_size_m", "voxel size", millimetres);
  facts.number_of("frames", "frames", whole);
  facts.text_of("tracking", "tracking");
  if (auto why = text(result, "stopped_because")) {
    std::replace(why->begin(), why->end(), '_', ' ');
    facts.add("stopped", *why);
  }
  facts.number_of("unknown_after_task", "unknown after the task", voxels);
  return facts.take();
}

Facts facts_of_scan(const json& initial) {
  FactList facts{initial};
  facts.number_of("views", "poses", whole);
  facts.number_of("coverage", "coverage", percent);
  facts.number_of("unknown_left", "unknown left", voxels);
  if (const std::string refused = refused_words(part(initial, "refused")); !refused.empty()) {
    facts.add("passed over", refused);
  }
  return facts.take();
}

Facts facts_of_view(const json& view) {
  FactList facts{view};
  facts.number_of("gain", "gain", gain_words);
  facts.number_of("candidates", "candidates", whole);
  facts.number_of("evaluated", "evaluated", whole);
  if (const std::string refused = refused_words(part(view, "refused")); !refused.empty()) {
    facts.add("refused", refused);
  }
  facts.number_of("coverage", "coverage", percent);
  facts.number_of("unknown_left", "unknown left", voxels);
  const json attention = part(view, "attention");
  facts.number_in(attention, "saliency", "saliency", [](double saliency) { return decimals(saliency, 2); });
  if (const auto why = text(attention, "why")) facts.add("attention", *why);
  facts.number_of("frames", "frames", whole);
  facts.number_of("motion_s", "motion", [](double s) { return decimals(s, 1) + " s"; });
  facts.number_of("path_m", "camera's way", [](double m) { return decimals(m, 2) + " m"; });
  if (const auto ms = thinking_ms(view)) facts.add("computing", whole(std::round(*ms)) + " ms");
  return facts.take();
}

std::vector<StepPicture> pictures_of_view(const fs::path& folder, std::size_t view) {
  std::vector<StepPicture> pictures;
  add_if_there(pictures, folder, view_file(view, "-seen.png"), "What the camera saw");
  add_if_there(pictures, folder, view_file(view, "-choice.png"), "The choice among the candidates");
  add_if_there(pictures, folder, view_file(view, "-saliency.png"), "What drew the attention");
  add_if_there(pictures, folder, view_file(view, "-map.png"), "The map, unknown in black");
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

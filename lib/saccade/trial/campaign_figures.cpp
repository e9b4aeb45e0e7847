// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/campaign_summary.hpp"

#include <algorithm>

#include "saccade/core/result.hpp"

namespace saccade {
namespace {

using Run = CampaignEntry;
using Value = std::optional<double>;

constexpr double kPercent{100.0};
constexpr double kMillimetres{1000.0};
constexpr double kSeconds{1e-3};  // from milliseconds

Value number(std::size_t count) { return static_cast<double>(count); }

Value number(const std::optional<std::size_t>& count) { return count ? number(*count) : std::nullopt; }

/// Returns the sum over all views.
template <class Of>
double sum_of(const Run& run, Of of) {
  double sum = 0.0;
  for (const ViewRecord& view : run.run.views) sum += static_cast<double>(of(view));
  return sum;
}

bool reveals_object(const ViewRecord& view) { return view.reveals_object.value_or(false); }

auto first_views_end(const Run& run) {
  return run.run.views.begin() + static_cast<std::ptrdiff_t>(std::min(kFirstViews, run.run.views.size()));
}

std::vector<RunFigure> map_figures() {
  const auto initial = [](auto figure) {
    return [figure](const Run& run, std::size_t) -> Value { return figure(run.run.scan.measures); };
  };
  const auto final = [](auto figure) {
    return [figure](const Run& run, std::size_t) -> Value { return figure(run.run.final()); };
  };
  const auto coverage = [](const Measures& map) -> Value { return map.coverage; };
  const auto unknown = [](const Measures& map) { return number(map.unknown_left); };
  const auto near = [](const Measures& map) { return number(map.unknown_near_objects); };
  const auto accuracy = [](const Measures& map) { return map.accuracy_m; };
  const auto chamfer = [](const Measures& map) { return map.chamfer_m; };
  const auto f_score = [](const Measures& map) { return map.f_score; };
  return {
      {"initial_coverage", "coverage after the scan", "%", kPercent, 1, initial(coverage)},
      {"coverage", "coverage at the end", "%", kPercent, 1, final(coverage)},
      {"coverage_area", "area under coverage over views", "%", kPercent, 1,
       [](const Run& run, std::size_t budget) -> Value { return coverage_area(run, budget); }},
      {"views", "views taken", "", 1.0, 1, [](const Run& run, std::size_t) { return number(run.run.views.size()); }},
      {"views_to_90", "views to 90 % coverage", "", 1.0, 1,
       [](const Run& run, std::size_t) { return number(views_to_coverage(run, 0.9)); }},
      {"views_to_95", "views to 95 % coverage", "", 1.0, 1,
       [](const Run& run, std::size_t) { return number(views_to_coverage(run, 0.95)); }},
      {"initial_unknown_near_objects", "unknown near objects after the scan", "voxels", 1.0, 0, initial(near)},
      {"unknown_near_objects_at_5", "unknown near objects after five views", "voxels", 1.0, 0,
       [](const Run& run, std::size_t) { return number(figures_after(run, kFirstViews).unknown_near_objects); }},
      {"unknown_near_objects", "unknown near objects at the end", "voxels", 1.0, 0, final(near)},
      {"object_views", "object-directed views of the first five", "", 1.0, 1,
       [](const Run& run, std::size_t) { return number(object_views(run)); }},
      {"looking_views", "views of the first five whose axis meets an object", "", 1.0, 1,
       [](const Run& run, std::size_t) {
         return number(static_cast<std::size_t>(
             std::count_if(run.run.views.begin(), first_views_end(run),
                           [](const ViewRecord& view) { return view.looks_at_object.value_or(false); })));
       }},
      {"objects_first", "runs with all object-directed views first", "%", kPercent, 0,
       [](const Run& run, std::size_t) -> Value {
         const auto first = objects_come_first(run);
         return first ? Value{*first ? 1.0 : 0.0} : std::nullopt;
       }},
      {"initial_unknown_left", "unknown left after the scan", "voxels", 1.0, 0, initial(unknown)},
      {"unknown_left", "unknown left at the end", "voxels", 1.0, 0, final(unknown)},
      {"initial_accuracy_m", "accuracy after the scan", "mm", kMillimetres, 2, initial(accuracy)},
      {"accuracy_m", "accuracy at the end", "mm", kMillimetres, 2, final(accuracy)},
      {"initial_chamfer_m", "Chamfer distance after the scan", "mm", kMillimetres, 2, initial(chamfer)},
      {"chamfer_m", "Chamfer distance at the end", "mm", kMillimetres, 2, final(chamfer)},
      {"initial_f_score", "F-score after the scan", "%", kPercent, 1, initial(f_score)},
      {"f_score", "F-score at the end", "%", kPercent, 1, final(f_score)},
  };
}

std::string spaced(std::string_view name) {
  std::string text{name};
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::vector<RunFigure> make_figures() {
  std::vector<RunFigure> figures = map_figures();
  const auto add_sum = [&figures](std::string name, std::string text, std::string_view unit, double scale, int decimals,
                                  auto of) {
    figures.push_back({std::move(name), std::move(text), unit, scale, decimals,
                       [of](const Run& run, std::size_t) -> Value { return sum_of(run, of); }});
  };
  add_sum("path_m", "camera path", "m", 1.0, 2, [](const ViewRecord& view) { return view.path_m; });
  add_sum("motion_s", "arm in motion", "s", 1.0, 1, [](const ViewRecord& view) { return view.motion_s; });
  add_sum("candidates", "candidate views", "", 1.0, 0, [](const ViewRecord& view) { return view.candidates; });
  add_sum("evaluated", "candidates evaluated", "", 1.0, 0, [](const ViewRecord& view) { return view.evaluated; });
  add_sum("refused", "candidates refused", "", 1.0, 0, [](const ViewRecord& view) { return view.refused.total(); });
  for (const Refusal refusal : kRefusalNames.values) {
    add_sum("refused_" + std::string{to_string(refusal)}, "refused, " + spaced(to_string(refusal)), "", 1.0, 0,
            [refusal](const ViewRecord& view) { return view.refused.of(refusal); });
  }
  for (const Phase phase : kPhaseNames.values) {
    add_sum(std::string{to_string(phase)} + "_ms", "time, " + spaced(to_string(phase)), "s", kSeconds, 2,
            [phase](const ViewRecord& view) { return view.times.ms(phase); });
  }
  figures.push_back({"seconds", "time, whole run with measuring", "s", 1.0, 1,
                     [](const Run& run, std::size_t) -> Value { return run.seconds; }});
  return figures;
}

}  // namespace

const Measures& figures_after(const CampaignEntry& run, std::size_t taken) {
  const std::size_t last = std::min(taken, run.run.views.size());
  return last == 0 ? run.run.scan.measures : run.run.views[last - 1].measures;
}

std::optional<std::size_t> views_to_coverage(const CampaignEntry& run, double share) {
  for (std::size_t taken = 0; taken <= run.run.views.size(); ++taken) {
    if (figures_after(run, taken).coverage.value_or(0.0) >= share) return taken;
  }
  return std::nullopt;
}

double coverage_area(const CampaignEntry& run, std::size_t budget) {
  double sum = 0.0;
  for (std::size_t taken = 0; taken <= budget; ++taken) sum += figures_after(run, taken).coverage.value_or(0.0);
  return sum / static_cast<double>(budget + 1);
}

std::size_t object_views(const CampaignEntry& run) {
  return static_cast<std::size_t>(std::count_if(run.run.views.begin(), first_views_end(run), reveals_object));
}

std::optional<bool> objects_come_first(const CampaignEntry& run) {
  if (std::none_of(run.run.views.begin(), first_views_end(run), reveals_object)) return std::nullopt;
  return std::is_partitioned(run.run.views.begin(), first_views_end(run), reveals_object);
}

std::span<const RunFigure> run_figures() {
  static const std::vector<RunFigure> figures = make_figures();
  return figures;
}

std::size_t run_figure_index(std::string_view name) {
  const std::span<const RunFigure> figures = run_figures();
  const auto found =
      std::find_if(figures.begin(), figures.end(), [name](const RunFigure& figure) { return figure.name == name; });
  SACCADE_EXPECTS(found != figures.end());
  return static_cast<std::size_t>(found - figures.begin());
}

}  // namespace saccade

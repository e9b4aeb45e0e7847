// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iomanip>
#include <span>
#include <sstream>

#include "annotate.hpp"
#include "json_output.hpp"
#include "saccade/core/statistics.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

constexpr std::array<int, 3> kGoals_percent{80, 85, 90};
constexpr double kPer{100'000.0};

std::string action_of(const AnnotateOptions& options) {
  return options.method == AnnotationMethod::control_points ? "clicks" : "rectangles";
}

std::string text_of(const AnnotationStep& step, std::size_t points) {
  return "mean IoU " + fixed(step.iou_mean, 3) + ", wrong " + std::to_string(step.errors) + " (" +
         percent(static_cast<double>(step.errors) / static_cast<double>(points)) + ")";
}

double errors_per_100k(const SimulatedAnnotation& annotation, const AnnotationStep& step) {
  return kPer * static_cast<double>(step.errors) / static_cast<double>(annotation.points);
}

/// How well a goal was reached over several clouds.
struct GoalMean {
  double clicks{0.0};
  double clicks_per_label{0.0};
  std::size_t reached{0};
};

GoalMean mean_to(std::span<const CloudProgress<SimulatedAnnotation>> clouds, int goal_percent) {
  GoalMean mean;
  for (const auto& cloud : clouds) {
    const std::optional<std::size_t> needed = cloud.made.clicks_to(0.01 * goal_percent);
    if (!needed) continue;
    ++mean.reached;
    mean.clicks += static_cast<double>(*needed);
    mean.clicks_per_label += static_cast<double>(*needed) / static_cast<double>(cloud.made.objects);
  }
  if (mean.reached == 0) return mean;
  mean.clicks /= static_cast<double>(mean.reached);
  mean.clicks_per_label /= static_cast<double>(mean.reached);
  return mean;
}

struct StepMean {
  double iou_mean{0.0};
  double errors_per_100k{0.0};
};

StepMean mean_after(std::span<const CloudProgress<SimulatedAnnotation>> clouds, std::size_t clicks_per_label) {
  StepMean mean;
  for (const auto& cloud : clouds) {
    const AnnotationStep step = cloud.made.after(clicks_per_label);
    mean.iou_mean += step.iou_mean / static_cast<double>(clouds.size());
    mean.errors_per_100k += errors_per_100k(cloud.made, step) / static_cast<double>(clouds.size());
  }
  return mean;
}

std::string hex_of(const Rgb8& color) {
  std::ostringstream text;
  text << '#' << std::hex << std::setfill('0');
  for (const std::uint8_t part : color) text << std::setw(2) << int{part};
  return text.str();
}

json label_json(const LabelRow& row) {
  json label{{"number", row.label.number},
             {"name", row.label.name},
             {"color", hex_of(row.label.color)},
             {"points", row.label.points},
             {"control_points", row.control_points}};
  if (!row.label.class_name.empty()) label["class"] = row.label.class_name;
  if (row.label.instance != 0) label["instance"] = row.label.instance;
  return label;
}

std::size_t widest_name(const auto& clouds) {
  std::size_t widest{5};
  for (const auto& cloud : clouds) widest = std::max(widest, cloud.file.filename().string().size());
  return widest;
}

}  // namespace

json simulation_json(const AnnotateOptions& options, const SimulatedAnnotation& annotation) {
  json clicks = json::array();
  for (const AnnotationStep& step : annotation.clicks) {
    clicks.push_back({{"label", step.label}, {"iou_mean", step.iou_mean}, {"errors", step.errors}});
  }
  json per_label = json::array();
  for (int n = 1; n <= options.clicks; ++n) {
    const AnnotationStep step = annotation.after(static_cast<std::size_t>(n));
    per_label.push_back({{"clicks", n},
                         {"iou_mean", step.iou_mean},
                         {"errors", step.errors},
                         {"errors_per_100k", errors_per_100k(annotation, step)}});
  }
  json noc = json::object();
  for (const int goal : kGoals_percent) {
    noc[std::to_string(goal)] = optional_json(annotation.clicks_to(0.01 * goal));
  }
  json result{{"method", kAnnotationMethodNames.of(options.method)},
              {"points", annotation.points},
              {"objects", annotation.objects},
              {"clicks", std::move(clicks)},
              {"per_label", std::move(per_label)},
              {"noc", std::move(noc)}};
  if (options.method == AnnotationMethod::control_points) {
    result["ms"] = {{"graph", annotation.graph_ms},
                    {"full", annotation.full_ms},
                    {"add", {{"median", median(annotation.add_ms)}}},
                    {"delete", {{"median", median(annotation.delete_ms)}}}};
  }
  return result;
}

json mean_json(const AnnotateOptions& options, std::span<const CloudProgress<SimulatedAnnotation>> clouds) {
  json per_label = json::array();
  for (int n = 1; n <= options.clicks; ++n) {
    const StepMean mean = mean_after(clouds, static_cast<std::size_t>(n));
    per_label.push_back({{"clicks", n}, {"iou_mean", mean.iou_mean}, {"errors_per_100k", mean.errors_per_100k}});
  }
  json noc = json::object();
  for (const int goal : kGoals_percent) {
    const GoalMean mean = mean_to(clouds, goal);
    noc[std::to_string(goal)] = {{"clicks", mean.reached == 0 ? json(nullptr) : json(mean.clicks)},
                                 {"clicks_per_label", mean.reached == 0 ? json(nullptr) : json(mean.clicks_per_label)},
                                 {"reached", mean.reached},
                                 {"never", clouds.size() - mean.reached}};
  }
  return {{"clouds", clouds.size()}, {"per_label", std::move(per_label)}, {"noc", std::move(noc)}};
}

json annotation_json(const AnnotatedCloud& cloud) {
  json labels = json::array();
  for (const LabelRow& row : cloud.labels.rows) labels.push_back(label_json(row));
  const std::vector<double>& action_ms = cloud.action_ms;
  json result{{"points", cloud.points},
              {"labelled", cloud.labels.labelled()},
              {"control_points", cloud.labels.control_points.size()},
              {"actions", cloud.actions},
              {"labels", std::move(labels)},
              {"ms",
               {{"graph", cloud.graph_ms},
                {"actions",
                 {{"count", action_ms.size()},
                  {"median", median(action_ms)},
                  {"max", action_ms.empty() ? 0.0 : *std::max_element(action_ms.begin(), action_ms.end())}}}}}};
  if (cloud.carried > 0) result["carried"] = cloud.carried;
  if (cloud.next) {
    json& next = result["next_best_click"];
    next = {{"point", cloud.next->point}, {"position_m", point_json(cloud.next_m)}, {"settles", cloud.next->gain}};
    if (cloud.next->label != kNoLabel) next["label"] = cloud.next->label;
  }
  if (cloud.seeds) {
    result["seeds"] = {{"points", cloud.seeds->points},
                       {"reproduced", cloud.seeds->reproduced},
                       {"control_points", cloud.seeds->control_points}};
  }
  return result;
}

json mean_json(std::span<const CloudProgress<AnnotatedCloud>> clouds) {
  double share{0.0};
  std::uint64_t actions{0};
  std::size_t begun{0};
  for (const auto& cloud : clouds) {
    share += cloud.made.labelled_share() / static_cast<double>(clouds.size());
    actions += cloud.made.actions;
    begun += cloud.made.actions > 0 ? 1 : 0;
  }
  return {{"clouds", clouds.size()}, {"begun", begun}, {"labelled_share", share}, {"actions", actions}};
}

std::string simulation_text(const AnnotateOptions& options, const SimulatedAnnotation& annotation) {
  std::ostringstream text;
  const Summary summary{text};
  const std::string action = action_of(options);
  summary.line("points", std::to_string(annotation.points) + " in " + std::to_string(annotation.objects) + " labels");
  for (std::size_t n = annotation.objects; n <= annotation.clicks.size(); n += annotation.objects) {
    summary.line(std::to_string(n) + " " + action, text_of(annotation.clicks[n - 1], annotation.points));
  }
  if (!annotation.clicks.empty() && annotation.clicks.size() % annotation.objects != 0) {
    summary.line(std::to_string(annotation.clicks.size()) + " " + action,
                 text_of(annotation.clicks.back(), annotation.points));
  }
  if (options.method != AnnotationMethod::control_points) return text.str();
  summary.line("graph", fixed(annotation.graph_ms, 1) + " ms");
  summary.line("add, delete",
               fixed(median(annotation.add_ms), 2) + " ms, " + fixed(median(annotation.delete_ms), 2) + " ms (median)");
  return text.str();
}

std::string simulations_text(const AnnotateOptions& options,
                             std::span<const CloudProgress<SimulatedAnnotation>> clouds) {
  std::ostringstream text;
  const auto width = static_cast<int>(widest_name(clouds));
  text << std::left << std::setw(width) << "cloud" << std::right << std::setw(10) << "points" << std::setw(8)
       << "labels"
       << "  mean IoU after 1 to " << options.clicks << ' ' << action_of(options) << " per label\n";
  const auto row = [&](const std::string& name, const std::string& points, const std::string& labels,
                       const auto& iou_after) {
    text << std::left << std::setw(width) << name << std::right << std::setw(10) << points << std::setw(8) << labels;
    for (int n = 1; n <= options.clicks; ++n) text << "  " << fixed(iou_after(static_cast<std::size_t>(n)), 3);
    text << '\n';
  };
  for (const auto& cloud : clouds) {
    row(cloud.file.filename().string(), std::to_string(cloud.made.points), std::to_string(cloud.made.objects),
        [&](std::size_t n) { return cloud.made.after(n).iou_mean; });
  }
  row("mean", "", "", [&](std::size_t n) { return mean_after(clouds, n).iou_mean; });
  const Summary summary{text};
  text << '\n';
  for (const int goal : kGoals_percent) {
    const GoalMean mean = mean_to(clouds, goal);
    const std::size_t never = clouds.size() - mean.reached;
    summary.line("to " + std::to_string(goal) + " %",
                 (mean.reached == 0 ? "-"
                                    : fixed(mean.clicks, 1) + " " + action_of(options) + ", " +
                                          fixed(mean.clicks_per_label, 2) + " per label") +
                     (never == 0 ? "" : "; never in " + std::to_string(never) + " clouds"));
  }
  const StepMean last = mean_after(clouds, static_cast<std::size_t>(options.clicks));
  summary.line("wrong", fixed(last.errors_per_100k, 0) + " of 100000 points at the end");
  return text.str();
}

std::string annotation_text(const AnnotateOptions& options, const AnnotatedCloud& cloud) {
  std::ostringstream text;
  const Summary summary{text};
  const std::size_t labelled = cloud.labels.labelled();
  summary.line("points", std::to_string(cloud.points));
  summary.line("labelled", std::to_string(labelled) + " (" + percent(cloud.labelled_share()) + ")");
  if (cloud.next) {
    const Eigen::Vector3d& p = cloud.next_m;
    summary.line("next click", "point " + std::to_string(cloud.next->point) + " at " +
                                   fixed(static_cast<double>(p.x()), 3) + ", " + fixed(static_cast<double>(p.y()), 3) +
                                   ", " + fixed(static_cast<double>(p.z()), 3) + " m settles about " +
                                   fixed(cloud.next->gain, 0) + " points");
  }
  if (cloud.carried > 0) summary.line("carried", std::to_string(cloud.carried));
  if (cloud.seeds) {
    const double share = static_cast<double>(cloud.seeds->reproduced) / static_cast<double>(cloud.seeds->points);
    summary.line("seeds", std::to_string(cloud.seeds->control_points) + " control points, which give back " +
                              percent(share) + " of " + std::to_string(cloud.seeds->points) + " labels");
  }
  summary.line("actions",
               std::to_string(cloud.actions) +
                   (cloud.action_ms.empty() ? "" : ", " + std::to_string(cloud.action_ms.size()) + " of the script"));
  summary.line("time", "graph " + fixed(cloud.graph_ms, 1) + " ms" +
                           (cloud.action_ms.empty()
                                ? ""
                                : ", actions " + fixed(median(cloud.action_ms), 2) + " ms (median), " +
                                      fixed(*std::max_element(cloud.action_ms.begin(), cloud.action_ms.end()), 2) +
                                      " ms at most"));
  const std::array<std::pair<const char*, const std::filesystem::path*>, 6> files{{{"session", &options.session},
                                                                                   {"labels", &options.out},
                                                                                   {"names", &options.names},
                                                                                   {"picture", &options.picture},
                                                                                   {"margins", &options.margins},
                                                                                   {"boxes", &options.boxes}}};
  for (const auto& [name, file] : files) {
    const bool written = !cloud.interrupted || file == &options.session;
    if (!file->empty() && written) summary.line(name, file->string());
  }
  text << "\n     label    points  control points  name\n";
  constexpr std::size_t kShown{40};
  const std::span<const LabelRow> rows{cloud.labels.rows};
  for (const LabelRow& row : rows.first(std::min(kShown, rows.size()))) {
    text << std::right << std::setw(10) << row.label.number << std::setw(10) << row.label.points << std::setw(16)
         << row.control_points << (row.label.name.empty() ? "" : "  " + row.label.name) << '\n';
  }
  if (rows.size() > kShown) text << "       ... and " << rows.size() - kShown << " more, all in the JSON result\n";
  text << std::right << std::setw(10) << "none" << std::setw(10) << cloud.points - std::min(labelled, cloud.points)
       << '\n';
  return text.str();
}

std::string annotations_text(std::span<const CloudProgress<AnnotatedCloud>> clouds) {
  std::ostringstream text;
  const auto width = static_cast<int>(widest_name(clouds));
  text << std::left << std::setw(width) << "cloud" << std::right << std::setw(10) << "points" << std::setw(10)
       << "labelled" << std::setw(8) << "labels" << std::setw(9) << "actions" << '\n';
  for (const auto& cloud : clouds) {
    const bool begun = cloud.made.actions > 0;
    text << std::left << std::setw(width) << cloud.file.filename().string() << std::right << std::setw(10)
         << cloud.made.points << std::setw(10) << (begun ? percent(cloud.made.labelled_share()) : "-") << std::setw(8)
         << cloud.made.labels.rows.size() << std::setw(9) << cloud.made.actions << '\n';
  }
  return text.str();
}

}  // namespace saccade::cli

// SPDX-License-Identifier: Apache-2.0
#include "server/annotate/annotation_answers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <unordered_map>

namespace saccade::server {
namespace {

using nlohmann::json;

using Rgba = std::array<std::uint8_t, 4>;
constexpr Rgba kNoColor{200, 200, 200, 255};

Rgba rgba_of(const Eigen::Vector3f& color) {
  const auto byte = [](float value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255.0F));
  };
  return {byte(color.x()), byte(color.y()), byte(color.z()), 255};
}

/// Grouping of points by label.
class Grouping {
 public:
  explicit Grouping(std::span<const std::uint32_t> labels) : labels_{labels} {}

  /// Adds consecutive points of one label together, since most are.
  void add(std::span<const std::uint32_t> points) {
    for (std::size_t end{0}; !points.empty(); points = points.subspan(end)) {
      const std::uint32_t label = labels_[points.front()];
      for (end = 1; end < points.size() && labels_[points[end]] == label;) ++end;
      std::vector<std::uint32_t>& group = points_of(label);
      group.insert(group.end(), points.begin(), points.begin() + static_cast<std::ptrdiff_t>(end));
    }
  }
  [[nodiscard]] LabelGroups finish() && {
    LabelGroups made;
    for (Group& group : groups_) {
      made.list.push_back({group.label, group.points.size()});
      if (made.points.empty()) {
        made.points = std::move(group.points);
      } else {
        made.points.insert(made.points.end(), group.points.begin(), group.points.end());
      }
    }
    return made;
  }

 private:
  struct Group {
    std::uint32_t label;
    std::vector<std::uint32_t> points;
  };
  std::vector<std::uint32_t>& points_of(std::uint32_t label) {
    const auto [found, is_new] = place_of_.emplace(label, groups_.size());
    if (is_new) groups_.push_back({label, {}});
    return groups_[found->second].points;
  }

  std::span<const std::uint32_t> labels_;  ///< labels of the cloud
  std::vector<Group> groups_;
  std::unordered_map<std::uint32_t, std::size_t> place_of_;
};

json graph_json(const NeighbourhoodConfig& graph) {
  return {{"neighbours", graph.neighbours},       {"position_weight_per_m", graph.position_weight_per_m},
          {"normal_weight", graph.normal_weight}, {"color_weight", graph.color_weight},
          {"max_path", graph.max_path},           {"adapt_to_density", graph.adapt_to_density}};
}

json cloud_json(const OpenCloud& cloud, std::size_t index, const ShownPoints& shown) {
  const CloudFacts& facts = cloud.facts();
  const Eigen::Vector3f& a = facts.least_m;
  const Eigen::Vector3f& b = facts.greatest_m;
  const Eigen::Vector3d& up = facts.upright.up;
  const Eigen::Vector3d& offset_m = cloud.cloud().points.offset_m;
  json out{{"index", index},
           {"name", cloud.cloud().path.filename().string()},
           {"points", cloud.cloud().points.positions_m.size()},
           {"finite", facts.finite},
           {"shown", shown.first},
           {"bounds", {a.x(), a.y(), a.z(), b.x(), b.y(), b.z()}},
           {"spacing_m", facts.spacing_m},
           {"has_colors", !cloud.cloud().points.colors.empty()},
           {"fields", cloud.cloud().fields.names()},
           {"has_segments", !cloud.segments().empty()},
           {"has_normals", !cloud.cloud().points.normals.empty()},
           {"up", {up.x(), up.y(), up.z()}},
           {"offset", {offset_m.x(), offset_m.y(), offset_m.z()}},
           {"graph", graph_json(cloud.graph_config())}};
  if (shown.tiled) out["tiles"] = cloud.tiles()->tree().nodes().size();
  if (const auto& towards = facts.upright.towards_viewer) {
    out["towards_viewer"] = {towards->x(), towards->y(), towards->z()};
  }
  return out;
}

/// Returns a row with label and start cost of a control point; nullopt: it was removed.
ControlPointRow row_of(std::uint32_t point, const std::optional<ControlPoint>& control, const OpenCloud& cloud) {
  const Eigen::Vector3f& p = cloud.cloud().points.positions_m[point];
  ControlPointRow row{point, kNoLabel, 0.0F, {p.x(), p.y(), p.z()}};
  if (control) {
    row.label = control->label;
    row.start_cost = static_cast<float>(control->start_cost);
  }
  return row;
}

/// Tells whether a neighbour of the point is in another segment.
bool is_border(const OpenCloud& cloud, std::uint32_t point) {
  const Neighbourhood& graph = cloud.annotation().forest().neighbourhood();
  const std::span<const std::uint32_t> segments = cloud.segments();
  const auto edges = graph.edges(graph.node_of(point));
  return std::any_of(edges.begin(), edges.end(), [&](const Neighbourhood::Edge& edge) {
    return segments[graph.point_of(edge.node)] != segments[point];
  });
}

}  // namespace

Result<std::uint64_t> whole_number(const json& head, const char* key, std::uint64_t least, std::uint64_t most) {
  const auto found = head.find(key);
  if (found != head.end() && found->is_number_unsigned()) {
    const auto value = found->get<std::uint64_t>();
    if (value >= least && value <= most) return value;
  }
  return Error{Errc::invalid_argument,
               std::string{key} + " is a whole number from " + std::to_string(least) + " to " + std::to_string(most),
               key};
}

std::vector<ControlPointRow> all_control_points(const OpenCloud& cloud) {
  std::vector<ControlPointRow> rows;
  for (const ControlPoint& control : cloud.annotation().control_points()) {
    rows.push_back(row_of(control.point, control, cloud));
  }
  return rows;
}

std::vector<ControlPointRow> control_points_now(std::span<const std::uint32_t> points, const OpenCloud& cloud) {
  std::vector<ControlPointRow> rows;
  for (const std::uint32_t point : points) {
    rows.push_back(row_of(point, cloud.annotation().control_point(point), cloud));
  }
  return rows;
}

std::span<const std::uint32_t> ShownPoints::points(const OpenCloud& cloud, std::vector<std::uint32_t>& room) const {
  if (!tiled) return cloud.order().points(0, first);
  room = cloud.tiles()->points_of(held);
  return room;
}

LabelGroups groups_of(std::span<const std::uint32_t> points, const OpenCloud& cloud, const ShownPoints& shown) {
  Grouping grouping{cloud.annotation().labels()};
  if (shown.tiled) {
    const std::vector<bool> is_held = cloud.tiles()->table_of(shown.held);
    std::vector<std::uint32_t> there;
    std::copy_if(points.begin(), points.end(), std::back_inserter(there), [&](std::uint32_t point) {
      const std::uint32_t node = cloud.tiles()->node_of(point);
      return node != PointOctree::kNoNode && is_held[node];
    });
    grouping.add(there);
  } else if (shown.first == cloud.facts().finite) {  // points that are not finite never have labels
    grouping.add(points);
  } else {
    std::vector<std::uint32_t> there;
    std::copy_if(points.begin(), points.end(), std::back_inserter(there),
                 [&](std::uint32_t point) { return cloud.order().is_among(point, shown.first); });
    grouping.add(there);
  }
  return std::move(grouping).finish();
}

LabelGroups labelled_groups(const OpenCloud& cloud, const ShownPoints& shown) {
  const std::span<const std::uint32_t> labels = cloud.annotation().labels();
  std::vector<std::uint32_t> labelled;
  std::vector<std::uint32_t> room;
  const std::span<const std::uint32_t> among = shown.points(cloud, room);
  std::copy_if(among.begin(), among.end(), std::back_inserter(labelled),
               [&](std::uint32_t point) { return labels[point] != kNoLabel; });
  Grouping grouping{labels};
  grouping.add(labelled);
  return std::move(grouping).finish();
}

void add_state(json& head, const OpenCloud& cloud, std::uint64_t client) {
  head["sequence"] = cloud.sequence();
  head["client_actions"] = cloud.actions_of(client);
  head["can_undo"] = cloud.can_undo(client);
  head["can_redo"] = cloud.can_redo(client);
}

void add_annotation(json& head, const OpenCloud& cloud) {
  const auto why = cloud.read_only();
  head["read_only"] = why ? json(why->to_string()) : json(nullptr);
  head["labels"] = json::array();
  head["control_points"] = 0;
  if (!cloud.ready()) return;
  const Annotation& annotation = cloud.annotation();
  head["labels"] = label_rows(cloud.census().known(annotation), annotation, cloud.census());
  head["control_points"] = cloud.census().control_points();
}

SharedMessage opened_message(json head, const OpenCloud& cloud, std::size_t index, const ShownPoints& shown,
                             std::uint64_t client) {
  head["cloud"] = cloud_json(cloud, index, shown);
  head["ready"] = cloud.ready();
  add_state(head, cloud, client);
  add_annotation(head, cloud);
  MessageWriter message{head};
  if (cloud.ready()) message.append(std::span<const ControlPointRow>{all_control_points(cloud)});
  return std::move(message).finish();
}

SharedMessage octree_message(json head, const Tiles& tiles) {
  struct Row {
    std::array<std::uint32_t, 6> numbers;
    float spacing_m;
  };
  static_assert(sizeof(Row) == 28);
  const PointOctree& tree = tiles.tree();
  std::vector<Row> rows;
  for (const PointOctree::Node& node : tree.nodes()) {
    rows.push_back({{node.parent, node.level, node.x, node.y, node.z, node.count}, node.spacing_m});
  }
  const Eigen::Vector3d& origin_m = tree.origin_m();
  head["count"] = rows.size();
  head["cube"] = {origin_m.x(), origin_m.y(), origin_m.z(), tree.edge_m()};
  MessageWriter message{head};
  message.append(std::span<const Row>{rows});
  return std::move(message).finish();
}

SharedMessage points_message(json head, const OpenCloud& cloud, std::span<const std::uint32_t> chosen) {
  const PointCloud& points = cloud.cloud().points;
  const std::size_t count = chosen.size();
  std::vector<Eigen::Vector3f> positions_m;
  std::vector<Rgba> colors;
  std::vector<std::uint32_t> labels;
  positions_m.reserve(count);
  colors.reserve(count);
  labels.reserve(count);
  for (const std::uint32_t point : chosen) {
    positions_m.push_back(points.positions_m[point]);
    colors.push_back(points.colors.empty() ? kNoColor : rgba_of(points.colors[point]));
    labels.push_back(cloud.ready() ? cloud.annotation().label_of(point) : kNoLabel);
  }
  head["count"] = count;
  MessageWriter message{head};
  message.append(std::span<const Eigen::Vector3f>{positions_m});
  message.append(chosen);
  message.append(std::span<const Rgba>{colors});
  message.append(std::span<const std::uint32_t>{labels});
  return std::move(message).finish();
}

Result<SharedMessage> field_message(json head, const OpenCloud& cloud, std::string_view name,
                                    std::span<const std::uint32_t> chosen) {
  std::vector<float> shown;
  if (name == kNormalField) {
    for (const std::uint32_t point : chosen) {
      const Eigen::Vector3f& normal = cloud.cloud().points.normals[point];
      shown.insert(shown.end(), normal.data(), normal.data() + 3);
    }
  } else {
    SACCADE_TRY(const std::span<const float> numbers, cloud.cloud().fields.numbers(name));
    for (const std::uint32_t point : chosen) shown.push_back(numbers[point]);
  }
  head["count"] = chosen.size();
  MessageWriter message{head};
  message.append(std::span<const float>{shown});
  return std::move(message).finish();
}

SharedMessage segments_message(json head, const OpenCloud& cloud, std::span<const std::uint32_t> chosen) {
  const std::span<const std::uint32_t> segments = cloud.segments();
  std::vector<std::uint32_t> shown;
  std::vector<std::uint8_t> borders;
  shown.reserve(chosen.size());
  borders.reserve(chosen.size());
  for (const std::uint32_t point : chosen) {
    shown.push_back(segments[point]);
    borders.push_back(is_border(cloud, point) ? 1 : 0);
  }
  head["count"] = chosen.size();
  MessageWriter message{head};
  message.append(chosen);
  message.append(std::span<const std::uint32_t>{shown});
  message.append(std::span<const std::uint8_t>{borders});
  return std::move(message).finish();
}

SharedMessage changes_message(json head, std::span<const ControlPointRow> control_points, const LabelGroups& groups) {
  head["control_points"] = control_points.size();
  head["groups"] = groups.list;
  MessageWriter message{head};
  message.append(control_points);
  message.append(std::span<const std::uint32_t>{groups.points});
  return std::move(message).finish();
}

}  // namespace saccade::server

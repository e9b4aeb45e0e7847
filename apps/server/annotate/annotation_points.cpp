// SPDX-License-Identifier: Apache-2.0
// Answers to questions for the points that a page shows: all or some in one order, or in tiles, with what is known of
// each.
#include <algorithm>
#include <cmath>

#include "server/annotate/annotation_answers.hpp"
#include "server/annotate/annotation_service.hpp"

namespace saccade::server {
namespace {

using nlohmann::json;

constexpr std::uint64_t kMostAtOnce{262'144};  // points

}  // namespace

Status AnnotationService::points(Page& page, const Question& question) {
  SACCADE_TRY(const OpenCloud* const cloud, cloud_of(page));
  json head = answer_head(question);
  SACCADE_TRY(const std::vector<std::uint32_t> chosen, chosen_points(page, *cloud, head, question));
  clients_.send(page.id, points_message(std::move(head), *cloud, chosen));
  return {};
}

/// Returns the points that a question chooses: nodes of a page with tiles, or else some of the order.
Result<std::vector<std::uint32_t>> AnnotationService::chosen_points(const Page& page, const OpenCloud& cloud,
                                                                    json& head, const Question& question) const {
  if (page.shown.tiled) return asked_points(question.head, *cloud.tiles(), kMostAtOnce);
  SACCADE_TRY(const std::uint64_t from, whole_number(question.head, "from", 0, page.shown.first));
  SACCADE_TRY(const std::uint64_t asked, whole_number(question.head, "count", 0, kMostAtOnce));
  head["from"] = from;
  const auto chosen = cloud.order().points(from, std::min<std::size_t>(asked, page.shown.first - from));
  return std::vector<std::uint32_t>{chosen.begin(), chosen.end()};
}

Status AnnotationService::octree(Page& page, const Question& question) {
  SACCADE_TRY(const Tiles* const tiles, tiles_of(page));
  clients_.send(page.id, octree_message(answer_head(question), *tiles));
  return {};
}

Status AnnotationService::tiles(Page& page, const Question& question) {
  SACCADE_TRY(const Tiles* const tiles, tiles_of(page));
  SACCADE_TRY(const std::vector<std::uint32_t> chosen, asked_points(question.head, *tiles, kMostAtOnce));
  const std::size_t most = std::min(page.budget, config_.most_shown_points);
  SACCADE_CHECK(update_held(page.shown.held, question.head, *tiles, most));
  clients_.send(page.id, points_message(answer_head(question), *clouds_.at(*page.cloud), chosen));
  return {};
}

Status AnnotationService::field(Page& page, const Question& question) {
  SACCADE_TRY(const OpenCloud* const cloud, cloud_of(page));
  const auto found = question.head.find("name");
  const std::string name = found != question.head.end() && found->is_string() ? found->get<std::string>() : "";
  const std::vector<std::string>& known = cloud->cloud().fields.names();
  const bool is_normal = name == kNormalField && !cloud->cloud().points.normals.empty();
  if (!is_normal && std::find(known.begin(), known.end(), name) == known.end()) {
    return Error{Errc::not_found, "the cloud has no field of this name; `open` lists those it has", name};
  }
  json head = answer_head(question);
  SACCADE_TRY(const std::vector<std::uint32_t> chosen, chosen_points(page, *cloud, head, question));
  SACCADE_TRY(SharedMessage message, field_message(std::move(head), *cloud, name, chosen));
  clients_.send(page.id, std::move(message));
  return {};
}

Status AnnotationService::segments(Page& page, const Question& question) {
  SACCADE_TRY(const OpenCloud* const cloud, ready_cloud_of(page));
  if (cloud->segments().empty()) return Error{Errc::not_found, "there are no segments; --segments names them", {}};
  json head = answer_head(question);
  SACCADE_TRY(const std::vector<std::uint32_t> chosen, chosen_points(page, *cloud, head, question));
  clients_.send(page.id, segments_message(std::move(head), *cloud, chosen));
  return {};
}

Status AnnotationService::margins(Page& page, const Question& question) {
  constexpr float kSure{255.0F};
  SACCADE_TRY(OpenCloud* const cloud, ready_cloud_of(page));
  const std::span<const float> margins = cloud->margins();
  std::vector<std::uint32_t> room;
  if (page.shown.tiled) {
    SACCADE_TRY(room, asked_points(question.head, *cloud->tiles(), kMostAtOnce));
  }
  std::vector<std::uint8_t> shown;
  for (const std::uint32_t point :
       page.shown.tiled ? std::span<const std::uint32_t>{room} : cloud->order().points(0, page.shown.first)) {
    shown.push_back(static_cast<std::uint8_t>(std::lround(kSure * margins[point])));
  }
  json head = answer_head(question);
  head["count"] = shown.size();
  MessageWriter message{head};
  message.append(std::span<const std::uint8_t>{shown});
  clients_.send(page.id, std::move(message).finish());
  return {};
}

}  // namespace saccade::server

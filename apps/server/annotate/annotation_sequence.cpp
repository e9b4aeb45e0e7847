// SPDX-License-Identifier: Apache-2.0
// Sequences of an AnnotationService: labels that are carried to another cloud, and what they mean in all.
#include "server/annotate/annotation_answers.hpp"
#include "server/annotate/annotation_service.hpp"
#include "server/annotate/session_start.hpp"

namespace saccade::server {

using nlohmann::json;

/// Returns the cloud that the question names as `from`; nullopt where it names none.
Result<std::optional<CarrySource>> AnnotationService::source_of(const Page& page, const Question& question) {
  if (!question.head.contains("from")) return std::optional<CarrySource>{};
  SACCADE_TRY(const std::uint64_t index, whole_number(question.head, "from", 0, config_.clouds.size() - 1));
  if (!config_.is_sequence) {
    return Error{Errc::invalid_argument, "these clouds are no sequence; --sequence or --poses makes them one", "from"};
  }
  if (index == *page.cloud) return Error{Errc::invalid_argument, "is the cloud that takes the labels", "from"};
  SACCADE_TRY(const OpenCloud* const from, opened_cloud(index, nullptr));
  if (!from->ready()) return from->not_ready();
  const PointCloud& points = from->cloud().points;
  const Pose T_to_from =
      place_in(config_.clouds[*page.cloud].T_world_cloud, clouds_.at(*page.cloud)->cloud().points.offset_m,
               config_.clouds[index].T_world_cloud, points.offset_m);
  return std::optional{CarrySource{points.positions_m, from->annotation().labels(), T_to_from}};
}

void AnnotationService::begin(OpenCloud& cloud, const OpenCloud::Built& built) {
  cloud.begin(built);
  if (config_.is_sequence && !cloud.read_only()) {
    // A failure to write is told by the first action.
    static_cast<void>(cloud.define(labels_.list()));
    labels_.update(cloud.annotation());
  }
}

void AnnotationService::share_labels(std::size_t index, const OpenCloud::Change& change) {
  if (!config_.is_sequence || change.applied.labels.empty()) return;
  labels_.update(clouds_.at(index)->annotation(), change.applied.labels);
  for (const auto& [other, cloud] : clouds_) {
    if (other == index || !cloud->ready() || cloud->read_only()) continue;
    const auto defined = cloud->define(labels_.list());
    if (!defined || !defined->applied.done) continue;
    send_changes(other, {kProgramClient, {}}, *cloud, *defined, json{{"do", "labels"}});
  }
}

}  // namespace saccade::server

// SPDX-License-Identifier: Apache-2.0
// Clouds of an AnnotationService, and its notices.
#include <algorithm>
#include <utility>

#include "server/annotate/annotation_answers.hpp"
#include "server/annotate/annotation_service.hpp"

namespace saccade::server {

using nlohmann::json;

Status AnnotationService::prepare(std::size_t index) try {
  SACCADE_EXPECTS(index < config_.clouds.size());
  if (const auto opened = opened_cloud(index, nullptr); !opened) return opened.error();
  last_used_ = index;
  return {};
} catch (const std::exception& problem) {
  return Error{Errc::unavailable, problem.what(), config_.clouds[index].cloud.string()};
}

Result<OpenCloud*> AnnotationService::opened_cloud(std::size_t index, Page* page) {
  if (const auto there = clouds_.find(index); there != clouds_.end()) return there->second.get();
  const Progress progress{[&](std::string_view stage, std::size_t done, std::size_t total) {
    if (page == nullptr) return;
    clients_.send(
        page->id,
        MessageWriter{json{{"type", "progress"}, {"stage", stage}, {"done", done}, {"total", total}}}.finish());
  }};
  SACCADE_TRY(std::unique_ptr<OpenCloud> opened,
              OpenCloud::open(config_.clouds[index], config_.start, executor_, progress));
  SACCADE_CHECK(make_room(index, *opened, page));
  const std::size_t points = opened->cloud().points.positions_m.size();
  if (points <= config_.graph_at_once_points) {
    SACCADE_TRY(const OpenCloud::Built built, opened->build(executor_, progress));
    begin(*opened, built);
  }
  OpenCloud& cloud = *(clouds_[index] = std::move(opened));
  if (!cloud.ready()) build(index, cloud);
  return &cloud;
}

/// Drops clouds that no page has open, except the last one used.
/// @return the number of points then open.
std::size_t AnnotationService::drop_unused() {
  std::erase_if(clouds_, [&](const auto& open) { return open.first != last_used_ && pages_of(open.first).empty(); });
  std::size_t points{0};
  for (const auto& [index, open] : clouds_) points += open->cloud().points.positions_m.size();
  return points;
}

/// Makes room: first the last one used is dropped, then the one that the page leaves.
Status AnnotationService::make_room(std::size_t index, const OpenCloud& cloud, Page* page) {
  const std::size_t wanted = cloud.cloud().points.positions_m.size();
  const auto fits = [&] { return drop_unused() + wanted <= config_.most_open_points || clouds_.empty(); };
  if (fits()) return {};
  last_used_.reset();
  if (fits()) return {};
  if (page != nullptr) leave(*page);
  last_used_.reset();
  if (fits()) return {};
  return Error{Errc::unavailable, "too many large clouds are open in other pages",
               config_.clouds[index].cloud.filename().string()};
}

void AnnotationService::build(std::size_t index, OpenCloud& cloud) {
  const auto report = [this, index, &cloud](std::string_view stage, std::size_t done, std::size_t total) {
    post_([this, index, &cloud, stage = std::string{stage}, done, total] {
      const auto there = clouds_.find(index);
      if (there != clouds_.end() && there->second.get() == &cloud) send_progress(index, stage, done, total);
    });
  };
  const auto finished = [this, index, &cloud](std::shared_ptr<Result<OpenCloud::Built>> made) {
    post_([this, index, &cloud, made = std::move(made)] { built(index, &cloud, *made); });
  };
  // With separate threads, so that an action on another cloud need not wait.
  cloud.build_apart(Executor::with_threads(config_.threads), report, finished);
}

void AnnotationService::built(std::size_t index, const OpenCloud* cloud, const Result<OpenCloud::Built>& built) {
  const auto there = clouds_.find(index);
  if (there == clouds_.end() || there->second.get() != cloud) return;  // no page waits for it any more
  if (!built) {
    there->second->fail(built.error());
    send_read_only(index, built.error().to_string());
    return;
  }
  try {
    begin(*there->second, *built);
  } catch (const std::exception& problem) {  // there is no memory for it
    there->second->fail({Errc::unavailable, problem.what(), "session"});
    send_read_only(index, problem.what());
    return;
  }
  send_ready(index, *there->second);
}

void AnnotationService::leave(Page& page, std::optional<std::size_t> next) {
  const std::optional<std::size_t> before = std::exchange(page.cloud, next);
  if (!before) return;
  const std::size_t index = *before;
  send_people(index);
  if (!pages_of(index).empty()) return;
  if (last_used_ && last_used_ != index && pages_of(*last_used_).empty()) clouds_.erase(*last_used_);
  last_used_ = index;
}

void AnnotationService::show(Page& page, const OpenCloud& cloud, bool tiled) {
  page.shown = {};
  page.shown.tiled = tiled && cloud.tiles() != nullptr;
  if (!page.shown.tiled) page.shown.first = std::min({page.budget, cloud.facts().finite, config_.most_shown_points});
}

Result<const Tiles*> AnnotationService::tiles_of(const Page& page) {
  SACCADE_TRY(const OpenCloud* const cloud, cloud_of(page));
  if (page.shown.tiled) return cloud->tiles();
  return Error{Errc::invalid_argument, "the cloud was not opened with tiles, or is too small for them", "nodes"};
}

Result<OpenCloud*> AnnotationService::cloud_of(const Page& page) {
  if (!page.cloud) return Error{Errc::invalid_argument, "there is no cloud open; ask \"open\" first", "cloud"};
  return clouds_.at(*page.cloud).get();
}

Result<OpenCloud*> AnnotationService::ready_cloud_of(const Page& page) {
  SACCADE_TRY(OpenCloud* const cloud, cloud_of(page));
  if (!cloud->ready()) return cloud->not_ready();
  return cloud;
}

Result<std::uint32_t> AnnotationService::point_of(const OpenCloud& cloud, const Question& question) const {
  const std::size_t points = cloud.cloud().points.positions_m.size();
  SACCADE_TRY(const std::uint64_t point, whole_number(question.head, "point", 0, points - 1));
  return static_cast<std::uint32_t>(point);
}

std::vector<AnnotationService::Page*> AnnotationService::pages_of(std::size_t index) {
  std::vector<Page*> pages;
  for (auto& [id, page] : pages_) {
    if (page.cloud == index) pages.push_back(&page);
  }
  return pages;
}

void AnnotationService::send_progress(std::size_t index, const std::string& stage, std::size_t done,
                                      std::size_t total) {
  const SharedMessage message =
      MessageWriter{json{{"type", "progress"}, {"stage", stage}, {"done", done}, {"total", total}}}.finish();
  for (const Page* page : pages_of(index)) clients_.send(page->id, message);
}

void AnnotationService::send_people(std::size_t index) {
  const std::vector<Page*> pages = pages_of(index);
  json people = json::array();
  for (const Page* page : pages) people.push_back({{"client", page->client}, {"name", page->name}});
  const SharedMessage message =
      MessageWriter{json{{"type", "people"}, {"count", pages.size()}, {"people", std::move(people)}}}.finish();
  for (const Page* page : pages) clients_.send(page->id, message);
}

void AnnotationService::send_read_only(std::size_t index, const std::string& why) {
  const SharedMessage message = MessageWriter{json{{"type", "read_only"}, {"why", why}}}.finish();
  for (const Page* page : pages_of(index)) clients_.send(page->id, message);
}

void AnnotationService::send_ready(std::size_t index, const OpenCloud& cloud) {
  const std::vector<ControlPointRow> control_points = all_control_points(cloud);
  json common{{"type", "ready"}};
  add_annotation(common, cloud);
  for (const Page* page : pages_of(index)) {
    json head = common;
    add_state(head, cloud, page->client);
    clients_.send(page->id, changes_message(std::move(head), control_points, labelled_groups(cloud, page->shown)));
  }
}

void AnnotationService::send_changes(std::size_t index, const Author& author, const OpenCloud& cloud,
                                     const OpenCloud::Change& change, const json& action) {
  const Annotation& annotation = cloud.annotation();
  const std::vector<ControlPointRow> control_points = control_points_now(change.applied.control_points, cloud);
  const json rows = label_rows(change.labels, annotation, cloud.census());
  json what{{"do", action.at("do")}};
  if (action.contains("label")) what["label"] = action.at("label");
  std::map<std::size_t, LabelGroups> groups;  // by the number of points that are shown; not for tiles
  for (const Page* page : pages_of(index)) {
    auto found = groups.find(page->shown.first);
    if (page->shown.tiled || found == groups.end()) {
      groups[page->shown.first] = groups_of(change.applied.points, cloud, page->shown);
      found = groups.find(page->shown.first);
    }
    json head{{"type", "changes"},
              {"sequence", cloud.sequence()},
              {"client", author.client},
              {"name", author.name},
              {"action", what},
              {"can_undo", cloud.can_undo(page->client)},
              {"can_redo", cloud.can_redo(page->client)},
              {"labels", rows}};
    clients_.send(page->id, changes_message(std::move(head), control_points, found->second));
  }
}

}  // namespace saccade::server

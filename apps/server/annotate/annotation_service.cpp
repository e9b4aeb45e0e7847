// SPDX-License-Identifier: Apache-2.0
#include "server/annotate/annotation_service.hpp"

#include <algorithm>
#include <charconv>
#include <limits>

#include "saccade/annotate/annotation_margin.hpp"
#include "saccade/annotate/click_start.hpp"
#include "saccade/cloud/label_boxes.hpp"
#include "server/annotate/action_question.hpp"
#include "server/annotate/annotation_answers.hpp"
#include "server/annotate/label_export.hpp"

namespace saccade::server {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::uint64_t kProtocol{1};
constexpr std::uint64_t kMostClient{(std::uint64_t{1} << 53U) - 1};  // largest number that a page represents exactly
constexpr std::uint64_t kMost32{std::numeric_limits<std::uint32_t>::max()};
constexpr std::uint16_t kBadData{1007};

HttpAnswer http_error(int status, const std::string& text) {
  HttpAnswer answer{status, "text/plain; charset=utf-8", {}, {}};
  answer.body.assign(text.begin(), text.end());
  return answer;
}

Result<bool> takes_tiles(const json& head) {
  const auto tiles = head.find("tiles");
  if (tiles == head.end()) return false;
  if (!tiles->is_boolean()) return Error{Errc::invalid_argument, "tiles is true or false", "tiles"};
  return tiles->get<bool>();
}

std::string value_of(const HttpRequest& request, const std::string& key) {
  const auto found = request.query.find(key);
  return found == request.query.end() ? std::string{} : found->second;
}

/// Returns the person's name; empty where none is given.
Result<std::string> name_in(const json& head) {
  constexpr std::size_t kMostBytes{64};
  const auto found = head.find("name");
  if (found == head.end()) return std::string{};
  LabelInfo text;
  if (found->is_string()) text.name = found->get<std::string>();
  if (!found->is_string() || text.name.size() > kMostBytes || !text.validate()) {
    return Error{Errc::invalid_argument, "name is a line of text of 64 bytes at most", "name"};
  }
  return text.name;
}

}  // namespace

AnnotationService::AnnotationService(AnnotationServiceConfig config, Clients& clients, Post post)
    : config_{std::move(config)},
      clients_{clients},
      post_{std::move(post)},
      executor_{Executor::with_threads(config_.threads)} {
  SACCADE_EXPECTS(!config_.clouds.empty());
  if (!config_.is_sequence) return;
  std::vector<fs::path> sessions;
  for (const ServedCloud& cloud : config_.clouds) sessions.push_back(cloud.session);
  labels_ = SequenceLabels::of_sessions(sessions);
  labels_.take(config_.start.presets);
}

void AnnotationService::opened(ConnectionId connection) { pages_[connection].id = connection; }

void AnnotationService::closed(ConnectionId connection) {
  const auto page = pages_.find(connection);
  if (page == pages_.end()) return;
  leave(page->second);
  pages_.erase(page);
}

AnnotationService::Handler AnnotationService::handler_of(const std::string& type) {
  static const std::map<std::string, Handler> handlers{
      {"hello", &AnnotationService::hello},     {"open", &AnnotationService::open},
      {"points", &AnnotationService::points},   {"action", &AnnotationService::action},
      {"root", &AnnotationService::root},       {"tree", &AnnotationService::tree},
      {"margins", &AnnotationService::margins}, {"next_best_click", &AnnotationService::next_click},
      {"save", &AnnotationService::save},       {"new", &AnnotationService::begin_anew},
      {"field", &AnnotationService::field},     {"octree", &AnnotationService::octree},
      {"tiles", &AnnotationService::tiles},     {"segments", &AnnotationService::segments},
      {"name", &AnnotationService::name},       {"boxes", &AnnotationService::boxes}};
  const auto found = handlers.find(type);
  return found == handlers.end() ? nullptr : found->second;
}

void AnnotationService::received(ConnectionId connection, std::span<const std::uint8_t> message) {
  const auto page = pages_.find(connection);
  if (page == pages_.end()) return;
  const auto question = parse_question(message);
  if (!question) {
    clients_.close(connection, kBadData, question.error().message);
    return;
  }
  try {
    if (const Status done = answer(page->second, *question); !done) {
      clients_.send(connection, refusal(question->request, done.error()));
    }
  } catch (const std::exception& problem) {
    if (question->type == "action" || question->type == "new") abandon(page->second);
    clients_.send(connection, refusal(question->request, Error{Errc::unavailable, problem.what(), question->type}));
  }
}

Status AnnotationService::answer(Page& page, const Question& question) {
  const Handler handler = handler_of(question.type);
  if (handler == nullptr) {
    return Error{Errc::unsupported, "there is no question of this type", question.type.substr(0, 64)};
  }
  const bool is_hello = question.type == "hello";
  if (page.client == 0 && !is_hello) return Error{Errc::invalid_argument, "the first question is hello", "type"};
  if (page.client != 0 && is_hello) return Error{Errc::invalid_argument, "hello was received already", "type"};
  return (this->*handler)(page, question);
}

/// Handles an unexpected exception. An action that is half done in memory is either complete or absent on the disk, so
/// every page must open the cloud again.
void AnnotationService::abandon(Page& page) {
  if (!page.cloud) return;
  const std::size_t index = *page.cloud;
  for (Page* other : pages_of(index)) {
    other->cloud.reset();
    clients_.send(other->id, MessageWriter{json{{"type", "reset"}}}.finish());
  }
  if (last_used_ == index) last_used_.reset();
  clouds_.erase(index);
}

Status AnnotationService::hello(Page& page, const Question& question) {
  SACCADE_TRY(const std::uint64_t protocol, whole_number(question.head, "protocol", 0, kMost32));
  if (protocol != kProtocol) return Error{Errc::unsupported, "this program speaks protocol 1", "protocol"};
  SACCADE_TRY(page.name, name_in(question.head));
  SACCADE_TRY(page.client, whole_number(question.head, "client", 1, kMostClient));
  json clouds = json::array();
  for (const ServedCloud& served : config_.clouds) {
    std::error_code ignored;
    const std::uintmax_t bytes = fs::file_size(served.cloud, ignored);
    clouds.push_back({{"name", served.cloud.filename().string()},
                      {"bytes", ignored ? 0 : bytes},
                      {"begun", fs::exists(served.session, ignored)}});
  }
  json head = answer_head(question);
  head["protocol"] = kProtocol;
  head["version"] = config_.version;
  head["mode"] = "annotate";
  head["title"] = config_.title;
  head["clouds"] = std::move(clouds);
  head["sequence"] = config_.is_sequence;
  head["colors"] = well_apart_colors();
  head["current"] = last_used_.value_or(0);
  clients_.send(page.id, MessageWriter{head}.finish());
  return {};
}

Status AnnotationService::name(Page& page, const Question& question) {
  SACCADE_TRY(page.name, name_in(question.head));
  clients_.send(page.id, MessageWriter{answer_head(question)}.finish());
  if (page.cloud) send_people(*page.cloud);
  return {};
}

Status AnnotationService::open(Page& page, const Question& question) {
  SACCADE_TRY(const std::uint64_t index, whole_number(question.head, "cloud", 0, config_.clouds.size() - 1));
  SACCADE_TRY(page.budget, whole_number(question.head, "budget", 1, kMost32));
  SACCADE_TRY(const bool tiled, takes_tiles(question.head));
  SACCADE_TRY(OpenCloud* const cloud, opened_cloud(index, &page));
  const bool is_new = page.cloud != index;
  if (is_new) leave(page, index);
  show(page, *cloud, tiled);
  clients_.send(page.id, opened_message(answer_head(question), *cloud, index, page.shown, page.client));
  if (is_new) send_people(index);
  return {};
}

Status AnnotationService::check_room(std::size_t index) const {
  const fs::path& session = config_.clouds[index].session;
  std::error_code ignored;  // writing says it better
  const std::uintmax_t bytes = fs::file_size(session, ignored);
  if (ignored || bytes < config_.most_session_bytes) return {};
  return Error{Errc::unavailable, "the session is as large as sessions may be; save the labels and begin a new one",
               session.filename().string()};
}

Status AnnotationService::action(Page& page, const Question& question) {
  SACCADE_TRY(OpenCloud* const cloud, ready_cloud_of(page));
  if (const auto why = cloud->read_only()) return *why;
  SACCADE_CHECK(check_room(*page.cloud));
  SACCADE_TRY(const std::optional<CarrySource> before, source_of(page, question));
  const AskedOn subject{cloud->cloud().points.positions_m, cloud->segments(), cloud->annotation(),
                        before ? &*before : nullptr};
  SACCADE_TRY(AnnotationAction asked, asked_action(question.head, subject, page.client, executor_));
  const auto* carried = std::get_if<PaintLabels>(&asked.change);
  const std::size_t carried_points = carried == nullptr ? 0 : carried->points.size();
  const auto change = cloud->apply(guarded_click(cloud->annotation(), std::move(asked)));
  if (!change) {
    if (const auto why = cloud->read_only()) send_read_only(*page.cloud, why->to_string());
    return change.error();
  }
  if (change->applied.done) {
    send_changes(*page.cloud, {page.client, page.name}, *cloud, *change, question.head["action"]);
    share_labels(*page.cloud, *change);
  }
  json head = answer_head(question);
  head["done"] = change->applied.done;
  if (before) head["carried"] = carried_points;
  add_state(head, *cloud, page.client);
  clients_.send(page.id, MessageWriter{head}.finish());
  return {};
}

Status AnnotationService::root(Page& page, const Question& question) {
  SACCADE_TRY(const OpenCloud* const cloud, ready_cloud_of(page));
  SACCADE_TRY(const std::uint32_t point, point_of(*cloud, question));
  const auto root = cloud->annotation().forest().root_of(point);
  json head = answer_head(question);
  head["control_point"] = root ? json(*root) : json(nullptr);
  head["label"] = cloud->annotation().label_of(point);
  head["painted"] = cloud->annotation().painted(point);
  clients_.send(page.id, MessageWriter{head}.finish());
  return {};
}

Status AnnotationService::tree(Page& page, const Question& question) {
  SACCADE_TRY(const OpenCloud* const cloud, ready_cloud_of(page));
  SACCADE_TRY(const std::uint32_t point, point_of(*cloud, question));
  const ShortestPathForest& forest = cloud->annotation().forest();
  const auto root = forest.root_of(point);
  std::vector<std::uint32_t> same;
  if (root) {
    std::vector<std::uint32_t> room;
    for (const std::uint32_t other : page.shown.points(*cloud, room)) {
      if (forest.root_of(other) == root) same.push_back(other);
    }
  }
  json head = answer_head(question);
  head["count"] = same.size();
  MessageWriter message{head};
  message.append(std::span<const std::uint32_t>{same});
  clients_.send(page.id, std::move(message).finish());
  return {};
}

Status AnnotationService::next_click(Page& page, const Question& question) {
  SACCADE_TRY(OpenCloud* const cloud, ready_cloud_of(page));
  const auto best = next_best_click(cloud->annotation(), cloud->margins(), cloud->ends());
  json head = answer_head(question);
  head["point"] = best ? json(best->point) : json(nullptr);
  head["position"] = nullptr;
  head["label"] = best ? best->label : kNoLabel;
  head["gain"] = best ? best->gain : 0.0;
  if (best) {
    const Eigen::Vector3f& p = cloud->cloud().points.positions_m[best->point];
    head["position"] = {p.x(), p.y(), p.z()};
  }
  clients_.send(page.id, MessageWriter{head}.finish());
  return {};
}

Status AnnotationService::boxes(Page& page, const Question& question) {
  SACCADE_TRY(const OpenCloud* const cloud, ready_cloud_of(page));
  const Eigen::Vector3d& up = cloud->facts().upright.up;
  json head = answer_head(question);
  head["boxes"] = json::array();
  for (const LabelBox& box : label_boxes(cloud->cloud().points.positions_m, cloud->annotation().labels(), up)) {
    const auto list = [](const Eigen::Vector3d& v) { return json{v.x(), v.y(), v.z()}; };
    head["boxes"].push_back({{"label", box.label},
                             {"center", list(box.center_m)},
                             {"size", list(box.size_m)},
                             {"axes", {list(box.axes.col(0)), list(box.axes.col(1)), list(box.axes.col(2))}}});
  }
  clients_.send(page.id, MessageWriter{head}.finish());
  return {};
}

Status AnnotationService::save(Page& page, const Question& question) {
  SACCADE_TRY(const OpenCloud* const cloud, ready_cloud_of(page));
  const ServedCloud& served = config_.clouds[*page.cloud];
  const LabelledPoints labels = labelled_points(cloud->annotation());
  std::error_code ignored;  // writing says it better
  if (served.out.has_parent_path()) fs::create_directories(served.out.parent_path(), ignored);
  SACCADE_TRY(const auto file, cloud->cloud().fields.file());
  SACCADE_CHECK(write_labels(served.out, *file, labels.labels, labels.names()));
  json files = {served.out.string()};
  if (!served.names.empty()) {
    SACCADE_CHECK(write_names(served.names, labels.names()));
    files.push_back(served.names.string());
  }
  json head = answer_head(question);
  head["files"] = std::move(files);
  clients_.send(page.id, MessageWriter{head}.finish());
  return {};
}

Status AnnotationService::begin_anew(Page& page, const Question& question) {
  SACCADE_TRY(OpenCloud* const cloud, ready_cloud_of(page));
  if (const auto why = cloud->read_only()) return *why;
  const std::size_t index = *page.cloud;
  SACCADE_TRY(const fs::path kept, cloud->begin_anew());
  if (config_.is_sequence && !cloud->read_only()) static_cast<void>(cloud->define(labels_.list()));
  for (Page* other : pages_of(index)) {
    if (other->id == page.id) continue;
    other->cloud.reset();  // its questions refer to a dropped cloud until it opens it again
    clients_.send(other->id, MessageWriter{json{{"type", "reset"}}}.finish());
  }
  page.shown.held.clear();
  json head = answer_head(question);
  head["kept"] = kept.filename().string();
  clients_.send(page.id, opened_message(std::move(head), *cloud, index, page.shown, page.client));
  return {};
}

HttpAnswer AnnotationService::get(const HttpRequest& request) {
  constexpr int kBadRequest{400};
  constexpr int kNotFound{404};
  constexpr int kFailed{500};
  constexpr int kUnavailable{503};
  if (request.path != "labels") return http_error(kNotFound, "there is no such file");
  const std::string text = value_of(request, "cloud");
  std::size_t index{0};
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (text.empty() || code != std::errc{} || end != text.data() + text.size() || index >= config_.clouds.size()) {
    return http_error(kBadRequest, "cloud is the index of a cloud");
  }
  const auto cloud = clouds_.find(index);
  if (cloud == clouds_.end()) return http_error(kNotFound, "this cloud is not open");
  if (!cloud->second->ready()) return http_error(kUnavailable, cloud->second->not_ready().to_string());
  try {
    const auto file =
        label_file(cloud->second->cloud(), labelled_points(cloud->second->annotation()), value_of(request, "format"));
    if (file) return *file;
    const bool is_theirs = file.error().code == Errc::invalid_argument || file.error().code == Errc::unsupported;
    return http_error(is_theirs ? kBadRequest : kFailed, file.error().to_string());
  } catch (const std::exception& problem) {
    return http_error(kFailed, problem.what());
  }
}

}  // namespace saccade::server

// SPDX-License-Identifier: Apache-2.0
#include "server/annotate/annotation_service.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "saccade/annotate/annotation_margin.hpp"
#include "saccade/annotate/click_start.hpp"
#include "saccade/io/clouds/scalar_fields.hpp"
#include "server/annotate/action_question.hpp"
#include "server/annotate/annotation_answers.hpp"
#include "server/annotate/label_export.hpp"

namespace saccade::server {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::uint64_t kProtocol{1};
constexpr std::uint64_t kMostClient{(std::uint64_t{1} << 53U) - 1};  // largest number that a page represents exactly
constexpr std::uint64_t kMostAtOnce{262'144};                        // points
constexpr std::uint64_t kMost32{std::numeric_limits<std::uint32_t>::max()};
constexpr std::uint16_t kBadData{1007};

HttpAnswer http_error(int status, const std::string& text) {
  HttpAnswer answer{status, "text/plain; charset=utf-8", {}, {}};
  answer.body.assign(text.begin(), text.end());
  return answer;
}

std::string value_of(const HttpRequest& request, const std::string& key) {
  const auto found = request.query.find(key);
  return found == request.query.end() ? std::string{} : found->second;
}

}  // namespace

AnnotationService::AnnotationService(AnnotationServiceConfig config, Clients& clients, Post post)
    : config_{std::move(config)},
      clients_{clients},
      post_{std::move(post)},
      executor_{Executor::with_threads(config_.threads)} {
  SACCADE_EXPECTS(!config_.clouds.empty());
}

void AnnotationService::opened(ConnectionId connection) { pages_[connection] = Page{connection, 0, {}, 0, 0}; }

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
      {"field", &AnnotationService::field}};
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
  head["colors"] = well_apart_colors();
  head["current"] = last_used_.value_or(0);
  clients_.send(page.id, MessageWriter{head}.finish());
  return {};
}

Status AnnotationService::open(Page& page, const Question& question) {
  SACCADE_TRY(const std::uint64_t index, whole_number(question.head, "cloud", 0, config_.clouds.size() - 1));
  SACCADE_TRY(page.budget, whole_number(question.head, "budget", 1, kMost32));
  SACCADE_TRY(OpenCloud* const cloud, opened_cloud(index, &page));
  const bool is_new = page.cloud != index;
  if (is_new) leave(page, index);
  show(page, *cloud);
  clients_.send(page.id, opened_message(answer_head(question), *cloud, index, page.shown, page.client));
  if (is_new) send_people(index);
  return {};
}

Status AnnotationService::points(Page& page, const Question& question) {
  SACCADE_TRY(const OpenCloud* const cloud, cloud_of(page));
  SACCADE_TRY(const std::uint64_t from, whole_number(question.head, "from", 0, page.shown));
  SACCADE_TRY(const std::uint64_t asked, whole_number(question.head, "count", 0, kMostAtOnce));
  const std::size_t count = std::min<std::size_t>(asked, page.shown - from);
  clients_.send(page.id, points_message(answer_head(question), *cloud, from, count));
  return {};
}

Status AnnotationService::field(Page& page, const Question& question) {
  SACCADE_TRY(const OpenCloud* const cloud, cloud_of(page));
  const auto found = question.head.find("name");
  const std::string name = found != question.head.end() && found->is_string() ? found->get<std::string>() : "";
  const std::vector<std::string> known = scalar_field_names(cloud->cloud().file.fields());
  const bool is_normal = name == kNormalField && !cloud->cloud().points.normals.empty();
  if (!is_normal && std::find(known.begin(), known.end(), name) == known.end()) {
    return Error{Errc::not_found, "the cloud has no field of this name; `open` lists those it has", name};
  }
  SACCADE_TRY(const std::uint64_t from, whole_number(question.head, "from", 0, page.shown));
  SACCADE_TRY(const std::uint64_t asked, whole_number(question.head, "count", 0, kMostAtOnce));
  const std::size_t count = std::min<std::size_t>(asked, page.shown - from);
  clients_.send(page.id, field_message(answer_head(question), *cloud, name, from, count));
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
  SACCADE_TRY(AnnotationAction asked, asked_action(question.head, cloud->cloud().points.positions_m,
                                                   cloud->annotation(), page.client, executor_));
  const auto change = cloud->apply(guarded_click(cloud->annotation(), std::move(asked)));
  if (!change) {
    if (const auto why = cloud->read_only()) send_read_only(*page.cloud, why->to_string());
    return change.error();
  }
  if (change->applied.done) send_changes(*page.cloud, *cloud, *change, page.client);
  json head = answer_head(question);
  head["done"] = change->applied.done;
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
    for (const std::uint32_t other : cloud->order().points(0, page.shown)) {
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

Status AnnotationService::margins(Page& page, const Question& question) {
  constexpr float kSure{255.0F};
  SACCADE_TRY(OpenCloud* const cloud, ready_cloud_of(page));
  const std::span<const float> margins = cloud->margins();
  std::vector<std::uint8_t> shown;
  shown.reserve(page.shown);
  for (const std::uint32_t point : cloud->order().points(0, page.shown)) {
    shown.push_back(static_cast<std::uint8_t>(std::lround(kSure * margins[point])));
  }
  json head = answer_head(question);
  head["count"] = shown.size();
  MessageWriter message{head};
  message.append(std::span<const std::uint8_t>{shown});
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

Status AnnotationService::save(Page& page, const Question& question) {
  SACCADE_TRY(const OpenCloud* const cloud, ready_cloud_of(page));
  const ServedCloud& served = config_.clouds[*page.cloud];
  const LabelledPoints labels = labelled_points(cloud->annotation());
  std::error_code ignored;  // writing says it better
  if (served.out.has_parent_path()) fs::create_directories(served.out.parent_path(), ignored);
  SACCADE_CHECK(write_labels(served.out, cloud->cloud().file, labels.labels, labels.names()));
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
  for (Page* other : pages_of(index)) {
    if (other->id == page.id) continue;
    other->cloud.reset();  // its questions refer to a dropped cloud until it opens it again
    clients_.send(other->id, MessageWriter{json{{"type", "reset"}}}.finish());
  }
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

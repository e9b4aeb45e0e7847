// SPDX-License-Identifier: Apache-2.0
#include "server/show/viewer_service.hpp"

#include <algorithm>

#include "saccade/io/files/file_io.hpp"
#include "server/report_file.hpp"

namespace saccade::server {
namespace {

using nlohmann::json;

constexpr std::uint64_t kProtocol{1};
constexpr std::uint64_t kMaxBufferBytes{std::uint64_t{4} << 20U};
constexpr std::uintmax_t kMaxPictureBytes{std::uintmax_t{64} << 20U};
constexpr std::uint16_t kUnreadable{1007};  // RFC 6455: not consistent with the type of the message

Error wrong_question(const std::string& what) { return {Errc::invalid_argument, what, ""}; }

Result<std::uint64_t> whole_number(const json& head, const char* name) {
  const auto found = head.find(name);
  if (found == head.end() || !found->is_number_unsigned()) {
    return wrong_question(std::string{name} + " must be an integer");
  }
  return found->get<std::uint64_t>();
}

HttpAnswer refused(int status, const std::string& why) {
  return {status, "text/plain; charset=utf-8", "", {why.begin(), why.end()}};
}

bool is_picture(std::string_view name) { return name.ends_with(".png") || name.ends_with(".svg"); }

const char* picture_type(const std::filesystem::path& path) {
  if (path.extension() == ".svg") return "image/svg+xml";
  return path.extension() == ".png" ? "image/png" : "image/jpeg";
}

}  // namespace

ViewerService::ViewerService(Clients& clients, ViewerConfig config, const SceneDocument& document)
    : clients_{clients}, config_{std::move(config)}, shown_{prepare(document)} {
  SACCADE_EXPECTS(config_.post != nullptr);
}

ViewerService::Shown ViewerService::prepare(const SceneDocument& document) {
  Shown shown{document_json(document), {}, {}, nullptr, {}};
  for (const Layer& layer : document.layers) {
    shown.buffers.emplace(layer.buffer->name, layer.buffer);
    if (!layer.fields) continue;
    for (const LayerField& field : *layer.fields) shown.buffers.emplace(field.buffer->name, field.buffer);
  }
  for (const Step& step : document.steps) {
    for (const StepPicture& picture : step.pictures) shown.pictures.insert_or_assign(picture.name, picture.path);
  }
  if (document.record.is_null()) return shown;
  shown.report = report_document(document.record, document.folder);
  shown.report["live"] = document.live;
  for (const json& file : shown.report["files"]) {
    const auto& name = file.get_ref<const std::string&>();
    if (is_picture(name)) shown.files.emplace(name, document.folder / name);
  }
  return shown;
}

void ViewerService::update(const SceneDocument& document) {
  // Prepared here, to keep the load on the service's thread small.
  auto shown = std::make_shared<Shown>(prepare(document));
  config_.post([this, shown] { replace(std::move(*shown)); });
}

void ViewerService::replace(Shown shown) {
  earlier_ = std::move(shown_.buffers);
  shown_ = std::move(shown);
  ++revision_;
  const SharedMessage notice = MessageWriter{{{"type", "document"}, {"revision", revision_}}}.finish();
  for (const ConnectionId connection : greeted_) clients_.send(connection, notice);
}

void ViewerService::opened(ConnectionId /*connection*/) {}

void ViewerService::closed(ConnectionId connection) { greeted_.erase(connection); }

void ViewerService::received(ConnectionId connection, std::span<const std::uint8_t> message) {
  const auto question = parse_question(message);
  if (!question) {
    clients_.close(connection, kUnreadable, question.error().message);
    return;
  }
  const auto answered = answer(connection, *question);
  clients_.send(connection, answered ? *answered : refusal(question->request, answered.error()));
}

Result<SharedMessage> ViewerService::answer(ConnectionId connection, const Question& question) {
  if (question.type == "hello") return answer_hello(connection, question);
  if (question.type == "buffer") return answer_buffer(question);
  if (question.type == "document") {
    json head = answer_head(question);
    head["document"] = shown_.document;
    head["revision"] = revision_;
    return MessageWriter{head}.finish();
  }
  return wrong_question("a viewer answers hello, document and buffer alone");
}

Result<SharedMessage> ViewerService::answer_hello(ConnectionId connection, const Question& question) {
  SACCADE_TRY(const std::uint64_t protocol, whole_number(question.head, "protocol"));
  if (protocol != kProtocol) {
    return Error{Errc::unsupported, "this program speaks protocol 1; reload the page", ""};
  }
  greeted_.insert(connection);
  json head = answer_head(question);
  head.update({{"protocol", kProtocol},
               {"version", config_.version},
               {"mode", "show"},
               {"title", shown_.document["title"]},
               {"document", revision_}});
  return MessageWriter{head}.finish();
}

Result<SharedMessage> ViewerService::answer_buffer(const Question& question) const {
  const auto name = question.head.find("name");
  if (name == question.head.end() || !name->is_string()) return wrong_question("name must be a text");
  SACCADE_TRY(const std::uint64_t from, whole_number(question.head, "from"));
  SACCADE_TRY(const std::uint64_t wanted, whole_number(question.head, "bytes"));
  if (wanted > kMaxBufferBytes) return wrong_question("at most 4194304 bytes at a time");
  const auto& text = name->get_ref<const std::string&>();
  auto found = shown_.buffers.find(text);
  if (found == shown_.buffers.end()) {
    found = earlier_.find(text);
    if (found == earlier_.end()) return Error{Errc::not_found, "there is no such buffer; ask for the document", ""};
  }
  const std::vector<std::uint8_t>& bytes = found->second->bytes;
  if (from > bytes.size()) return wrong_question("from lies beyond the end of the buffer");
  json head = answer_head(question);
  head["from"] = from;
  head["total"] = bytes.size();
  MessageWriter message{head};
  message.append(std::span{bytes}.subspan(from, std::min<std::uint64_t>(wanted, bytes.size() - from)));
  return std::move(message).finish();
}

HttpAnswer ViewerService::answer_report() const {
  if (shown_.report.is_null()) return refused(404, "there is no record of a run yet");
  const std::string text = shown_.report.dump(-1, ' ', false, json::error_handler_t::replace);
  return {200, "application/json", "", {text.begin(), text.end()}};
}

HttpAnswer ViewerService::get(const HttpRequest& request) {
  if (request.path == "report") return answer_report();
  const bool of_report = request.path == "file";
  const auto name = request.query.find("name");
  if ((!of_report && request.path != "picture") || name == request.query.end()) {
    return refused(404, "there is no such file");
  }
  const auto& known = of_report ? shown_.files : shown_.pictures;
  const auto found = known.find(name->second);
  if (found == known.end()) return refused(404, "the document has no such picture");
  const auto content = read_file(found->second, kMaxPictureBytes);
  if (!content) return refused(404, "the picture is not there any more");
  const auto* first = reinterpret_cast<const std::uint8_t*>(content->data());
  return {200, picture_type(found->second), "", {first, first + content->size()}};
}

}  // namespace saccade::server

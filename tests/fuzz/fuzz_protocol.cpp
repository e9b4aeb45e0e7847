// SPDX-License-Identifier: Apache-2.0
// Feeds the reader of WebSocket messages; what it reads is written and read again.
#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "server/message.hpp"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto message = saccade::server::parse_message({data, size});
  const auto question = saccade::server::parse_question({data, size});
  if (!message) {
    require(message.error().code == saccade::Errc::corrupt_data && !question);
    return 0;
  }
  require(message->head.is_object() && message->body.size() <= size);
  saccade::server::MessageWriter writer{message->head};
  writer.append(message->body);
  const auto written = std::move(writer).finish();
  const auto again = saccade::server::parse_message(*written);
  require(again && again->head == message->head);
  require(std::equal(again->body.begin(), again->body.end(), message->body.begin(), message->body.end()));
  if (!question) return 0;
  require(message->body.empty() && question->request > 0 && question->head == message->head);
  const auto answer = saccade::server::refusal(question->request, {saccade::Errc::not_found, question->type, ""});
  require(saccade::server::parse_question(*answer).ok());
  return 0;
}

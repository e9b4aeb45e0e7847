// SPDX-License-Identifier: Apache-2.0
// WebSockets between good clients and a service: order, limits, ends.
#include <algorithm>
#include <cstdlib>
#include <set>

#include "server/served_page.hpp"

namespace saccade::test {
namespace {

/// More under SACCADE_TEST_MESSAGES, say a million.
std::size_t message_count() {
  const char* const given = std::getenv("SACCADE_TEST_MESSAGES");
  return given == nullptr ? 20'000 : static_cast<std::size_t>(std::atoll(given));
}

std::string request_line(const std::string& target, const std::string& host, const std::string& headers) {
  return "GET " + target + " HTTP/1.1\r\nHost: " + host + "\r\n" + headers + "\r\n";
}

class Socket : public ServedPage {
 protected:
  void SetUp() override {
    ServedPage::SetUp();
    lets_go_ = false;
  }
  void TearDown() override {
    lets_go_ = true;
    ServedPage::TearDown();
  }
  /// Messages are kept waiting until the test lets go.
  void hold_messages() {
    service_->on_message = [this](ConnectionId from, const std::string& text) {
      while (!lets_go_) std::this_thread::sleep_for(std::chrono::milliseconds{1});
      server_->send(from, message_of(text));
    };
  }
  std::atomic<bool> lets_go_{false};
};

TEST_F(Socket, MessagesOfAllLengthsComeBackInOrder) {
  RawClient asks = socket();
  for (const std::size_t length : {0U, 1U, 125U, 126U, 65535U, 65536U, 200'000U, 1U << 20U}) {
    ASSERT_TRUE(asks.send_message(std::string(length, 'x')));
    const auto answer = asks.read_message();
    ASSERT_TRUE(answer) << length;
    EXPECT_EQ(answer->opcode, Opcode::binary);
    EXPECT_EQ(answer->payload, std::string(length, 'x'));
  }
  for (int i = 0; i < 100; ++i) asks.send_message(std::to_string(i));
  for (int i = 0; i < 100; ++i) EXPECT_EQ(asks.read_message()->payload, std::to_string(i));
}

TEST_F(Socket, FragmentsAreOneMessage) {
  RawClient asks = socket();
  asks.send(frame(Opcode::binary, "one ", false) + frame(Opcode::ping, "there?") +
            frame(Opcode::continuation, "two ", false) + frame(Opcode::continuation, "three"));
  const auto pong = asks.read_frame();
  ASSERT_TRUE(pong);
  EXPECT_EQ(pong->opcode, Opcode::pong);
  EXPECT_EQ(pong->payload, "there?");
  EXPECT_EQ(asks.read_message()->payload, "one two three");
}

TEST_F(Socket, AGoodEndIsAnswered) {
  RawClient asks = socket();
  asks.send_message("last words");
  asks.send(frame(Opcode::close, std::string{"\x03\xe8", 2}));
  EXPECT_EQ(asks.read_close_code(), 1000);
  asks.close();
  EXPECT_TRUE(eventually([this] { return service_->closed_count == 1; }));
  EXPECT_EQ(service_->received_count, 1U);
}

TEST_F(Socket, WhatWasAskedBeforeAnEndReachesTheService) {
  hold_messages();
  RawClient asks = socket();
  for (int i = 0; i < 20; ++i) asks.send_message("action");
  EXPECT_TRUE(eventually([this] { return service_->received_count == 1; }));
  asks.send(frame(Opcode::close, ""));
  EXPECT_NE(asks.read_close_code(), 0);
  asks.close();
  lets_go_ = true;
  EXPECT_TRUE(eventually([this] { return service_->closed_count == 1; }));
  EXPECT_EQ(service_->received_count, 20U);
}

TEST_F(Socket, TheServiceEndsAConnectionAfterWhatItSaid) {
  service_->on_message = [this](ConnectionId from, const std::string&) {
    server_->send(from, message_of("no"));
    server_->close(from, 1007, "cannot be read");
    server_->send(from, message_of("never sent"));
  };
  RawClient asks = socket();
  asks.send_message("a");
  asks.send_message("b");
  EXPECT_EQ(asks.read_message()->payload, "no");
  const auto end = asks.read_message();
  ASSERT_TRUE(end);
  EXPECT_EQ(end->close_code(), 1007);
  EXPECT_EQ(end->payload.substr(2), "cannot be read");
  EXPECT_FALSE(asks.read_frame(std::chrono::milliseconds{50}));
  asks.close();
  EXPECT_TRUE(eventually([this] { return service_->closed_count == 1; }));
  EXPECT_EQ(service_->received_count, 1U);
}

TEST_F(Socket, AServiceThatThrowsLosesThatConnectionOnly) {
  RawClient other = socket();
  service_->on_message = [](ConnectionId, const std::string&) { throw std::runtime_error{"broken"}; };
  RawClient asks = socket();
  asks.send_message("a");
  EXPECT_EQ(asks.read_close_code(), 1011);
  asks.close();
  EXPECT_TRUE(eventually([this] { return service_->closed_count == 1; }));
  service_->on_message = nullptr;
  other.send_message("still here");
  EXPECT_EQ(other.read_message()->payload, "still here");
}

TEST_F(Socket, EndOfTheServerIsSaid) {
  RawClient first = socket();
  RawClient second = socket();
  ASSERT_TRUE(eventually([this] { return service_->opened_count == 2; }));
  std::thread ends{[this] { server_.reset(); }};
  EXPECT_EQ(first.read_close_code(), 1001);
  EXPECT_EQ(second.read_close_code(), 1001);
  first.close();
  second.close();
  ends.join();
  EXPECT_EQ(service_->closed_count, 2);
}

TEST_F(Socket, EndOfTheServerWaitsForNobody) {
  std::vector<RawClient> silent;  // neither reads nor closes
  for (int i = 0; i < 5; ++i) silent.push_back(socket());
  RawClient half = client();
  half.send("GET / HT");
  ASSERT_TRUE(eventually([this] { return service_->opened_count == 5; }));
  const auto begin = std::chrono::steady_clock::now();
  server_.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds{5}) << "less than a request's timeout";
  EXPECT_EQ(service_->closed_count, 5);
}

TEST_F(Socket, WhatWaitsAtTheEndIsLeftUndone) {
  service_->on_message = [this](ConnectionId, const std::string&) {
    while (!lets_go_) std::this_thread::sleep_for(std::chrono::milliseconds{1});
  };
  RawClient gone = socket();
  RawClient there = socket();
  for (RawClient* const asks : {&gone, &there}) {
    for (int i = 0; i < 20; ++i) asks->send_message("action");
  }
  ASSERT_TRUE(eventually([this] { return service_->received_count == 1; }));
  std::this_thread::sleep_for(std::chrono::milliseconds{100});
  gone.reset();
  std::thread ends{[this] { server_.reset(); }};
  EXPECT_EQ(there.read_close_code(), 1001);
  lets_go_ = true;
  ends.join();
  EXPECT_EQ(service_->received_count, 1U);
  EXPECT_EQ(service_->closed_count, 2);
}

TEST_F(Socket, ConnectionsTakeTurns) {
  std::vector<std::string> served;
  service_->on_message = [&, this](ConnectionId /*from*/, const std::string& text) {
    while (!lets_go_) std::this_thread::sleep_for(std::chrono::milliseconds{1});
    served.push_back(text);
  };
  service_->on_get = [&served](const server::HttpRequest&) {
    served.emplace_back("file");
    return server::HttpAnswer{};
  };
  RawClient floods = socket();
  for (int i = 0; i < 30; ++i) floods.send_message("flood");
  ASSERT_TRUE(eventually([this] { return service_->received_count == 1; }));
  std::vector<RawClient> readers;
  for (int i = 0; i < 10; ++i) readers.push_back(client());
  for (const RawClient& reader : readers) {
    reader.send(request_line("/data/a", reader.host(), RawClient::token_line()));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds{200});
  RawClient good = socket();
  good.send_message("good");
  std::this_thread::sleep_for(std::chrono::milliseconds{200});
  lets_go_ = true;
  EXPECT_TRUE(eventually([this] { return service_->received_count == 31; }));
  for (RawClient& reader : readers) EXPECT_EQ(reader.read_answer().status, 200);
  server_.reset();
  ASSERT_EQ(served.size(), 41U);
  EXPECT_LE(std::find(served.begin(), served.end(), "good") - served.begin(), 3)
      << "a question waits for one of each other connection, and for one file";
}

TEST_F(Socket, PostedWorkIsDoneOnTheServiceThread) {
  std::set<std::thread::id> threads;
  service_->on_message = [&threads](ConnectionId, const std::string&) { threads.insert(std::this_thread::get_id()); };
  RawClient asks = socket();
  asks.send_message("a");
  EXPECT_TRUE(eventually([this] { return service_->received_count == 1; }));
  int done{0};
  for (int i = 0; i < 100; ++i) {
    server_->post([&] {
      threads.insert(std::this_thread::get_id());
      ++done;
    });
  }
  asks.close();
  server_.reset();
  EXPECT_EQ(done, 100);
  EXPECT_EQ(threads.size(), 1U);
  EXPECT_FALSE(threads.contains(std::this_thread::get_id()));
}

TEST_F(Socket, WhoAsksTooMuchIsNotReadFrom) {
  hold_messages();
  RawClient asks = socket();
  const std::string message = frame(Opcode::binary, std::string(1000, 'q'));
  const double before = resident_mib();
  std::size_t sent{0};  // whole messages and a part of one
  int idle{0};
  while (idle < 50 && sent < 64 * kMiB) {
    const std::size_t at = sent % message.size();
    const std::size_t some = asks.send_some(std::string_view{message}.substr(at));
    sent += some;
    idle = some == 0 ? idle + 1 : 0;
    if (some == 0) std::this_thread::sleep_for(std::chrono::milliseconds{2});
  }
  EXPECT_LT(sent, 32 * kMiB) << "it is the kernel's buffers that hold it";
  EXPECT_LT(resident_mib() - before, 100.0);
  RawClient other = client();
  EXPECT_EQ(other.get("/").status, 200) << "the others are served";
  lets_go_ = true;
  const std::size_t whole = sent / message.size();
  ASSERT_GT(whole, 32U);
  EXPECT_TRUE(asks.send(std::string_view{message}.substr(sent % message.size())));
  for (std::size_t i = 0; i <= whole; ++i) ASSERT_TRUE(asks.read_message()) << i << " of " << whole;
}

TEST_F(Socket, WhoAsksMoreThanItReadsIsSlowedDownAndNotEnded) {
  service_->on_message = [this](ConnectionId from, const std::string& text) {
    server::Message answer(10 * kMiB + 2, std::uint8_t{'a'});
    std::copy(text.begin(), text.end(), answer.begin());
    server_->send(from, std::make_shared<const server::Message>(std::move(answer)));
  };
  RawClient asks = socket();
  const double before = resident_mib();
  for (int i = 0; i < 15; ++i) asks.send_message(std::to_string(10 + i));
  std::this_thread::sleep_for(std::chrono::milliseconds{200});
  EXPECT_LT(resident_mib() - before, 60.0) << "of the 150 MiB that it asked for";
  for (int i = 0; i < 15; ++i) {
    const auto answer = asks.read_message();
    ASSERT_TRUE(answer);
    ASSERT_EQ(answer->payload.size(), 10 * kMiB + 2);
    EXPECT_EQ(answer->payload.substr(0, 2), std::to_string(10 + i));
  }
}

TEST_F(Socket, ManySmallMessages) {
  const std::size_t count = message_count();
  RawClient asks = socket();
  asks.send_message("warm up");
  ASSERT_TRUE(asks.read_message());
  const double before = resident_mib();
  const auto begin = std::chrono::steady_clock::now();
  std::thread sends{[&asks, count] {
    std::string batch;
    for (std::size_t i = 0; i < count; ++i) {
      batch += frame(Opcode::binary, std::to_string(i));
      if (batch.size() > 4000 || i + 1 == count) asks.send(std::exchange(batch, {}));
    }
  }};
  std::size_t in_order{0};
  while (in_order < count) {
    const auto answer = asks.read_message();
    if (!answer || answer->payload != std::to_string(in_order)) break;
    ++in_order;
  }
  sends.join();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  EXPECT_EQ(in_order, count);
  EXPECT_EQ(service_->received_count, count + 1);
  EXPECT_LT(resident_mib() - before, 100.0);
  EXPECT_LT(took.count(), 60.0);
  RecordProperty("messages_per_s", static_cast<int>(static_cast<double>(count) / took.count()));
  std::cout << count << " messages there and back in " << took.count() << " s\n";
}

}  // namespace
}  // namespace saccade::test

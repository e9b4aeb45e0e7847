// SPDX-License-Identifier: Apache-2.0
// The page, its files and the data behind it, over HTTP.
#include "server/served_page.hpp"
#include "server/web_page.hpp"
#include "support/places.hpp"

namespace saccade::test {
namespace {

using Http = ServedPage;

std::string request(const RawClient& client, const std::string& line, const std::string& headers = "") {
  return line + " HTTP/1.1\r\nHost: " + client.host() + "\r\n" + headers + "\r\n";
}

bool has_line(const Answer& answer, const std::string& line) {
  return answer.head.find("\r\n" + line + "\r\n") != std::string::npos;
}

TEST_F(Http, TheAddressGivesThePage) {
  RawClient asks = client();
  const Answer page = asks.ask(request(asks, "GET /?token=" + std::string{kToken}));
  EXPECT_EQ(page.status, 200);
  EXPECT_NE(page.body.find("<!doctype html>"), std::string::npos);
  EXPECT_EQ(page.head.find("Set-Cookie"), std::string::npos) << "browsers send cookies to every port";
  EXPECT_TRUE(has_line(page, "X-Content-Type-Options: nosniff"));
  EXPECT_TRUE(has_line(page, "Referrer-Policy: no-referrer"));
  EXPECT_TRUE(has_line(page, "Cache-Control: no-cache"));
  EXPECT_NE(page.head.find("default-src 'self'"), std::string::npos);
  EXPECT_NE(page.head.find("frame-ancestors 'none'"), std::string::npos);
  EXPECT_NE(page.head.find("ws://" + asks.host()), std::string::npos);
  const Answer again = asks.ask(request(asks, "GET /"));
  EXPECT_EQ(again.status, 200) << "the page is loaded again";
  EXPECT_EQ(again.body, page.body);
}

TEST_F(Http, AllFilesOfThePageAreGivenOut) {
  ASSERT_GE(server::page_files().size(), 3U);
  RawClient asks = client();  // one socket for all of them
  for (const server::PageFile& file : server::page_files()) {
    const Answer answer = asks.get("/" + std::string{file.path});
    EXPECT_EQ(answer.status, 200) << file.path;
    EXPECT_EQ(answer.body, (std::string{file.content.begin(), file.content.end()})) << file.path;
    EXPECT_TRUE(has_line(answer, "Content-Type: " + std::string{file.content_type})) << answer.head;
  }
}

TEST_F(Http, PageFilesAreThoseOfItsFolder) {
  for (const server::PageFile& file : server::page_files()) {
    std::ifstream read{source_folder().string() + "/web/dist/" + std::string{file.path}, std::ios::binary};
    const std::string content{std::istreambuf_iterator<char>{read}, {}};
    EXPECT_TRUE((std::string{file.content.begin(), file.content.end()}) == content) << file.path;
  }
}

TEST_F(Http, WhatTheBrowserHasIsNotSentAgain) {
  RawClient asks = client();
  const Answer first = asks.get("/");
  const std::size_t at = first.head.find("ETag: ");
  ASSERT_NE(at, std::string::npos);
  const std::string tag = first.head.substr(at + 6, first.head.find("\r\n", at) - at - 6);
  const Answer second = asks.get("/", "If-None-Match: " + tag + "\r\n");
  EXPECT_EQ(second.status, 304);
  EXPECT_EQ(second.head.find("Content-Length"), std::string::npos);
  EXPECT_EQ(asks.get("/", "If-None-Match: \"another\"\r\n").status, 200);
}

TEST_F(Http, HeadIsAnsweredWithoutABody) {
  RawClient asks = client();
  const std::size_t size = asks.get("/").body.size();
  const Answer head = asks.ask(request(asks, "HEAD /", RawClient::token_line()));
  EXPECT_EQ(head.status, 200);
  EXPECT_TRUE(has_line(head, "Content-Length: " + std::to_string(size))) << head.head;
  EXPECT_EQ(asks.get("/").status, 200) << "nothing of a body stands before it";
}

TEST_F(Http, DataComesFromTheService) {
  server::HttpRequest asked;
  service_->on_get = [&asked](const server::HttpRequest& request) {
    asked = request;
    return server::HttpAnswer{200, "image/png", "Ä \"b\"\r\n.png", {1, 2, 0, 4}};
  };
  RawClient asks = client();
  const Answer answer = asks.get("/data/picture%20one?name=a%2Fb+c&token=" + std::string{kToken} + "&x");
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.body, (std::string{"\1\2\0\4", 4}));
  EXPECT_TRUE(has_line(answer, "Content-Type: image/png"));
  EXPECT_TRUE(has_line(answer, "Cache-Control: no-store"));
  EXPECT_NE(answer.head.find("attachment; filename=\"____b___.png\"; filename*=UTF-8''%C3%84%20%22b%22%0D%0A.png\r\n"),
            std::string::npos)
      << answer.head;
  EXPECT_EQ(asked.path, "picture one");
  EXPECT_EQ(asked.query, (std::map<std::string, std::string>{{"name", "a/b c"}, {"x", ""}}));
}

TEST_F(Http, LargeDataArrives) {
  service_->on_get = [](const server::HttpRequest&) {
    return server::HttpAnswer{200, "text/plain", "", std::vector<std::uint8_t>(32U << 20U, 7)};
  };
  RawClient asks = client();
  EXPECT_EQ(asks.get("/data/a").body.size(), 32U << 20U);
  EXPECT_EQ(asks.get("/data/a").body, std::string(32U << 20U, 7)) << "on the same socket";
}

TEST_F(Http, ServiceThatThrowsIsAnError) {
  service_->on_get = [](const server::HttpRequest&) -> server::HttpAnswer { throw std::runtime_error{"broken"}; };
  RawClient asks = client();
  EXPECT_EQ(asks.get("/data/a").status, 500);
  expect_that_a_good_client_is_answered();
}

TEST_F(Http, FilesCountUntilTheyAreRead) {
  server_.reset();
  server::ServerConfig patient = config();
  patient.request_timeout = std::chrono::minutes{2};  // all files wait while the last of them is made
  begin(patient);
  server_->serve(*service_);
  constexpr std::size_t kMostFiles{16};
  std::atomic<std::size_t> made{0};
  service_->on_get = [&made](const server::HttpRequest&) {
    ++made;
    return server::HttpAnswer{200, "text/plain", "", std::vector<std::uint8_t>(16 * kMiB, 7)};
  };
  std::vector<RawClient> silent;
  for (std::size_t i = 0; i < kMostFiles; ++i) {
    silent.push_back(client(4096));
    silent.back().send(request(silent.back(), "GET /data/a", RawClient::token_line()));
  }
  ASSERT_TRUE(eventually([&made] { return made == kMostFiles; }));
  EXPECT_EQ(client().get("/data/b").status, 503);
  silent.clear();
  EXPECT_TRUE(eventually([this] { return client().get("/data/c").status == 200; }));
  EXPECT_EQ(made, kMostFiles + 1);
}

TEST_F(Http, AnEndWaitsForTheServiceAndNotForTheAnswer) {
  std::atomic<bool> begun{false};
  service_->on_get = [&begun](const server::HttpRequest&) {
    begun = true;
    std::this_thread::sleep_for(std::chrono::milliseconds{100});
    return server::HttpAnswer{200, "text/plain", "", std::vector<std::uint8_t>(kMiB, 7)};
  };
  RawClient asks = client();
  asks.send(request(asks, "GET /data/a", RawClient::token_line()));
  ASSERT_TRUE(eventually([&begun] { return begun.load(); }));
  server_.reset();
  EXPECT_EQ(asks.read_answer().status, 0);
}

TEST_F(Http, OtherMethodsAndPathsAreRefused) {
  for (const std::string method : {"POST", "PUT", "DELETE", "OPTIONS", "TRACE", "CONNECT", "PATCH", "BREW"}) {
    RawClient asks = client();
    const Answer answer = asks.ask(request(asks, method + " /", RawClient::token_line()));
    EXPECT_EQ(answer.status, 405) << method;
    EXPECT_TRUE(has_line(answer, "Allow: GET, HEAD"));
  }
  EXPECT_EQ(client().get("/assets/none.js").status, 404);
  EXPECT_EQ(client().get("/none").status, 404);
  EXPECT_EQ(client().get("/socket").status, 426);
  EXPECT_EQ(client().get("/data/none").status, 404);
}

TEST_F(Http, TwoQuestionsAtOnceAreAnsweredInOrder) {
  RawClient asks = client();
  const std::string headers = RawClient::token_line();
  asks.send(request(asks, "GET /", headers) + request(asks, "GET /assets/index.js", headers));
  EXPECT_NE(asks.read_answer().body.find("<!doctype html>"), std::string::npos);
  EXPECT_NE(asks.read_answer().head.find("text/javascript"), std::string::npos);
}

TEST_F(Http, ThePageIsThereBeforeTheService) {
  server_.reset();
  begin(config());
  EXPECT_EQ(client().get("/").status, 200);
  const Answer data = client().get("/data/a");
  EXPECT_EQ(data.status, 503);
  EXPECT_TRUE(has_line(data, "Retry-After: 1"));
  EXPECT_EQ(client().upgrade(), 503);
  server_->serve(*service_);
  expect_that_a_good_client_is_answered();
}

TEST(HttpServer, ItsAddressSaysHowToReachIt) {
  server::ServerConfig config;
  config.token = server::make_token();
  EXPECT_EQ(config.token.size(), 32U);
  EXPECT_NE(config.token, server::make_token());
  auto first = server::HttpServer::listen(config);
  ASSERT_TRUE(first);
  EXPECT_EQ((*first)->url(), "http://localhost:" + std::to_string((*first)->port()) + "/?token=" + config.token);
  config.port = (*first)->port();
  const auto second = server::HttpServer::listen(config);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Errc::unavailable);
  EXPECT_NE(second.error().to_string().find("port is taken"), std::string::npos);
  first->reset();
  EXPECT_TRUE(server::HttpServer::listen(config)) << "the port is free again";
}

TEST(HttpServer, WrongConfigurationsAreRefused) {
  const auto refused = [](const auto& change) {
    server::ServerConfig config;
    config.token = kToken;
    change(config);
    const auto made = server::HttpServer::listen(config);
    return made ? std::optional<Errc>{} : made.error().code;
  };
  using Config = server::ServerConfig;
  EXPECT_FALSE(refused([](Config&) {}));
  EXPECT_EQ(refused([](Config& config) { config.token = "short"; }), Errc::invalid_argument);
  EXPECT_EQ(refused([](Config& config) { config.token = "letters, digits, - and _ alone"; }), Errc::invalid_argument);
  EXPECT_EQ(refused([](Config& config) { config.address = "nowhere"; }), Errc::invalid_argument);
  EXPECT_EQ(refused([](Config& config) { config.address = "192.0.2.1"; }), Errc::unavailable);
  EXPECT_EQ(refused([](Config& config) { config.host_names = {"a/b"}; }), Errc::invalid_argument);
  EXPECT_EQ(refused([](Config& config) { config.max_connections = 0; }), Errc::invalid_argument);
}

}  // namespace
}  // namespace saccade::test

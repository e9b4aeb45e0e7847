// SPDX-License-Identifier: Apache-2.0
// Those who mean no good, or whose network does not: each is refused or bounded, and a good client is served after it.
#include <algorithm>

#include "server/served_page.hpp"

namespace saccade::test {
namespace {

constexpr int kInvalidFrame{1002};
constexpr std::chrono::milliseconds kSoon{400};  ///< too soon for a good client on a busy machine

server::SharedMessage a_mebibyte() { return std::make_shared<const server::Message>(kMiB, std::uint8_t{'a'}); }

class Hostile : public ServedPage {
 protected:
  void SetUp() override {
    serve({});
    before_mib_ = resident_mib();
  }
  struct Patience {
    std::chrono::milliseconds request{server::ServerConfig{}.request_timeout};
    std::chrono::milliseconds idle{server::ServerConfig{}.idle_timeout};
  };
  void serve(const Patience& patience) {
    server_.reset();
    server::ServerConfig made = config();
    made.host_names = {"Lab-7.example"};
    made.request_timeout = patience.request;
    made.idle_timeout = patience.idle;
    begin(made);
    server_->serve(*service_);
  }
  void TearDown() override {
    expect_that_a_good_client_is_answered();
    EXPECT_LT(resident_mib() - before_mib_, 150.0);
    ServedPage::TearDown();
  }
  [[nodiscard]] static std::string shown(std::string_view token = kToken) { return RawClient::token_line(token); }
  [[nodiscard]] std::string port() const { return ":" + std::to_string(server_->port()); }
  /// The header line with which a page shows the token.
  [[nodiscard]] static std::string offered(std::string_view token) {
    return "Sec-WebSocket-Protocol: saccade.v1, saccade.token." + std::string{token} + "\r\n";
  }
  /// Returns the status for a complete head of headers.
  [[nodiscard]] int status_of(const std::string& target, const std::string& headers) const {
    return client().ask("GET " + target + " HTTP/1.1\r\n" + headers + "\r\n").status;
  }
  [[nodiscard]] int upgrade_status(const std::string& headers) const {
    RawClient asks = client();
    return asks.ask(asks.upgrade_request(headers)).status;
  }

  double before_mib_{0.0};
};

TEST_F(Hostile, WithoutTheTokenThereIsNothing) {
  const std::string host = "Host: localhost" + port() + "\r\n";
  const std::string token{kToken};
  std::string other{token};
  other.back() = '!';
  for (const std::string& wrong : {std::string{"x"}, token.substr(1), token + "x", token + token, other}) {
    EXPECT_EQ(status_of("/", host + shown(wrong)), 403) << wrong;
    EXPECT_EQ(status_of("/?token=" + wrong, host), 403) << wrong;
    EXPECT_EQ(status_of("/data/labels", host + shown(wrong)), 403) << wrong;
    EXPECT_EQ(upgrade_status(host + shown(wrong)), 403) << wrong;
    EXPECT_EQ(upgrade_status(host + offered(wrong)), 403) << wrong;
  }
  const std::string cookies = "Cookie: token=" + token + "; saccade_" + port().substr(1) + "=" + token + "\r\n";
  for (const std::string& none : {std::string{}, shown(""), offered(""), cookies}) {
    EXPECT_EQ(status_of("/data/labels", host + none), 403) << none;
    EXPECT_EQ(upgrade_status(host + none), 403) << none;
  }
  EXPECT_EQ(status_of("/data/labels", host + shown()), 404);
  EXPECT_EQ(status_of("/data/labels?token=" + token, host), 404);
  EXPECT_EQ(upgrade_status(host + shown()), 101);
  EXPECT_EQ(upgrade_status(host + offered(token)), 101);
}

TEST_F(Hostile, PageFilesAreNoSecret) {
  const std::string host = "Host: localhost" + port() + "\r\n";
  for (const std::string target : {"/", "/index.html", "/report.html", "/assets/index.js"}) {
    RawClient asks = client();
    const Answer answer = asks.ask("GET " + target + " HTTP/1.1\r\n" + host + "\r\n");
    EXPECT_EQ(answer.status, 200) << target;
    EXPECT_EQ(answer.head.find("Set-Cookie"), std::string::npos) << target;
    EXPECT_EQ((answer.head + answer.body).find(kToken), std::string::npos) << target;
  }
}

TEST_F(Hostile, SocketsWithoutTheTokenGiveWay) {
  constexpr std::size_t kMany{400};  // more than three times the table
  RawClient page = socket();
  RawClient loads = client();
  EXPECT_EQ(loads.get("/").status, 200);
  std::vector<RawClient> silent;
  for (std::size_t i = 0; i < kMany; ++i) {
    silent.push_back(client());
    if (i % 3 == 1) silent.back().send("GET / HT");
    if (i % 3 == 2) silent.back().send("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
  }
  expect_that_a_good_client_is_answered();
  EXPECT_EQ(loads.get("/assets/index.js").status, 200) << "it has shown the token";
  page.send_message("still here");
  const auto echoed = page.read_message();
  ASSERT_TRUE(echoed);
  EXPECT_EQ(echoed->payload, "still here");
  EXPECT_TRUE(eventually([&silent] {
    return std::count_if(silent.begin(), silent.end(), [](RawClient& one) { return one.is_ended(); }) > 250;
  })) << "the oldest are ended";
  EXPECT_FALSE(silent.back().is_ended()) << "the latest is not";
}

TEST_F(Hostile, SocketsWithTheTokenDoNotGiveWay) {
  std::vector<RawClient> good;
  for (int i = 0; i < 128; ++i) {
    good.push_back(client());
    ASSERT_EQ(good.back().get("/").status, 200);
  }
  EXPECT_EQ(client().get("/").status, 0) << "there is no room";
  for (RawClient& one : good) EXPECT_EQ(one.get("/").status, 200);
  good.clear();
  EXPECT_TRUE(eventually([this] { return client().get("/").status == 200; }));
}

TEST_F(Hostile, ForeignHostsAreRefused) {
  for (const std::string host :
       {"evil.example", "localhost.evil.example", "evil.example#localhost", "localhost@evil.example", "127.0.0.2",
        "0.0.0.0", "[::]", "[::1", "localhost:80:80", "localhost:x", "", " ", "lab-8.example"}) {
    EXPECT_EQ(status_of("/", "Host: " + host + "\r\n" + shown()), 403) << host;
    EXPECT_EQ(status_of("/assets/index.js", "Host: " + host + "\r\n"), 403) << host;
    EXPECT_EQ(upgrade_status("Host: " + host + "\r\n" + shown()), 403) << host;
  }
  EXPECT_EQ(status_of("/", shown()), 403) << "none at all";
  EXPECT_EQ(status_of("/", "Host: localhost\r\nHost: localhost\r\n" + shown()), 403) << "two of them";
  for (const std::string host : {"localhost:1", "LOCALHOST", "127.0.0.1:80", "[::1]:8080", "lab-7.example:99"}) {
    EXPECT_EQ(status_of("/", "Host: " + host + "\r\n" + shown()), 200) << host;
  }
}

TEST_F(Hostile, ForeignOriginsAreRefused) {
  const std::string headers = "Host: localhost" + port() + "\r\n" + shown();
  for (const std::string origin : {"http://evil.example", "null", "http://localhost", "http://localhost:1",
                                   "http://localhost.evil.example", "ftp://localhost", "", "file://"}) {
    EXPECT_EQ(upgrade_status(headers + "Origin: " + origin + "\r\n"), 403) << origin;
    EXPECT_EQ(status_of("/data/a", headers + "Origin: " + origin + "\r\n"), 403) << origin;
  }
  EXPECT_EQ(upgrade_status(headers + "Origin: http://127.0.0.1" + port() + "\r\n"), 403) << "another name";
  EXPECT_EQ(upgrade_status(headers + "Origin: http://localhost" + port() + "\r\nOrigin: null\r\n"), 403);
  EXPECT_EQ(upgrade_status(headers + "Origin: http://localhost" + port() + "\r\n"), 101);
  for (const std::string site : {"cross-site", "same-site"}) {
    EXPECT_EQ(status_of("/data/a", headers + "Sec-Fetch-Site: " + site + "\r\n"), 403) << site;
    EXPECT_EQ(upgrade_status(headers + "Sec-Fetch-Site: " + site + "\r\n"), 403) << site;
  }
  EXPECT_EQ(status_of("/data/a", headers + "Sec-Fetch-Site: same-origin\r\n"), 404);
}

TEST_F(Hostile, NoPathLeadsOut) {
  using namespace std::string_literals;
  const std::string headers = "Host: localhost" + port() + "\r\n" + shown();
  for (const std::string& target :
       {"/assets/../index.html"s, "/../../etc/passwd"s, "/assets/%2e%2e/%2e%2e/etc/passwd"s, "/assets/..%2findex.html"s,
        "/assets/....//etc/passwd"s, "//etc/passwd"s, "/assets//index.js"s, "/assets/"s, "/assets\\..\\index.html"s,
        "/proc/self/environ"s, "/%5c..%5c"s, "/index.html/"s}) {
    EXPECT_EQ(status_of(target, headers), 404) << target;
  }
  for (const std::string& target : {"/assets/index.js%00.png"s, "/%"s, "/%g0"s, "/%1"s, "/data/%0d%0aSet-Cookie:x"s,
                                    "http://localhost/"s, "*"s, "/?a=%zz"s, "/data/\x7f"s}) {
    EXPECT_EQ(status_of(target, headers), 400) << target;
  }
  EXPECT_EQ(status_of("/assets/index.js\0.png"s, headers), 400);
}

TEST_F(Hostile, WhatIsNoRequestIsRefused) {
  using namespace std::string_literals;
  for (const std::string& bytes : {"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03 hello of TLS\r\n\r\n"s,
                                   "GET /\r\n\r\n"s, "GET / HTTP/9.9\r\n\r\n"s, "GET / HTTP/1.1\r\nno colon\r\n\r\n"s,
                                   "GET / HTTP/1.1\r\nContent-Length: -1\r\n\r\n"s,
                                   "GET / HTTP/1.1\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\n"s,
                                   "\0\0\0\0\r\n\r\n"s, "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"s}) {
    EXPECT_EQ(client().ask(bytes).status, 400) << bytes;
  }
  RawClient gone = client();
  gone.send("GET / HTTP/1.1\r\nHo");
  gone.reset();
}

TEST_F(Hostile, LongHeadersAndBodiesAreRefused) {
  const std::string start = "GET / HTTP/1.1\r\nHost: localhost\r\n" + shown();
  EXPECT_EQ(client().ask(start + "X: " + std::string(17U << 10U, 'a') + "\r\n\r\n").status, 431);
  std::string many = start;
  while (many.size() < (20U << 10U)) many += "A: b\r\n";
  EXPECT_EQ(client().ask(many + "\r\n").status, 431);
  EXPECT_EQ(client().ask("GET /" + std::string(17U << 10U, 'a') + " HTTP/1.1\r\n\r\n").status, 431);
  EXPECT_EQ(client().ask(start + "Content-Length: 5\r\n\r\nhello").status, 413);
  EXPECT_EQ(client().ask(start + "Content-Length: 99999999999\r\n\r\n").status, 413);
  EXPECT_EQ(client().ask(start + "Transfer-Encoding: chunked\r\n\r\n5\r\nhello\r\n0\r\n\r\n").status, 413);
  EXPECT_EQ(
      client().ask("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9\r\n\r\n" + std::string(9, 'a')).status,
      405);
}

TEST_F(Hostile, HalfARequestIsNotWaitedFor) {
  serve({.request = kSoon});
  RawClient slow = client();
  const auto begin = std::chrono::steady_clock::now();
  slow.send("GET / HTTP/1.1\r\n");
  std::thread drips{[&slow] {
    for (int i = 0; i < 12 && slow.send("A: b\r\n"); ++i) std::this_thread::sleep_for(std::chrono::milliseconds{100});
  }};
  EXPECT_FALSE(slow.receive(std::chrono::seconds{3}));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds{2});
  drips.join();
  RawClient silent = client();
  EXPECT_FALSE(silent.receive(std::chrono::seconds{3}));
  RawClient half = client();  // sends half a handshake
  half.send(half.upgrade_request("Host: localhost\r\n").substr(0, 60));
  EXPECT_FALSE(half.receive(std::chrono::seconds{3}));
}

TEST_F(Hostile, WrongFramesEndTheConnection) {
  using namespace std::string_literals;
  struct Case {
    std::string bytes;
    int code;
  };
  const std::vector<Case> cases{
      {frame(Opcode::binary, "unmasked", true, false), kInvalidFrame},
      {frame(Opcode::text, "{}"), 1003},
      {frame(Opcode::text, "\xff\xfe"), 1007},
      {frame(static_cast<Opcode>(3), "reserved"), kInvalidFrame},
      {frame(static_cast<Opcode>(11), "reserved"), kInvalidFrame},
      {frame(Opcode::continuation, "of nothing"), kInvalidFrame},
      {frame(Opcode::binary, "a", false) + frame(Opcode::binary, "b"), kInvalidFrame},
      {frame(Opcode::ping, std::string(126, 'p')), kInvalidFrame},
      {frame(Opcode::ping, "in parts", false), kInvalidFrame},
      {"\xc2\x80\0\0\0\0"s, kInvalidFrame},  // says that it is compressed
      {frame(Opcode::close, "\x03"s), kInvalidFrame},
      {frame(Opcode::close, "\x00\x01"s), kInvalidFrame},
      {"\x82\xfe\x00\x05\0\0\0\0hello"s, kInvalidFrame},  // a length written longer than it need be
      {"\x82\xff\xff\xff\xff\xff\xff\xff\xff\xff\0\0\0\0"s, 1009},
      {"\x82\xff\x00\x00\x00\x01\x00\x00\x00\x00\0\0\0\0"s, 1009},
      {frame(Opcode::binary, std::string(kMiB + 1, 'a')), 1009},
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    RawClient asks = socket();
    asks.send(cases[i].bytes);
    EXPECT_EQ(asks.read_close_code(), cases[i].code) << "case " << i;
  }
  EXPECT_EQ(service_->received_count, 0U);
}

TEST_F(Hostile, FragmentsDoNotAddUp) {
  RawClient asks = socket();
  asks.send(frame(Opcode::binary, "", false));
  const std::string part = frame(Opcode::continuation, std::string(1000, 'a'), false);
  int sent{0};
  while (sent < 3000 && asks.send(part)) ++sent;
  EXPECT_EQ(asks.read_close_code() == 1009 || sent < 3000, true);
  RawClient floods = socket();  // parts of nothing, for ever
  std::string empty = frame(Opcode::binary, "", false);
  for (int i = 0; i < 1000; ++i) empty += frame(Opcode::continuation, "", false);
  for (int i = 0; i < 200; ++i) floods.send(empty.substr(i == 0 ? 0 : 6));
  expect_that_a_good_client_is_answered();
  EXPECT_EQ(service_->received_count, 1U);
}

TEST_F(Hostile, PingsAreAnsweredAsFarAsTheyAreRead) {
  RawClient asks = socket(4 << 10);
  std::string pings;
  for (int i = 0; i < 500; ++i) pings += frame(Opcode::ping, std::string(100, 'p'));
  std::size_t sent{0};
  int idle{0};
  while (idle < 50 && sent < 100 * kMiB) {
    const std::size_t some = asks.send_some(std::string_view{pings}.substr(sent % pings.size()));
    sent += some;
    idle = some == 0 ? idle + 1 : 0;
    if (some == 0) std::this_thread::sleep_for(std::chrono::milliseconds{2});
  }
  EXPECT_LT(sent, 64 * kMiB) << "who does not read pongs is not read from";
  expect_that_a_good_client_is_answered();
}

TEST_F(Hostile, WhoNeverReadsIsEnded) {
  serve({.request = kSoon});
  RawClient silent = socket(64 << 10);
  std::atomic<ConnectionId> slow{0};
  service_->on_message = [&slow](ConnectionId from, const std::string&) { slow = from; };
  silent.send_message("it is me");
  ASSERT_TRUE(eventually([&slow] { return slow != 0; }));
  const double before = resident_mib();
  std::atomic<double> most{0.0};
  server_->post([this, &slow, &most, before] {
    for (int i = 0; i < 200; ++i) {
      server_->send(slow, a_mebibyte());
      most = std::max(most.load(), resident_mib() - before);
    }
  });
  EXPECT_TRUE(eventually([this] { return service_->closed_count == 1; }));
  EXPECT_LT(most.load(), 90.0) << "of 200";
  expect_that_a_good_client_is_answered();
}

TEST_F(Hostile, WhoReadsTooLateIsToldWhy) {
  RawClient late = socket();
  std::atomic<bool> told{false};
  service_->on_message = [this, &told](ConnectionId from, const std::string&) {
    for (int i = 0; i < 100; ++i) server_->send(from, a_mebibyte());
    told = true;
  };
  late.send_message("go");
  ASSERT_TRUE(eventually([&told] { return told.load(); }));
  EXPECT_EQ(late.read_close_code(), 1008);
}

TEST_F(Hostile, WhoAnswersNoPingIsEnded) {
  serve({.idle = std::chrono::milliseconds{800}});
  const RawClient silent = socket();
  EXPECT_TRUE(eventually([this] { return service_->closed_count == 1; }));
  RawClient alive = socket();
  int pings{0};
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds{2000};
  while (std::chrono::steady_clock::now() < end) {
    const auto read = alive.read_frame(std::chrono::milliseconds{1000});
    ASSERT_TRUE(read) << "after " << pings;
    ASSERT_EQ(read->opcode, Opcode::ping);
    ++pings;
    alive.send(frame(Opcode::pong, read->payload));
  }
  EXPECT_GE(pings, 3);
  alive.send_message("still here");
  EXPECT_EQ(alive.read_message()->payload, "still here");
}

TEST_F(Hostile, AMessageByteByByteArrives) {
  RawClient slow = socket();
  for (const char byte : frame(Opcode::binary, "slowly")) {
    slow.send(std::string_view{&byte, 1});
    std::this_thread::sleep_for(std::chrono::milliseconds{2});
  }
  EXPECT_EQ(slow.read_message()->payload, "slowly");
}

TEST_F(Hostile, AHundredConnectionsAtOnce) {
  std::vector<RawClient> clients;
  for (int i = 0; i < 100; ++i) clients.push_back(client());
  std::vector<std::thread> threads;
  std::vector<int> statuses(clients.size());
  for (std::size_t i = 0; i < clients.size(); ++i) {
    threads.emplace_back([&, i] { statuses[i] = clients[i].upgrade(); });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(std::count(statuses.begin(), statuses.end(), 101), 64);
  EXPECT_EQ(std::count(statuses.begin(), statuses.end(), 503), 36);
  EXPECT_TRUE(eventually([this] { return service_->opened_count == 64; }));
  clients.clear();
  EXPECT_TRUE(eventually([this] { return service_->closed_count == 64; }));
}

TEST_F(Hostile, SocketsWithoutARequestAreBounded) {
  serve({.request = kSoon});
  std::vector<RawClient> clients;
  for (int i = 0; i < 500; ++i) clients.push_back(client());
  EXPECT_TRUE(eventually([&clients] { return !clients.back().receive(std::chrono::milliseconds{10}); }));
  std::this_thread::sleep_for(std::chrono::milliseconds{600});  // the others' time is over, too
}

TEST_F(Hostile, BrokenConnectionsHarmNobody) {
  RawClient good = socket();
  for (int i = 0; i < 50; ++i) {
    RawClient broken = socket();
    for (int message = 0; message < 20; ++message) broken.send_message(std::string(10'000, 'a'));
    if (i % 2 == 0) broken.send(frame(Opcode::binary, "cut short").substr(0, 8));
    broken.reset();
  }
  good.send_message("unharmed");
  EXPECT_EQ(good.read_message()->payload, "unharmed");
  EXPECT_TRUE(eventually([this] { return service_->closed_count == 50; }));
}

}  // namespace
}  // namespace saccade::test

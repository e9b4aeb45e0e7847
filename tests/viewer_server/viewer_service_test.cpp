// SPDX-License-Identifier: Apache-2.0
// The viewer's answers, to pages that ask as they should and to others.
#include "server/show/viewer_service.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <thread>

#include "saccade/io/files/json_io.hpp"
#include "server/service_thread.hpp"
#include "support/temp_folder.hpp"
#include "viewer_server/asked.hpp"

namespace saccade::test {
namespace {

using nlohmann::json;
using namespace server;

TriangleMesh two_triangles() {
  TriangleMesh mesh;
  mesh.vertices = {{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, {0.0F, 0.0F, 1.0F}};
  mesh.colors = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

SceneDocument some_document(const std::filesystem::path& picture) {
  SceneDocument document;
  document.title = "two triangles";
  document.facts = {{"colour", "red"}};
  document.layers = {triangles_layer("mesh", "Mesh", two_triangles())};
  const std::vector<Pose> poses{look_at({1.0, 0.0, 0.5}, {0.0, 0.0, 0.0}), look_at({0.0, 1.0, 0.5}, {0.0, 0.0, 0.0})};
  const std::vector<double> gains{12.0, std::nan("")};
  document.layers.push_back(views_layer("candidates", "Candidates", poses, gains, {1.0, 0.75}));
  document.layers.back().step = 0;
  document.steps = {{"View 1", poses[0], {1.0, 0.75}, {{"gain", "12"}}, {{"seen.png", "Seen", picture}}}};
  return document;
}

class ViewerServiceTest : public ::testing::Test {
 protected:
  ViewerServiceTest()
      : picture_{folder_.write("seen.png", "not quite a picture")},
        service_{clients_,
                 {"1.2.3", [this](std::function<void()> work) { posted_.push_back(std::move(work)); }},
                 some_document(picture_)} {
    service_.opened(7);
  }

  SaidMessage ask(json head, ConnectionId who = 7) {
    head["request"] = ++request_;
    service_.received(who, question_of(head));
    const std::vector<SaidMessage> said = clients_.take(who);
    EXPECT_EQ(said.size(), 1U);
    if (said.size() != 1) return {json::object(), {}};
    EXPECT_EQ(said[0].head.value("request", 0U), request_);
    EXPECT_EQ(said[0].head.value("type", ""), "answer");
    return said[0];
  }
  std::string refusal_code(const json& head) {
    const SaidMessage said = ask(head);
    EXPECT_FALSE(said.head.value("ok", true)) << said.head;
    EXPECT_TRUE(said.body.empty());
    return said.head.contains("error") ? said.head["error"].value("code", "") : "";
  }
  json document() { return ask({{"type", "document"}}).head.at("document"); }
  void run_posted() {
    for (const auto& work : std::exchange(posted_, {})) work();
  }

  TempFolder folder_;
  std::filesystem::path picture_;
  RecordedClients clients_;
  std::vector<std::function<void()>> posted_;
  ViewerService service_;
  std::uint64_t request_{0};
};

TEST_F(ViewerServiceTest, Greets) {
  const SaidMessage hello = ask({{"type", "hello"}, {"protocol", 1}, {"client", 3}});
  EXPECT_TRUE(hello.head.at("ok"));
  EXPECT_EQ(hello.head.at("mode"), "show");
  EXPECT_EQ(hello.head.at("version"), "1.2.3");
  EXPECT_EQ(hello.head.at("title"), "two triangles");
  EXPECT_EQ(hello.head.at("document"), 1);
  EXPECT_EQ(refusal_code({{"type", "hello"}, {"protocol", 2}, {"client", 3}}), "unsupported");
  EXPECT_EQ(refusal_code({{"type", "hello"}}), "invalid argument");
}

TEST_F(ViewerServiceTest, GivesTheDocumentAndItsBuffers) {
  const json shown = document();
  EXPECT_EQ(shown.at("kind"), "mesh");
  EXPECT_EQ(shown.at("facts"), json::parse(R"([["colour", "red"]])"));
  ASSERT_EQ(shown.at("layers").size(), 2U);
  const json& mesh = shown["layers"][0];
  EXPECT_EQ(mesh.at("kind"), "triangles");
  EXPECT_EQ(mesh.at("count"), 2);
  EXPECT_EQ(mesh.at("vertices"), 4);
  EXPECT_TRUE(mesh.at("colors"));
  EXPECT_FALSE(mesh.contains("step"));
  const SaidMessage buffer = ask({{"type", "buffer"}, {"name", mesh["buffer"]}, {"from", 0}, {"bytes", 4194304}});
  ASSERT_EQ(buffer.body.size(), 4U * 12 + 4 * 4 + 2 * 12);
  EXPECT_EQ(buffer.head.at("total"), buffer.body.size());
  std::array<float, 12> vertices{};
  std::memcpy(vertices.data(), buffer.body.data(), sizeof vertices);
  EXPECT_EQ(vertices[3], 1.0F);
  EXPECT_EQ((std::vector<std::uint8_t>{buffer.body.begin() + 48, buffer.body.begin() + 56}),
            (std::vector<std::uint8_t>{1, 2, 3, 255, 4, 5, 6, 255}));
  std::array<std::uint32_t, 6> corners{};
  std::memcpy(corners.data(), buffer.body.data() + 64, sizeof corners);
  EXPECT_EQ(corners, (std::array<std::uint32_t, 6>{0, 1, 2, 0, 2, 3}));

  const json& views = shown["layers"][1];
  EXPECT_EQ(views.at("step"), 0);
  EXPECT_EQ(views.at("fov_rad"), json::parse("[1.0, 0.75]"));
  const SaidMessage poses = ask({{"type", "buffer"}, {"name", views["buffer"]}, {"from", 0}, {"bytes", 1000}});
  ASSERT_EQ(poses.body.size(), 2U * 17 * 4);
  std::array<float, 34> numbers{};
  std::memcpy(numbers.data(), poses.body.data(), sizeof numbers);
  EXPECT_EQ(numbers[3], 1.0F);  // x of the first pose
  EXPECT_EQ(numbers[32], 12.0F);
  EXPECT_TRUE(std::isnan(numbers[33]));
  EXPECT_EQ(shown["steps"][0].at("pictures"), json::parse(R"([{"name": "seen.png", "title": "Seen"}])"));
}

TEST_F(ViewerServiceTest, GivesBuffersInPieces) {
  const json name = document()["layers"][0]["buffer"];
  const std::vector<std::uint8_t> whole =
      ask({{"type", "buffer"}, {"name", name}, {"from", 0}, {"bytes", 4194304}}).body;
  std::vector<std::uint8_t> joined;
  while (joined.size() < whole.size()) {
    const SaidMessage piece = ask({{"type", "buffer"}, {"name", name}, {"from", joined.size()}, {"bytes", 7}});
    ASSERT_TRUE(piece.head.value("ok", false));
    EXPECT_EQ(piece.head.at("from"), joined.size());
    ASSERT_FALSE(piece.body.empty());
    joined.insert(joined.end(), piece.body.begin(), piece.body.end());
  }
  EXPECT_EQ(joined, whole);
  const SaidMessage end = ask({{"type", "buffer"}, {"name", name}, {"from", whole.size()}, {"bytes", 7}});
  EXPECT_TRUE(end.head.at("ok"));
  EXPECT_TRUE(end.body.empty());
}

TEST_F(ViewerServiceTest, RefusesWhatMakesNoSense) {
  const json name = document()["layers"][0]["buffer"];
  const auto buffer = [&](const json& from, const json& bytes) {
    return json{{"type", "buffer"}, {"name", name}, {"from", from}, {"bytes", bytes}};
  };
  EXPECT_EQ(refusal_code(buffer(89, 1)), "invalid argument");
  EXPECT_EQ(refusal_code(buffer(18446744073709551615ULL, 4194304)), "invalid argument");
  EXPECT_EQ(refusal_code(buffer(0, 4194305)), "invalid argument");
  EXPECT_EQ(refusal_code(buffer(0, 18446744073709551615ULL)), "invalid argument");
  EXPECT_EQ(refusal_code(buffer(-1, 1)), "invalid argument");
  EXPECT_EQ(refusal_code(buffer(0.5, 1)), "invalid argument");
  EXPECT_EQ(refusal_code(buffer("0", 1)), "invalid argument");
  EXPECT_EQ(refusal_code({{"type", "buffer"}, {"name", name}, {"from", 0}}), "invalid argument");
  EXPECT_EQ(refusal_code({{"type", "buffer"}, {"name", 7}, {"from", 0}, {"bytes", 1}}), "invalid argument");
  for (const char* other : {"", "../../etc/passwd", "seen.png", "0000000000000000-88"}) {
    EXPECT_EQ(refusal_code({{"type", "buffer"}, {"name", other}, {"from", 0}, {"bytes", 1}}), "not found") << other;
  }
  EXPECT_EQ(refusal_code({{"type", "action"}}), "invalid argument");
  EXPECT_TRUE(ask(buffer(0, 1)).head.at("ok"));  // all is as it was
}

TEST_F(ViewerServiceTest, ClosesWhatCannotBeRead) {
  service_.received(7, std::vector<std::uint8_t>{1, 2});
  EXPECT_EQ(clients_.closed_with(7), 1007);
  service_.opened(8);
  service_.received(8, question_of({{"type", "document"}}));  // no request
  EXPECT_EQ(clients_.closed_with(8), 1007);
  EXPECT_TRUE(clients_.take(7).empty());
  EXPECT_TRUE(clients_.take(8).empty());
  EXPECT_TRUE(ask({{"type", "document"}}, 9).head.at("ok"));
}

TEST_F(ViewerServiceTest, TellsThoseWhoGreetedOfAnotherDocument) {
  ask({{"type", "hello"}, {"protocol", 1}, {"client", 3}}, 7);
  ask({{"type", "hello"}, {"protocol", 1}, {"client", 4}}, 8);
  service_.opened(9);
  service_.closed(8);
  const json before = document();
  SceneDocument next = some_document(picture_);
  next.title = "another";
  TriangleMesh moved = two_triangles();
  moved.vertices[0].x() = -1.0F;
  next.layers[0] = triangles_layer("mesh", "Mesh", moved);
  service_.update(next);
  EXPECT_TRUE(clients_.take(7).empty());  // nothing happens but on the service's thread
  EXPECT_EQ(document(), before);
  run_posted();
  const std::vector<SaidMessage> told = clients_.take(7);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].head, json::parse(R"({"type": "document", "revision": 2})"));
  EXPECT_TRUE(clients_.take(8).empty());
  EXPECT_TRUE(clients_.take(9).empty());
  const json after = document();
  EXPECT_EQ(after["title"], "another");
  EXPECT_NE(after["layers"][0]["buffer"], before["layers"][0]["buffer"]);
  EXPECT_EQ(after["layers"][1]["buffer"], before["layers"][1]["buffer"]);  // the same content
  // Clients may finish reading the previous document, but not the one before.
  const json old{{"type", "buffer"}, {"name", before["layers"][0]["buffer"]}, {"from", 0}, {"bytes", 100}};
  EXPECT_TRUE(ask(old).head.at("ok"));
  service_.update(some_document(picture_));
  service_.update(some_document(picture_));
  run_posted();
  EXPECT_EQ(clients_.take(7).size(), 2U);
}

TEST_F(ViewerServiceTest, OtherThreadsBringDocuments) {
  constexpr int kEach{100};
  server::ServiceThread thread;
  RecordedClients clients;
  ViewerService service{
      clients, {"1", [&thread](auto work) { thread.post(std::move(work)); }}, some_document(picture_)};
  thread.post([&] { service.received(1, question_of({{"type", "hello"}, {"request", 1}, {"protocol", 1}})); });
  std::vector<std::thread> readers;
  for (int i = 0; i < 3; ++i) {
    readers.emplace_back([&] {
      for (int k = 0; k < kEach; ++k) service.update(some_document(picture_));
    });
  }
  for (int k = 0; k < kEach; ++k) {
    thread.post([&] { service.received(2, question_of({{"type", "document"}, {"request", 1}})); });
  }
  for (std::thread& reader : readers) reader.join();
  thread.finish();
  const std::vector<SaidMessage> told = clients.take(1);
  ASSERT_EQ(told.size(), 1U + 3 * kEach);
  EXPECT_EQ(told.back().head.at("revision"), 1 + 3 * kEach);
  std::uint64_t last{0};
  for (const SaidMessage& answer : clients.take(2)) {
    EXPECT_GE(answer.head.at("revision").get<std::uint64_t>(), last);
    last = answer.head.at("revision");
  }
  EXPECT_GT(last, 0U);
}

TEST_F(ViewerServiceTest, GivesPicturesOfTheDocumentAlone) {
  const HttpAnswer seen = service_.get({"picture", {{"name", "seen.png"}}});
  EXPECT_EQ(seen.status, 200);
  EXPECT_EQ(seen.content_type, "image/png");
  EXPECT_EQ((std::string{seen.body.begin(), seen.body.end()}), "not quite a picture");
  const std::string path = picture_.string();
  for (const std::string& name : {path, std::string{"./seen.png"}, std::string{"../seen.png"}, std::string{},
                                  std::string{"seen.png\0", 9}, std::string{"/etc/passwd"}}) {
    EXPECT_EQ(service_.get({"picture", {{"name", name}}}).status, 404) << name;
  }
  EXPECT_EQ(service_.get({"picture", {}}).status, 404);
  EXPECT_EQ(service_.get({"labels", {{"name", "seen.png"}}}).status, 404);
  EXPECT_EQ(service_.get({"picture/seen.png", {{"name", "seen.png"}}}).status, 404);
  std::filesystem::remove(picture_);
  EXPECT_EQ(service_.get({"picture", {{"name", "seen.png"}}}).status, 404);
}

TEST_F(ViewerServiceTest, ServesTheReportOfARunAndItsPictures) {
  EXPECT_EQ(service_.get({"report", {}}).status, 404) << "a mesh has none";
  const json record{{"command", "explore"}, {"result", {{"scene", "</script>"}}}};
  folder_.write("secret.txt", "no picture");
  SceneDocument document = some_document(picture_);
  document.record = record;
  document.folder = folder_.path();
  document.live = true;
  service_.update(document);
  ASSERT_EQ(posted_.size(), 1U);
  posted_[0]();
  const HttpAnswer answer = service_.get({"report", {}});
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.content_type, "application/json");
  const json report = json::parse(answer.body);
  EXPECT_EQ(report["schema"], "saccade-report/1");
  EXPECT_EQ(report["record"], record);
  EXPECT_EQ(report["live"], true);
  EXPECT_EQ(report["files"], json::array({"secret.txt", "seen.png"}));
  EXPECT_EQ(service_.get({"file", {{"name", "seen.png"}}}).content_type, "image/png");
  for (const char* name : {"secret.txt", "../seen.png", "./seen.png", "", "none.png"}) {
    EXPECT_EQ(service_.get({"file", {{"name", name}}}).status, 404) << name;
  }
}

}  // namespace
}  // namespace saccade::test

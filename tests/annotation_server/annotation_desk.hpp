// SPDX-License-Identifier: Apache-2.0
#pragma once
// AnnotationDesk: an annotation service without a network, pages that ask it, and what they see.

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "server/annotate/annotation_service.hpp"
#include "support/temp_folder.hpp"

namespace saccade::test {

using nlohmann::json;
using server::ConnectionId;

/// A message to a page, read.
struct Received {
  json head;
  std::vector<std::uint8_t> body;

  /// Returns `count` elements of the body, from a byte on.
  template <class T>
  [[nodiscard]] std::vector<T> array(std::size_t from, std::size_t count) const {
    std::vector<T> values(count);
    EXPECT_LE(from + count * sizeof(T), body.size());
    const bool fits = from + count * sizeof(T) <= body.size();
    if (count > 0 && fits) std::memcpy(values.data(), body.data() + from, count * sizeof(T));
    return values;
  }
  [[nodiscard]] bool ok() const { return head.value("ok", false); }
  [[nodiscard]] std::string error() const { return ok() ? "" : head.at("error").at("code").get<std::string>(); }
};

/// Keeps what is sent.
class KeptMessages : public server::Clients {
 public:
  void send(ConnectionId to, server::SharedMessage message) override {
    const auto parsed = server::parse_message(*message);
    ASSERT_TRUE(parsed) << "the service has sent what is no message";
    EXPECT_EQ((message->size() - parsed->body.size()) % 4, 0U);
    const std::lock_guard lock{mutex_};
    messages_[to].push_back({parsed->head, {parsed->body.begin(), parsed->body.end()}});
  }
  void close(ConnectionId connection, std::uint16_t code, const std::string& /*reason*/) override {
    const std::lock_guard lock{mutex_};
    closed_[connection] = code;
  }
  /// Returns the messages received since the last call.
  std::vector<Received> take(ConnectionId of) {
    const std::lock_guard lock{mutex_};
    return std::exchange(messages_[of], {});
  }
  [[nodiscard]] int close_code(ConnectionId of) {
    const std::lock_guard lock{mutex_};
    return closed_.contains(of) ? closed_[of] : 0;
  }

 private:
  std::mutex mutex_;
  std::map<ConnectionId, std::vector<Received>> messages_;
  std::map<ConnectionId, std::uint16_t> closed_;
};

/// Work that is posted waits until a test runs it.
class PostedWork {
 public:
  void post(std::function<void()> work) {
    const std::lock_guard lock{mutex_};
    waiting_.push_back(std::move(work));
    changed_.notify_one();
  }
  /// Does the next; false when none comes.
  bool do_next(std::chrono::seconds patience = std::chrono::seconds{60}) {
    std::function<void()> work;
    {
      std::unique_lock lock{mutex_};
      if (!changed_.wait_for(lock, patience, [this] { return !waiting_.empty(); })) return false;
      work = std::move(waiting_.front());
      waiting_.pop_front();
    }
    work();
    return true;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
};

/// State of a page, which asks questions and follows notices.
class Page {
 public:
  Page(server::AnnotationService& service, KeptMessages& messages, ConnectionId id, std::uint64_t client)
      : service_{service}, messages_{messages}, id_{id}, client_{client} {
    service_.opened(id_);
  }
  [[nodiscard]] ConnectionId id() const { return id_; }
  void close() { service_.closed(id_); }

  /// The answer; notices before it are taken in.
  Received ask(json question) {
    question["request"] = ++request_;
    send(server::MessageWriter{question});
    listen();
    for (const Received& answer : answers_) {
      if (answer.head.value("request", std::uint64_t{0}) == request_) return answer;
    }
    ADD_FAILURE() << "no answer to " << question.dump();
    return {};
  }
  void send(server::MessageWriter message) { service_.received(id_, *std::move(message).finish()); }
  void send_bytes(const std::string& bytes) {
    service_.received(id_, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  }
  Received hello() { return ask({{"type", "hello"}, {"protocol", 1}, {"client", client_}}); }

  /// Opens a cloud and asks for all points that are shown.
  Received open(std::size_t cloud = 0, std::size_t budget = 1'000'000) {
    Received opened = ask({{"type", "open"}, {"cloud", cloud}, {"budget", budget}});
    if (opened.ok()) take_in(opened);
    return opened;
  }
  void take_in(const Received& opened) {
    control_points.clear();
    labels.clear();
    order.clear();
    rows.clear();
    read_control_points(opened, opened.head.at("control_points"), 0);
    read_rows(opened.head);
    const std::size_t shown = opened.head.at("cloud").at("shown");
    for (std::size_t from = 0; from < shown;) {
      const Received points = ask({{"type", "points"}, {"from", from}, {"count", 5000}});
      const std::size_t count = points.head.at("count");
      ASSERT_GT(count, 0U);
      ASSERT_EQ(points.body.size(), count * 24);
      const auto indices = points.array<std::uint32_t>(12 * count, count);
      const auto given = points.array<std::uint32_t>(20 * count, count);
      for (std::size_t i = 0; i < count; ++i) labels[indices[i]] = given[i];
      order.insert(order.end(), indices.begin(), indices.end());
      from += count;
    }
  }
  Received act(json action) { return ask({{"type", "action"}, {"action", std::move(action)}}); }

  /// Takes in what has come.
  void listen() {
    answers_.clear();
    for (Received& message : messages_.take(id_)) {
      const std::string type = message.head.at("type");
      if (type == "answer") {
        answers_.push_back(std::move(message));
        continue;
      }
      if (type == "changes" || type == "ready") follow(message);
      notices[type].push_back(std::move(message));
    }
  }

  std::map<std::string, std::vector<Received>> notices;
  std::vector<std::uint32_t> order;               ///< points in the order in which they were given
  std::map<std::uint32_t, std::uint32_t> labels;  ///< labels of points that are shown
  std::map<std::uint32_t, std::pair<std::uint32_t, float>> control_points;  ///< label and start cost
  std::map<std::uint32_t, std::array<float, 3>> places;                     ///< positions of control points
  std::map<std::uint32_t, json> rows;                                       ///< rows of labels
  [[nodiscard]] std::size_t labelled_as(std::uint32_t label) const {
    std::size_t count{0};
    for (const auto& [point, its] : labels) count += its == label ? 1 : 0;
    return count;
  }

 private:
  static constexpr std::size_t kControlPointBytes{24};

  void read_control_points(const Received& message, std::size_t count, std::size_t from) {
    constexpr std::size_t kWords{kControlPointBytes / 4};
    const auto words = message.array<std::uint32_t>(from, kWords * count);
    const auto values = message.array<float>(from, kWords * count);
    for (std::size_t i = 0; i < words.size(); i += kWords) {
      if (words[i + 1] == 0) {
        control_points.erase(words[i]);
        places.erase(words[i]);
      } else {
        control_points[words[i]] = {words[i + 1], values[i + 2]};
        places[words[i]] = {values[i + 3], values[i + 4], values[i + 5]};
      }
    }
  }
  void read_rows(const json& head) {
    for (const json& row : head.at("labels")) {
      const bool gone = row.at("points") == 0 && row.at("control_points") == 0 && row.at("defined") == false;
      if (gone) {
        rows.erase(row.at("number"));
      } else {
        rows[row.at("number")] = row;
      }
    }
  }
  void follow(const Received& message) {
    const std::size_t count = message.head.at("control_points");
    read_control_points(message, count, 0);
    read_rows(message.head);
    std::size_t at = kControlPointBytes * count;
    for (const json& group : message.head.at("groups")) {
      for (const std::uint32_t point : message.array<std::uint32_t>(at, group.at(1))) {
        EXPECT_TRUE(order.empty() || labels.contains(point)) << point << " is not shown";
        labels[point] = group.at(0);
      }
      at += 4 * group.at(1).get<std::size_t>();
    }
    EXPECT_EQ(at, message.body.size());
  }

  server::AnnotationService& service_;
  KeptMessages& messages_;
  ConnectionId id_;
  std::uint64_t client_;
  std::uint64_t request_{0};
  std::vector<Received> answers_;
};

/// Clouds of a table with three boxes on it, each of one colour, seen from above: kColumns × kRows points, and one that
/// is not finite.
class AnnotationDesk : public ::testing::Test {
 protected:
  static constexpr int kColumns{120};
  static constexpr int kRows{100};
  static constexpr std::size_t kPoints{12'001};
  static constexpr std::uint32_t kNan{12'000};
  static constexpr std::uint32_t kOnTable{10 * 120 + 60};
  static constexpr std::uint32_t kOnBox1{50 * 120 + 20};
  static constexpr std::uint32_t kOnBox2{50 * 120 + 60};
  static constexpr std::uint32_t kOnBox3{50 * 120 + 100};

  void write_cloud(const std::string& name) const {
    std::string text =
        "VERSION .7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 12001\nHEIGHT 1\n"
        "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 12001\nDATA ascii\n";
    for (int row = 0; row < kRows; ++row) {
      for (int column = 0; column < kColumns; ++column) {
        const int box = row >= 30 && row < 70 && column % 40 >= 10 && column % 40 < 30 ? 1 + column / 40 : 0;
        const int rgb = ((box == 0 ? 200 : 30) << 16) + ((60 * box) << 8) + 90;
        text += std::to_string(0.005 * (column - 60)) + " " + std::to_string(0.005 * (row - 50)) + " " +
                (box > 0 ? "0.95 " : "1.0 ") + std::to_string(rgb) + "\n";
      }
    }
    folder_.write(name, text + "nan nan nan 0\n");
  }
  void SetUp() override {
    write_cloud("table.pcd");
    config_.title = "table.pcd";
    config_.version = "1.2.3";
    config_.threads = 2;
    config_.start.graph.max_path = 10.0;
    config_.clouds = {served("table")};
    start();
  }
  [[nodiscard]] server::ServedCloud served(const std::string& name) const {
    return {folder_ / (name + ".pcd"),
            folder_ / (name + ".sacann"),
            {},
            folder_ / (name + "_labels.pcd"),
            folder_ / (name + "_labels.names.json")};
  }
  void start() {
    service_.reset();
    messages_ = std::make_unique<KeptMessages>();
    posted_ = std::make_shared<PostedWork>();
    service_ = std::make_unique<server::AnnotationService>(
        config_, *messages_, [posted = posted_](std::function<void()> work) { posted->post(std::move(work)); });
  }
  /// The program ends in the midst of everything, and begins again.
  void stop() { service_.reset(); }

  [[nodiscard]] Page connect(std::uint64_t client) { return Page{*service_, *messages_, ++last_id_, client}; }
  /// With the first cloud open.
  [[nodiscard]] Page page(std::uint64_t client, std::size_t budget = 1'000'000) {
    Page made = connect(client);
    EXPECT_TRUE(made.hello().ok());
    EXPECT_TRUE(made.open(0, budget).ok());
    return made;
  }
  static json set(std::uint32_t label, std::uint32_t point) {
    return {{"do", "set"}, {"label", label}, {"points", {point}}};
  }
  /// A control point on the table and on every box: labels 1 to 4.
  static void four_clicks(Page& page) {
    EXPECT_TRUE(page.act(set(1, kOnTable)).ok());
    EXPECT_TRUE(page.act(set(2, kOnBox1)).ok());
    EXPECT_TRUE(page.act(set(3, kOnBox2)).ok());
    EXPECT_TRUE(page.act(set(4, kOnBox3)).ok());
  }
  /// Checks that the followed state equals the answers to new questions.
  void expect_up_to_date(const Page& page) {
    Page other = connect(999);
    other.hello();
    other.open(0, page.order.size());
    EXPECT_EQ(page.order, other.order);
    EXPECT_TRUE(page.labels == other.labels) << "labels differ";
    EXPECT_EQ(page.control_points, other.control_points);
    EXPECT_EQ(page.places, other.places);
    EXPECT_EQ(page.rows, other.rows);
    other.close();
  }
  [[nodiscard]] server::HttpAnswer get(const std::string& format, const std::string& cloud = "0") {
    return service_->get({"labels", {{"cloud", cloud}, {"format", format}}});
  }

  TempFolder folder_;
  server::AnnotationServiceConfig config_;
  std::unique_ptr<KeptMessages> messages_;
  std::shared_ptr<PostedWork> posted_;
  std::unique_ptr<server::AnnotationService> service_;
  ConnectionId last_id_{0};
};

}  // namespace saccade::test

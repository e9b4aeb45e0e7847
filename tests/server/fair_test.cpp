// SPDX-License-Identifier: Apache-2.0
// Order of work: a light client does not wait for all heavy ones, and no client gains by idling or reconnecting.
#include <algorithm>
#include <iostream>

#include "server/served_page.hpp"
#include "server/service_thread.hpp"

namespace saccade::test {
namespace {

using server::ServiceThread;
using std::chrono::milliseconds;

/// Records the order of work, which begins when everything is posted.
class Turns : public ::testing::Test {
 protected:
  void TearDown() override { thread_.finish(); }
  void hold() {
    held_ = true;
    thread_.post([this] {
      while (held_) std::this_thread::sleep_for(milliseconds{1});
    });
  }
  void post(ServiceThread::FairShare& account, char name, int count, milliseconds took) {
    for (int i = 0; i < count; ++i) {
      thread_.post(account, [this, name, took] {
        std::this_thread::sleep_for(took);
        note(name);
      });
    }
  }
  std::string all_done(std::size_t count) {
    held_ = false;
    EXPECT_TRUE(eventually([this, count] { return count_ == count; }));
    count_ = 0;
    return std::exchange(done_, {});
  }
  void note(char name) {
    done_ += name;
    ++count_;
  }

  ServiceThread thread_;
  std::atomic<bool> held_{false};
  std::string done_;  ///< written by the thread, and by the test after it is done
  std::atomic<std::size_t> count_{0};
};

TEST_F(Turns, ThatOfTheProgramIsFirstAndTheLeastUsedNext) {
  ServiceThread::FairShare much{thread_};
  ServiceThread::FairShare little{thread_};
  hold();
  post(much, 'm', 4, milliseconds{30});
  post(little, 'l', 6, milliseconds{0});
  thread_.post([this] { note('p'); });
  EXPECT_EQ(all_done(11), "pmllllllmmm");
}

TEST_F(Turns, ToComeAnewGainsNothing) {
  ServiceThread::FairShare there{thread_};
  post(there, 't', 5, milliseconds{20});
  EXPECT_EQ(all_done(5), "ttttt");
  ServiceThread::FairShare fresh{thread_};
  hold();
  post(there, 't', 3, milliseconds{20});
  post(fresh, 'f', 3, milliseconds{20});
  const std::string order = all_done(6);
  EXPECT_EQ(order.substr(0, 2), "tf");
  EXPECT_NE(order.substr(0, 4), "tfff") << order;
}

TEST_F(Turns, ToIdleGainsHalfASecondAtMost) {
  ServiceThread::FairShare idle{thread_};
  ServiceThread::FairShare busy{thread_};
  post(busy, 'b', 20, milliseconds{60});
  EXPECT_EQ(all_done(20), std::string(20, 'b'));
  hold();
  post(busy, 'b', 5, milliseconds{60});
  post(idle, 'i', 20, milliseconds{60});
  const std::size_t waited = all_done(25).find('b');
  EXPECT_GE(waited, 4U) << "it is ahead, as it has used less";
  EXPECT_LE(waited, 10U) << "of 1.2 s that the other one used, half a second is remembered";
}

class Fair : public ServedPage {};

TEST_F(Fair, WhoAsksLittleWaitsForAboutOneQuestion) {
  constexpr int kCrowd{40};
  static constexpr milliseconds kSlow{10};
  constexpr std::chrono::seconds kPatience{30};
  std::atomic<int> slow{0};
  service_->on_message = [server = server_.get(), &slow](ConnectionId from, const std::string& text) {
    if (text == "slow") std::this_thread::sleep_for(kSlow);
    if (text == "slow") ++slow;
    server->send(from, message_of(text));
  };
  RawClient good = socket();
  std::atomic<bool> over{false};
  std::vector<std::thread> crowd;
  for (int i = 0; i < kCrowd; ++i) {
    crowd.emplace_back([this, &over] {
      RawClient floods = socket();
      for (int waiting = 0; waiting < 4; ++waiting) floods.send_message("slow");
      while (!over && floods.read_message()) floods.send_message("slow");
    });
  }
  EXPECT_TRUE(eventually([&slow] { return slow >= 2 * kCrowd; }, kPatience)) << "each has had its turn";
  const int before = slow;
  std::vector<int> waited;  // number of other clients' questions during each wait
  // On a busy machine the others ask again late: we go on until they were served as well.
  const auto both_served = [&] {
    const int begin = slow;
    good.send_message("quick");
    if (!good.read_message()) throw std::runtime_error{"no answer"};
    waited.push_back(slow - begin);
    return waited.size() >= 60 && slow - before > 20;
  };
  EXPECT_TRUE(eventually(both_served, kPatience)) << slow - before << " of the others', ours " << waited.size();
  over = true;
  for (std::thread& one : crowd) one.join();
  server_.reset();  // which still does what they asked
  ASSERT_FALSE(waited.empty());
  std::sort(waited.begin(), waited.end());
  std::cout << "a quick question among " << kCrowd << " connections with slow ones: waits for "
            << waited[waited.size() / 2] << " of them (median), " << waited.back() << " at most\n";
  EXPECT_LE(waited[waited.size() / 2], 2);
  EXPECT_LE(waited.back(), 6);
}

TEST_F(Fair, WhoIsGoneHasItsPlaceUntilItsQuestionsAreDone) {
  server_.reset();
  server::ServerConfig small = config();
  small.max_connections = 3;
  begin(small);
  server_->serve(*service_);
  std::atomic<bool> lets_go{false};
  service_->on_message = [&lets_go](ConnectionId, const std::string&) {
    while (!lets_go) std::this_thread::sleep_for(milliseconds{1});
  };
  for (int i = 0; i < 3; ++i) {
    RawClient gone = socket();
    gone.send_message("a");
    gone.send_message("b");
    std::this_thread::sleep_for(milliseconds{50});
    gone.reset();
  }
  std::this_thread::sleep_for(milliseconds{100});
  EXPECT_EQ(client().upgrade(), 503) << "else questions of those who are gone would grow without end";
  lets_go = true;
  EXPECT_TRUE(eventually([this] { return client().upgrade() == 101; }));
  EXPECT_EQ(service_->received_count, 6U);
}

}  // namespace
}  // namespace saccade::test

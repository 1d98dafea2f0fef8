#include "app/common/worker.hpp"

#include <future>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <latch>
#include <vector>

namespace lodestar {
namespace {

using ::testing::ElementsAre;

TEST(Worker, does_jobs_in_order_and_no_more_than_it_may) {
  std::vector<int> done;
  std::latch began(1);
  std::latch may_end(1);
  std::promise<void> last;
  Worker worker(1);
  ASSERT_TRUE(worker.give([&](const std::stop_token&) {
    began.count_down();
    may_end.wait();
    done.push_back(1);
  }));
  began.wait();
  ASSERT_TRUE(worker.give([&](const std::stop_token&) {
    done.push_back(2);
    last.set_value();
  }));
  EXPECT_FALSE(worker.give([&](const std::stop_token&) { done.push_back(3); }));
  may_end.count_down();
  last.get_future().wait();
  EXPECT_THAT(done, ElementsAre(1, 2));
}

TEST(Worker, tells_a_job_that_it_is_cancelled) {
  std::promise<bool> seen;
  Worker worker(0);
  const std::optional<std::stop_source> cancel = worker.give([&](const std::stop_token& cancelled) {
    while (!cancelled.stop_requested()) std::this_thread::yield();
    seen.set_value(true);
  });
  ASSERT_TRUE(cancel);
  std::stop_source(*cancel).request_stop();
  EXPECT_TRUE(seen.get_future().get());
}

TEST(Worker, a_cancelled_job_keeps_no_other_from_waiting) {
  std::latch began(1);
  std::latch may_end(1);
  std::promise<void> last;
  bool is_told = false;
  Worker worker(1);
  ASSERT_TRUE(worker.give([&](const std::stop_token&) {
    began.count_down();
    may_end.wait();
  }));
  began.wait();
  const std::optional<std::stop_source> cancel =
      worker.give([&](const std::stop_token& cancelled) { is_told = cancelled.stop_requested(); });
  ASSERT_TRUE(cancel);
  std::stop_source(*cancel).request_stop();
  EXPECT_TRUE(worker.give([&](const std::stop_token&) { last.set_value(); }));
  EXPECT_TRUE(is_told);
  may_end.count_down();
  last.get_future().wait();
}

TEST(Worker, ends_the_job_under_way_and_drops_the_others) {
  bool dropped = true;
  {
    std::latch began(1);
    Worker worker(1);
    ASSERT_TRUE(worker.give([&](const std::stop_token& cancelled) {
      began.count_down();
      while (!cancelled.stop_requested()) std::this_thread::yield();
    }));
    began.wait();
    ASSERT_TRUE(worker.give([&](const std::stop_token&) { dropped = false; }));
  }
  EXPECT_TRUE(dropped);
}

}  // namespace
}  // namespace lodestar

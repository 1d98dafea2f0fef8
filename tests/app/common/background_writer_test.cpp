#include "app/common/background_writer.hpp"

#include <atomic>
#include <future>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <vector>

// What the control thread relies on: it is never blocked, memory is bounded, and losses are counted.
namespace lodestar {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A disk that blocks every write until it is opened.
class Gate {
 public:
  void open() { promise_.set_value(); }
  void pass() const { opened_.wait(); }

 private:
  std::promise<void> promise_;
  std::shared_future<void> opened_ = promise_.get_future().share();
};

std::vector<int> up_to(int count) {
  std::vector<int> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

TEST(BackgroundWriter, writes_everything_in_order_before_it_is_destroyed) {
  std::vector<int> written;
  int flushed_at = 0;
  {
    BackgroundWriter<int> writer(
        {.most_waiting = 10'000}, [&](int number) { written.push_back(number); },
        [&] { flushed_at = static_cast<int>(written.size()); });
    for (const int number : up_to(5000)) EXPECT_TRUE(writer.put(number));
  }
  EXPECT_EQ(written, up_to(5000));
  EXPECT_EQ(flushed_at, 5000);
}

TEST(BackgroundWriter, takes_no_more_than_fits_and_holds_nobody_up_while_the_disk_hangs) {
  Gate disk;
  std::vector<int> written;
  BackgroundWriter<int> writer({.most_waiting = 3}, [&](int number) {
    disk.pass();
    written.push_back(number);
  });
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(writer.put(i)) << i;
  EXPECT_FALSE(writer.accepts());
  for (int i = 3; i < 1000; ++i) EXPECT_FALSE(writer.put(i)) << i;  // returns, although the disk blocks
  EXPECT_EQ(writer.counts().dropped, 997U);
  disk.open();
  const WriterCounts counts = writer.finish();
  EXPECT_THAT(written, ElementsAre(0, 1, 2));
  EXPECT_EQ(counts.written, 3U);
  EXPECT_FALSE(counts.complete());
  EXPECT_EQ(counts.loss("run.log"), "run.log: 997 of 1000 are missing: the disk did not keep up");
}

TEST(BackgroundWriter, counts_an_item_by_its_size_until_it_is_written) {
  Gate disk;
  auto first = std::make_shared<int>(1);
  const std::weak_ptr<int> seen = first;
  BackgroundWriter<std::shared_ptr<int>> writer({.most_waiting = 100},
                                                [&](const std::shared_ptr<int>&) { disk.pass(); });
  EXPECT_TRUE(writer.put(std::move(first), 99));
  EXPECT_TRUE(writer.put(std::make_shared<int>(2), 50));
  EXPECT_FALSE(writer.put(std::make_shared<int>(3), 1));
  EXPECT_FALSE(seen.expired());
  disk.open();
  writer.finish();
  EXPECT_TRUE(seen.expired()) << "written items are freed";
}

TEST(BackgroundWriter, waits_for_room_where_the_drive_can) {
  std::vector<int> written;
  BackgroundWriter<int> writer({.most_waiting = 1, .can_wait = true},
                               [&](int number) { written.push_back(number); });
  for (const int number : up_to(2000)) EXPECT_TRUE(writer.put(number));
  EXPECT_TRUE(writer.finish().complete());
  EXPECT_EQ(written, up_to(2000));
}

TEST(BackgroundWriter, keeps_the_first_error_tells_it_once_and_goes_on) {
  std::vector<std::string> told;
  std::vector<int> written;
  BackgroundWriter<int> writer(
      {.most_waiting = 100, .tell = [&](const std::string& words) { told.push_back(words); }},
      [&](int number) {
        if (number % 2 == 1) throw std::runtime_error("no room for " + std::to_string(number));
        written.push_back(number);
      });
  for (const int number : up_to(6)) EXPECT_TRUE(writer.put(number));
  const WriterCounts counts = writer.finish();
  EXPECT_THAT(told, ElementsAre("no room for 1"));
  EXPECT_THAT(written, ElementsAre(0, 2, 4));
  EXPECT_EQ(counts.failed, 3U);
  EXPECT_EQ(counts.loss("run.log"), "run.log: 3 of 6 are missing: no room for 1");
}

TEST(BackgroundWriter, a_flush_that_fails_is_an_error_too) {
  std::atomic<int> told = 0;
  BackgroundWriter<int> writer(
      {.most_waiting = 9, .tell = [&](const std::string&) { ++told; }}, [](int) {},
      [] { throw std::runtime_error("the disk is full"); });
  EXPECT_TRUE(writer.put(1));
  const WriterCounts counts = writer.finish();
  EXPECT_EQ(told, 1);
  EXPECT_EQ(counts.loss("run.log"), "run.log: the disk is full");
}

TEST(BackgroundWriter, drops_what_a_full_disk_would_not_take_even_where_it_can_wait) {
  bool is_full = false;
  BackgroundWriter<int> writer(
      {.most_waiting = 9, .can_wait = true, .disk = {.is_full = [&] { return is_full; }}}, [](int) {});
  EXPECT_TRUE(writer.put(1));
  is_full = true;
  EXPECT_FALSE(writer.put(2));
  is_full = false;
  EXPECT_TRUE(writer.put(3));
  EXPECT_EQ(writer.finish().loss("run.log"), "run.log: 1 of 3 are missing: the disk is full");
}

TEST(BackgroundWriter, collects_before_it_writes_but_neither_when_full_nor_at_the_end) {
  std::vector<std::size_t> flushed_at;
  std::size_t written = 0;
  BackgroundWriter<int> writer(
      {.most_waiting = 4, .can_wait = true, .collect = std::chrono::hours(1)}, [&](int) { ++written; },
      [&] { flushed_at.push_back(written); });
  for (const int number : up_to(6)) EXPECT_TRUE(writer.put(number));
  writer.finish();
  ASSERT_FALSE(flushed_at.empty());
  EXPECT_GE(flushed_at.front(), 4U) << "one flush for items that arrived together";
  EXPECT_EQ(flushed_at.back(), 6U);
}

TEST(BackgroundWriter, takes_nothing_after_its_end_and_starts_no_thread_for_nothing) {
  BackgroundWriter<int> writer({.most_waiting = 9}, [](int) { ADD_FAILURE(); });
  EXPECT_TRUE(writer.finish().complete());
  EXPECT_FALSE(writer.put(1));
  EXPECT_EQ(writer.finish().dropped, 1U);
  EXPECT_THAT(WriterCounts{}.loss("run.log"), IsEmpty());
}

}  // namespace
}  // namespace lodestar

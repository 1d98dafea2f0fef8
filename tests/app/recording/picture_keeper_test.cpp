#include "app/recording/picture_keeper.hpp"

#include <future>
#include <gtest/gtest.h>

// The control loop hands over frames without a copy; another thread encodes them.
namespace lodestar {
namespace {

Frame frame_at(double time_s, int shade = 0) {
  return {.stamp = Stamp(from_seconds(time_s)), .gray = cv::Mat(4, 4, CV_8UC1, cv::Scalar(shade))};
}

std::string shade_of(const cv::Mat& gray) {
  return std::to_string(gray.at<unsigned char>(0, 0));
}

TEST(PictureKeeper, keeps_so_many_a_second_and_none_when_none_are_wanted) {
  DriveRecord none;
  PictureKeeper idle(PictureKeeperOptions{.jpeg_of = shade_of});
  EXPECT_FALSE(idle.keep(none, std::vector{frame_at(0.0)}));
  EXPECT_TRUE(none.pictures.empty());

  DriveRecord record;
  PictureKeeper keeper({.pictures_hz = 2.0, .jpeg_of = shade_of});
  for (int i = 0; i <= 30; ++i) {
    const std::optional<KeptPicture> kept = keeper.keep(record, std::vector{frame_at(i / 30.0, i)});
    EXPECT_EQ(kept.has_value(), i % 15 == 0) << i;
  }
  ASSERT_EQ(record.pictures.size(), 3U);
  EXPECT_EQ(record.pictures[1].jpeg.get(), "15");
  EXPECT_EQ(record.pictures[2].stamp, Stamp(from_seconds(1.0)));
}

TEST(PictureKeeper, gives_no_work_to_the_thread_that_drives_and_never_holds_it_up) {
  std::promise<void> told_to_go_on;
  const std::shared_future<void> go_on = told_to_go_on.get_future().share();
  const unsigned char* made_of = nullptr;
  std::thread::id made_by;
  DriveRecord record;
  const std::vector<Frame> first{frame_at(0.0, 7)};
  {
    PictureKeeper keeper({.pictures_hz = 1.0, .most_waiting = 3, .jpeg_of = [&](const cv::Mat& gray) {
                            go_on.wait();  // an encoder that blocks
                            if (made_of == nullptr) made_of = gray.data;
                            made_by = std::this_thread::get_id();
                            return shade_of(gray);
                          }});
    EXPECT_TRUE(keeper.keep(record, first));
    for (int i = 1; i < 3; ++i) EXPECT_TRUE(keeper.keep(record, std::vector{frame_at(i, i)})) << i;
    for (int i = 3; i < 100; ++i) EXPECT_FALSE(keeper.keep(record, std::vector{frame_at(i, i)})) << i;
    EXPECT_EQ(record.pictures.size(), 3U) << "dropped frames are not in the record";
    EXPECT_EQ(record.dropped_pictures, 97);
    told_to_go_on.set_value();
  }
  EXPECT_EQ(made_of, first.front().gray.data) << "handed over without a copy";
  EXPECT_NE(made_by, std::this_thread::get_id());
  EXPECT_EQ(record.pictures[0].jpeg.get(), "7");
  EXPECT_EQ(record.pictures[2].jpeg.get(), "2");
}

TEST(PictureKeeper, leaves_a_picture_that_cannot_be_made_empty) {
  DriveRecord record;
  PictureKeeper keeper({.pictures_hz = 1.0, .jpeg_of = [](const cv::Mat& gray) {
                          if (gray.at<unsigned char>(0, 0) == 0) throw std::runtime_error("no memory");
                          return shade_of(gray);
                        }});
  for (int i = 0; i < 2; ++i) EXPECT_TRUE(keeper.keep(record, std::vector{frame_at(i, i)}));
  EXPECT_EQ(record.pictures[0].jpeg.get(), "");
  EXPECT_EQ(record.pictures[1].jpeg.get(), "1");
}

TEST(PictureKeeper, loses_nothing_where_the_drive_can_wait) {
  DriveRecord record;
  {
    PictureKeeper keeper({.pictures_hz = 1.0, .most_waiting = 1, .can_wait = true, .jpeg_of = shade_of});
    for (int i = 0; i < 200; ++i) EXPECT_TRUE(keeper.keep(record, std::vector{frame_at(i, i)})) << i;
  }
  ASSERT_EQ(record.pictures.size(), 200U);
  for (std::size_t i = 0; i < record.pictures.size(); ++i)
    EXPECT_EQ(record.pictures[i].jpeg.get(), std::to_string(i));
}

}  // namespace
}  // namespace lodestar

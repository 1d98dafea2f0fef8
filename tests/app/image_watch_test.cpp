#include "app/image_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lodestar {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

/// A control loop of 20 ms that looks at a camera.
class ImageWatchTest : public testing::Test {
 protected:
  std::optional<std::string> step(std::size_t frames) {
    now += milliseconds(20);
    return watch.see(now, frames);
  }

  /// 25 images a second, for so many of them.
  void watch_images(int images) {
    for (int i = 0; i < images; ++i) {
      EXPECT_FALSE(step(0));
      EXPECT_FALSE(step(1));
    }
  }

  ImageWatch watch;
  Stamp now{milliseconds(1)};
};

TEST_F(ImageWatchTest, has_nothing_to_say_of_a_camera_that_works) {
  watch_images(500);
  EXPECT_FALSE(watch.is_silent());
}

TEST_F(ImageWatchTest, misses_images_after_three_periods_and_says_so_once) {
  watch_images(50);
  int steps = 0;
  std::optional<std::string> words;
  for (; !words && steps < 100; ++steps) words = step(0);
  ASSERT_TRUE(words);
  EXPECT_THAT(*words, HasSubstr("no image"));
  EXPECT_NEAR(20 * steps, 3 * 40, 25);
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(step(0));

  words = step(1);
  ASSERT_TRUE(words);
  EXPECT_THAT(*words, HasSubstr("again"));
  watch_images(50);
}

TEST_F(ImageWatchTest, gives_a_camera_two_seconds_to_start) {
  for (int i = 0; i < 99; ++i) EXPECT_FALSE(step(0));
  EXPECT_FALSE(watch.is_silent());
  for (int i = 0; i < 5; ++i) (void)step(0);
  EXPECT_TRUE(watch.is_silent());
}

}  // namespace
}  // namespace lodestar

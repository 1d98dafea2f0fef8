#include "app/common/interruption.hpp"

#include <csignal>
#include <gtest/gtest.h>

namespace lodestar {
namespace {

TEST(Interruption, is_asked_for_by_a_signal_that_then_does_not_end_the_program) {
  const Interruption interruption;
  EXPECT_FALSE(Interruption::asked());
  std::raise(SIGTERM);
  EXPECT_TRUE(Interruption::asked());
}

TEST(Interruption, of_an_earlier_camera_is_forgotten) {
  {
    const Interruption earlier;
    std::raise(SIGINT);
  }
  const Interruption interruption;
  EXPECT_FALSE(Interruption::asked());
}

TEST(Interruption, asked_twice_ends_the_program) {
  EXPECT_EXIT(
      {
        const Interruption interruption;
        std::raise(SIGINT);
        std::raise(SIGINT);
      },
      ::testing::KilledBySignal(SIGINT), "");
}

}  // namespace
}  // namespace lodestar

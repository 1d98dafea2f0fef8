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

TEST(Interruption, inside_another_neither_forgets_the_signal_nor_ends_what_the_other_does) {
  const Interruption interruption;
  {
    const Interruption inside;
    std::raise(SIGTERM);
  }
  EXPECT_TRUE(Interruption::asked());
  {
    const Interruption again;
    EXPECT_TRUE(Interruption::asked());
  }
  std::raise(SIGINT);  // the first SIGINT, after a SIGTERM
  EXPECT_TRUE(Interruption::asked());
}

TEST(Interruption, leaves_signals_to_do_what_they_did_before) {
  static volatile std::sig_atomic_t seen = 0;
  std::signal(SIGINT, [](int) { seen = 1; });
  {
    const Interruption interruption;
  }
  std::raise(SIGINT);
  EXPECT_EQ(seen, 1);
  std::signal(SIGINT, SIG_DFL);
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

#include "app/recording/can_log.hpp"

#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/can/candump.hpp"
#include "drivers/system/clock.hpp"

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

StampedCanFrame numbered(int number) {
  return {Stamp(milliseconds(number)), {0x111, 1, {static_cast<std::uint8_t>(number)}}};
}

TEST(CanLog, holds_every_frame_in_order) {
  const TemporaryFolder folder;
  {
    CanLog log(folder / "can.log", "can7", [](const std::string& words) { ADD_FAILURE() << words; });
    for (int i = 0; i < 1000; ++i) log.take(numbered(i));
  }
  const std::vector<LoggedCanFrame> frames = load_candump(folder / "can.log");
  ASSERT_EQ(frames.size(), 1000U);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(frames[static_cast<std::size_t>(i)].received.frame, numbered(i).frame);
    EXPECT_EQ(frames[static_cast<std::size_t>(i)].interface, "can7");
  }
}

TEST(CanLog, grows_while_the_robot_drives) {
  const TemporaryFolder folder;
  CanLog log(folder / "can.log", "can0", [](const std::string& words) { ADD_FAILURE() << words; });
  log.take(numbered(1));
  std::size_t size = 0;
  for (int tries = 0; size == 0 && tries < 500; ++tries) {
    std::error_code not_yet;
    const auto now = std::filesystem::file_size(folder / "can.log", not_yet);
    if (!not_yet) size = now;
    std::this_thread::sleep_for(milliseconds(10));
  }
  EXPECT_GT(size, 0U);
}

TEST(CanLog, that_finds_no_room_says_so_once_and_holds_nobody_up) {
  std::vector<std::string> said;
  {
    CanLog log("/dev/full", "can0", [&said](const std::string& words) { said.push_back(words); });
    for (int i = 0; i < 100000; ++i) log.take(numbered(i));
  }
  ASSERT_EQ(said.size(), 1U);
  EXPECT_THAT(said.front(), HasSubstr("/dev/full"));
}

TEST(CanLog, in_a_folder_that_is_not_there_says_so) {
  std::vector<std::string> said;
  {
    CanLog log("/nowhere/can.log", "can0", [&said](const std::string& words) { said.push_back(words); });
  }
  EXPECT_EQ(said.size(), 1U);
}

}  // namespace
}  // namespace lodestar

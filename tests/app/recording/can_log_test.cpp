#include "app/recording/can_log.hpp"

#include <algorithm>
#include <array>
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <optional>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

#include "drivers/can/candump.hpp"
#include "drivers/system/file_descriptor.hpp"
#include "maps/input_error.hpp"

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

using std::chrono::milliseconds;
using ::testing::AllOf;
using ::testing::HasSubstr;

StampedCanFrame numbered(int number) {
  return {Stamp(milliseconds(number)), {0x111, 1, {static_cast<std::uint8_t>(number)}}};
}

TEST(CanLog, holds_every_frame_in_order) {
  const TemporaryFolder folder;
  {
    CanLog log(folder / "can.log", {.interface = "can7"});
    for (int i = 0; i < 1000; ++i) log.take(numbered(i));
    EXPECT_EQ(log.finish(), "");
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
  CanLog log(folder / "can.log", {});
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
    CanLog log("/dev/full", {.tell = [&said](const std::string& words) { said.push_back(words); }});
    for (int i = 0; i < 100000; ++i) log.take(numbered(i));
    EXPECT_THAT(log.finish(), AllOf(HasSubstr("/dev/full"), HasSubstr("are missing")));
  }
  ASSERT_EQ(said.size(), 1U);
  EXPECT_THAT(said.front(), HasSubstr("/dev/full"));
}

/// A pipe that nobody reads acts as a disk that hangs.
TEST(CanLog, of_a_disk_that_hangs_drops_what_does_not_fit_and_says_how_much) {
  const TemporaryFolder folder;
  const std::string file = (folder / "can.log").string();
  ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
  const FileDescriptor reader(::open(file.c_str(), O_RDONLY | O_NONBLOCK));
  std::optional<CanLog> log;
  log.emplace(file, CanLogOptions{.most_waiting = 10'000});
  for (int i = 0; i < 200'000; ++i) log->take(numbered(i));  // returns, although the pipe is full

  ASSERT_EQ(::fcntl(reader.get(), F_SETFL, 0), 0);  // from now on the disk accepts writes
  std::ptrdiff_t taken = 0;
  std::thread disk([&] {
    std::array<char, 4096> part{};
    for (ssize_t size = 0; (size = ::read(reader.get(), part.data(), part.size())) > 0;)
      taken += std::count(part.begin(), part.begin() + size, '\n');
  });
  const std::string loss = log->finish();
  log.reset();  // closes the pipe
  disk.join();
  EXPECT_LT(taken, 100'000) << "memory is bounded";
  EXPECT_EQ(loss,
            fmt::format("can.log: {} of 200000 are missing: the disk did not keep up", 200'000 - taken));
}

TEST(CanLog, in_a_folder_that_is_not_there_is_an_input_error) {
  EXPECT_THROW(CanLog("/nowhere/can.log", {}), InputError);
}

}  // namespace
}  // namespace lodestar

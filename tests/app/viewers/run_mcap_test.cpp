#include "app/viewers/run_mcap.hpp"

#include <array>
#include <fcntl.h>
#include <filesystem>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

#include "drivers/system/file_descriptor.hpp"

#include "tests/app/sample_run.hpp"
#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

KnownWorld small_world() {
  return {.map = sample::floor(), .registry = sample::ceiling(), .camera = {}};
}

std::string all_of(int pipe) {
  std::string bytes;
  std::array<char, 4096> part{};
  for (ssize_t size = 0; (size = ::read(pipe, part.data(), part.size())) > 0;)
    bytes.append(part.data(), static_cast<std::size_t>(size));
  return bytes;
}

/// A pipe that nobody reads acts as a disk that hangs.
TEST(RunMcap, does_not_wait_for_a_slow_disk_and_says_that_the_file_has_a_gap) {
  const TemporaryFolder folder;
  const std::string file = (folder / "run.mcap").string();
  ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
  const FileDescriptor reader(::open(file.c_str(), O_RDONLY | O_NONBLOCK));
  ASSERT_GE(reader.get(), 0);
  std::optional<RunMcap> mcap;
  mcap.emplace(folder / "", small_world(), RobotBody{.radius_m = 0.25, .outline_m = {}},
               RunMcapOptions{.most_waiting_bytes = 100'000});
  const RunRecord drive = sample::run();
  for (int i = 0; i < 20'000; ++i) mcap->add_truth(drive);  // returns, even when the pipe is full

  ASSERT_EQ(::fcntl(reader.get(), F_SETFL, 0), 0);  // from now on the disk accepts writes
  std::string taken;
  std::thread disk([&] { taken = all_of(reader.get()); });
  EXPECT_THAT(mcap->finish(),
              AllOf(StartsWith("run.mcap: "), HasSubstr(" of 20000 are missing: the disk did not keep up")));
  mcap.reset();  // closes the pipe
  disk.join();
  EXPECT_TRUE(taken.ends_with("MCAP0\r\n")) << "the file ends properly";
}

/// A replay can wait, and must write the same bytes each time.
TEST(RunMcap, waits_where_it_may_and_loses_nothing) {
  const TemporaryFolder folder;
  const RunRecord drive = sample::run();
  std::array<std::uintmax_t, 2> sizes{};
  for (const std::size_t most : {std::size_t{1}, std::size_t{1} << 30U}) {
    RunMcap mcap(folder / "", small_world(), {.radius_m = 0.25, .outline_m = {}},
                 {.most_waiting_bytes = most, .can_wait = true});
    for (int i = 0; i < 300; ++i) mcap.add_truth(drive);
    EXPECT_EQ(mcap.finish(), "");
    sizes[most == 1 ? 0 : 1] = std::filesystem::file_size(folder / "run.mcap");
  }
  EXPECT_EQ(sizes[0], sizes[1]);
  EXPECT_GT(sizes[0], 1000U);
}

}  // namespace
}  // namespace lodestar

#include "app/viewers/mcap_file.hpp"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <nlohmann/json.hpp>

#include "app/viewers/drive_messages.hpp"
#include "maps/input_error.hpp"

#include "tests/app/sample_run.hpp"
#include "tests/maps/temporary_folder.hpp"

// The bytes are checked with a third-party reader, in tests/web/mcap_test.mjs.
namespace lodestar {
namespace {

namespace fs = std::filesystem;

const std::string magic = "\x89MCAP0\r\n";

std::string content_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class McapFileTest : public testing::Test {
 protected:
  std::string written(const std::vector<Message>& messages, const McapOptions& options = {}) const {
    {
      McapFile mcap(file, drive_channels(), options);
      for (const Message& message : messages) mcap.write(message);
      EXPECT_TRUE(mcap.healthy());
    }
    return content_of(file);
  }

  TemporaryFolder folder;
  fs::path file = folder / "run.mcap";
};

TEST_F(McapFileTest, begins_and_ends_with_the_magic_even_without_a_message) {
  for (const auto& messages : {std::vector<Message>{}, truth_messages(sample::run())}) {
    const std::string bytes = written(messages);
    EXPECT_TRUE(bytes.starts_with(magic));
    EXPECT_TRUE(bytes.ends_with(magic));
  }
}

TEST_F(McapFileTest, the_same_messages_give_the_same_bytes) {
  const std::vector<Message> messages = truth_messages(sample::run());
  EXPECT_EQ(written(messages), written(messages));
}

TEST_F(McapFileTest, a_full_chunk_is_in_the_file_before_the_next_message_comes) {
  McapFile mcap(file, drive_channels(), {.chunk_bytes = 100});
  const std::size_t before = content_of(file).size();
  mcap.write({.channel = 8, .stamp = Stamp(), .content = std::string(120, ' ')});
  EXPECT_GT(content_of(file).size(), before + 50);
}

TEST_F(McapFileTest, a_chunk_spans_no_more_than_its_time) {
  McapFile mcap(file, drive_channels(), {.chunk_time = std::chrono::seconds(1)});
  mcap.write({.channel = 8, .stamp = sample::at_s(1.0), .content = "{}"});
  const std::size_t before = content_of(file).size();
  mcap.write({.channel = 8, .stamp = sample::at_s(1.9), .content = "{}"});
  EXPECT_EQ(content_of(file).size(), before);
  mcap.write({.channel = 8, .stamp = sample::at_s(2.0), .content = "{}"});
  EXPECT_GT(content_of(file).size(), before);
}

TEST_F(McapFileTest, a_folder_that_is_not_there_is_an_input_error) {
  EXPECT_THROW(McapFile("/nowhere/run.mcap", drive_channels()), InputError);
}

TEST_F(McapFileTest, a_full_disk_is_told_and_stops_nobody) {
  McapFile mcap("/dev/full", drive_channels(), {.chunk_bytes = 100});
  mcap.write({.channel = 8, .stamp = Stamp(), .content = std::string(120, ' ')});
  EXPECT_FALSE(mcap.healthy());
}

TEST(DriveMessages, tell_the_truth_of_a_simulated_drive) {
  const std::vector<Message> messages = truth_messages(sample::run());
  ASSERT_EQ(messages.size(), 18U);  // nine poses, nine errors
  const auto last = nlohmann::json::parse(messages.back().content);
  EXPECT_EQ(drive_channels().at(messages.back().channel).topic, "/error");
  EXPECT_EQ(last["timestamp"]["sec"], 4);
  EXPECT_NEAR(last["position_mm"], 80.0, 1e-6);
  EXPECT_NEAR(last["position_sigma_mm"], 20.0, 1e-6);
}

TEST(DriveMessages, tell_the_error_during_a_drive_as_after_it) {
  const RunRecord record = sample::run();
  const Message after = truth_messages(record).back();
  const auto off = nlohmann::json::parse(after.content);
  const TrueError error{.position_m = off["position_mm"].get<double>() / mm_per_m,
                        .heading_rad = radians(off["yaw_deg"].get<double>())};
  const Message during = error_message(record.steps.back().estimate, error);
  EXPECT_EQ(during.channel, after.channel);
  EXPECT_EQ(nlohmann::json::parse(during.content), off);
}

}  // namespace
}  // namespace lodestar

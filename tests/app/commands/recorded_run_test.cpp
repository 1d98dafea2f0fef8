#include "app/commands/recorded_run.hpp"

#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <iterator>

#include "app/commands/kept_runs.hpp"
#include "drivers/can/candump.hpp"
#include "maps/input_error.hpp"

#include "tests/app/sample_run.hpp"
#include "tests/maps/temporary_folder.hpp"

// The run folder of one drive, from its first CAN frame to its report.
namespace lodestar {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

const fs::path lab = fs::path(LODESTAR_SOURCE_DIR) / "sites" / "lab";

StampedCanFrame frame_at(double time_s) {
  return {sample::at_s(time_s), {.id = 0x221, .length = 2, .data = {0x12, 0xab}}};
}

std::string content_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class RecordedDrive : public testing::Test {
 protected:
  RecordedRun recorded(const RunFolderOptions& options) const {
    return {folder_ / "run", site_, site_.default_camera, options};
  }

  TemporaryFolder folder_;
  const Site site_ = load_site(lab);
};

TEST_F(RecordedDrive, leaves_what_went_over_the_bus_under_the_name_of_the_interface) {
  RecordedRun run = recorded({.interface = "can3"});
  const DriveWatcher watcher = run.watcher();
  for (int i = 0; i <= 8; ++i) watcher.can_frame(frame_at(0.5 * i));
  const RunFolderEnd end = run.finish(sample::run());
  EXPECT_THAT(end.loss, IsEmpty());
  EXPECT_TRUE(end.has_report);
  EXPECT_THAT(content_of(folder_ / "run/can.log"), StartsWith("(0000000000.000000) can3 221#12AB\n"));
  const std::vector<LoggedCanFrame> frames = load_candump(folder_ / "run/can.log");
  ASSERT_EQ(frames.size(), 9U);
  EXPECT_EQ(frames[8].received.stamp, sample::at_s(4.0));
  EXPECT_EQ(frames[8].received.frame, frame_at(4.0).frame);
  EXPECT_GT(fs::file_size(folder_ / "run/run.mcap"), 0U);
  EXPECT_GT(fs::file_size(folder_ / "run/report.html"), 0U);
}

TEST_F(RecordedDrive, has_its_can_log_before_the_drive_ends) {
  RecordedRun run = recorded({});
  run.watcher().can_frame(frame_at(1.0));
  for (int tries = 0; fs::file_size(folder_ / "run/can.log") == 0 && tries < 500; ++tries)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(content_of(folder_ / "run/can.log"), "(0000000001.000000) can0 221#12AB\n");
  EXPECT_FALSE(fs::exists(folder_ / "run/report.html"));
}

TEST_F(RecordedDrive, says_what_a_full_disk_did_not_take) {
  bool is_full = false;
  RecordedRun run = recorded({.disk = {.is_full = [&] { return is_full; }}});
  const DriveWatcher watcher = run.watcher();
  watcher.can_frame(frame_at(0.0));
  is_full = true;
  for (int i = 1; i < 4; ++i) watcher.can_frame(frame_at(i));
  is_full = false;
  const RunFolderEnd end = run.finish(sample::run());
  EXPECT_EQ(end.loss, "can.log: 3 of 4 are missing: the disk is full");
  EXPECT_TRUE(end.has_report) << "the disk has space again";
}

TEST_F(RecordedDrive, tells_once_while_it_drives_that_the_folder_is_not_whole) {
  std::vector<std::string> told;
  fs::create_directories(folder_ / "run");
  fs::create_symlink("/dev/full", folder_ / "run/can.log");
  RunFolderEnd end;
  {
    RecordedRun run = recorded({.tell = [&](const std::string& words) { told.push_back(words); }});
    const DriveWatcher watcher = run.watcher();
    for (int i = 0; i < 100; ++i) watcher.can_frame(frame_at(i));
    end = run.finish(sample::run());
  }
  ASSERT_EQ(told.size(), 1U);
  EXPECT_THAT(told.front(), HasSubstr("can.log"));
  EXPECT_THAT(end.loss, StartsWith("can.log: "));
  EXPECT_THAT(end.loss, HasSubstr(told.front()));
}

TEST_F(RecordedDrive, counts_the_pictures_that_are_missing) {
  RunRecord record = sample::run();
  record.dropped_pictures = 2;
  std::promise<std::string> unmade;
  unmade.set_value("");
  record.pictures.push_back({sample::at_s(1.0), unmade.get_future().share()});
  RecordedRun run = recorded({});
  EXPECT_EQ(run.finish(record).loss, "pictures: 3 of 3 are missing");
  EXPECT_TRUE(fs::is_empty(folder_ / "run/pictures"));
}

TEST_F(RecordedDrive, where_no_folder_can_be_made_is_an_input_error) {
  EXPECT_THROW(RecordedRun("/proc/none/run", site_, site_.default_camera, {}), InputError);
}

TEST_F(RecordedDrive, one_after_the_other_each_have_a_folder) {
  {
    KeptRuns runs(folder_ / "run", true, site_, site_.default_camera, {.interface = "can3"});
    const DriveWatcher watcher = runs.watcher();
    for (const double time_s : {1.0, 2.0}) {
      watcher.can_frame(frame_at(time_s));
      runs.keep(sample::run());
    }
    EXPECT_EQ(runs.count(), 2);
    EXPECT_TRUE(runs.finish());
  }
  EXPECT_EQ(content_of(folder_ / "run/can.log"), "(0000000001.000000) can3 221#12AB\n");
  EXPECT_EQ(content_of(folder_ / "run-2/can.log"), "(0000000002.000000) can3 221#12AB\n");
  EXPECT_TRUE(fs::exists(folder_ / "run-2/report.html"));
}

TEST_F(RecordedDrive, goes_on_where_no_folder_can_be_made) {
  KeptRuns runs("/proc/none/run", true, site_, site_.default_camera);
  runs.watcher().can_frame(frame_at(1.0));
  runs.keep(sample::run());
  EXPECT_EQ(runs.count(), 1);
  EXPECT_FALSE(runs.finish()) << "the command's exit code tells of it";
}

}  // namespace
}  // namespace lodestar

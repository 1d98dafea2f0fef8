#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <iterator>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/console/run_archive.hpp"
#include "app/report/run_folder.hpp"
#include "app/site/robot_mount.hpp"
#include "app/site/site.hpp"
#include "maps/atomic_file.hpp"
#include "maps/camera_model.hpp"
#include "maps/input_error.hpp"
#include "maps/map_file.hpp"
#include "maps/marker_registry.hpp"
#include "maps/random.hpp"

#include "tests/app/sample_run.hpp"
#include "tests/maps/temporary_folder.hpp"

// A writer killed at any moment leaves the old or the new file, complete. LODESTAR_KILLS sets how often each
// is killed (default 30; 6 for a run folder, which takes longest to write).
namespace lodestar {
namespace {

namespace fs = std::filesystem;

int kills(int unless_said) {
  const char* const wanted = std::getenv("LODESTAR_KILLS");  // NOLINT(concurrency-mt-unsafe): one thread
  return wanted == nullptr ? unless_said : std::atoi(wanted);
}

std::string content_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Temporary files that a killed writer has left behind.
int orphans(const fs::path& folder) {
  int count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    count += entry.path().filename().string().starts_with(".") ? 1 : 0;
  return count;
}

class Killed : public ::testing::Test {
 protected:
  /// A child saves the states 0, 1, 0, 1, ... until it is killed; then the parent calls `look`.
  void while_saving(const std::function<void(int)>& save, const std::function<void()>& look,
                    int times = kills(30)) {
    Random random(7);
    const auto begin = std::chrono::steady_clock::now();
    save(0);
    const std::chrono::duration<double, std::micro> one_save = std::chrono::steady_clock::now() - begin;
    // Until one came in the middle of a write, too: a busy machine takes longer to get there.
    const auto goes_on = [&](int i) { return i < times || (cut_short_ == 0 && i < 20 * times); };
    for (int i = 0; goes_on(i) && !HasFailure(); ++i) {
      const ::pid_t child = ::fork();
      if (child == 0) {
        for (int state = 1;; state = 1 - state) save(state);
      }
      const double longest_us = 3'000.0 + 2.0 * one_save.count() + (i < times ? 0.0 : 40'000.0);
      ::usleep(static_cast<unsigned>(random.uniform(500.0, longest_us)));
      ::kill(child, SIGKILL);
      ::waitpid(child, nullptr, 0);
      cut_short_ += orphans(folder_ / "");
      look();
    }
  }

  TemporaryFolder folder_;
  int cut_short_ = 0;
};

TEST_F(Killed, while_saving_markers) {
  const auto registry = [](int state) {
    MarkerRegistry result;
    for (int id = 0; id < 200; ++id)
      result.markers.push_back({.id = id, .position_m = {1.0 * state, 2.0, 2.6}});
    return result;
  };
  const fs::path file = folder_ / "markers.yaml";
  while_saving([&](int state) { save_registry(registry(state), file); },
               [&] {
                 const MarkerRegistry read = load_registry(file);
                 ASSERT_EQ(read.markers.size(), 200U);
                 for (const RegisteredMarker& marker : read.markers)
                   EXPECT_EQ(marker.position_m.x(), read.markers.front().position_m.x());
               });
  EXPECT_GT(cut_short_, 0) << "no kill came while the file was written";
  save_registry(registry(0), file);
  EXPECT_EQ(orphans(folder_ / ""), 0) << "the next save removes leftovers";
}

TEST_F(Killed, while_saving_a_map) {
  const auto map = [](int state) {
    OccupancyMap result;
    result.columns = 200 + 100 * state;
    result.rows = 150;
    result.resolution_m = state == 0 ? 0.05 : 0.1;
    result.cells.assign(static_cast<std::size_t>(result.columns) * 150U,
                        state == 0 ? OccupancyMap::free : OccupancyMap::occupied);
    return result;
  };
  const fs::path file = folder_ / "map.yaml";
  while_saving([&](int state) { save_map(map(state), file); },
               [&] {
                 const OccupancyMap read = load_map(file).map;
                 const int state = read.columns == 200 ? 0 : 1;
                 EXPECT_EQ(read.resolution_m, map(state).resolution_m)
                     << "YAML and image are of different maps";
                 EXPECT_EQ(read.cells, map(state).cells);
               });
}

TEST_F(Killed, while_saving_a_calibration) {
  const fs::path camera_file = folder_ / "camera.yaml";
  const fs::path robot_file = folder_ / "robot.yaml";
  fs::copy(fs::path(LODESTAR_SOURCE_DIR) / "sites/lab/robot.yaml", robot_file);
  const auto camera = [](int state) {
    return CameraModel{.width_px = 640,
                       .height_px = 480,
                       .fx_px = 320.0 + state,
                       .fy_px = 320.0 + state,
                       .cx_px = 319.5,
                       .cy_px = 239.5};
  };
  while_saving(
      [&](int state) {
        save_camera(camera(state), "camera", camera_file);
        write_file_atomically(robot_file,
                              with_camera_mount(robot_file, {{"x_m", state == 0 ? "0.125" : "0.25"}}));
      },
      [&] {
        const CameraModel read = load_camera(camera_file);
        EXPECT_EQ(read.fx_px, read.fy_px);
        const double x_m = load_robot(robot_file).base_from_camera.translation().x();
        EXPECT_TRUE(x_m == 0.125 || x_m == 0.25) << x_m;
      });
}

TEST_F(Killed, while_writing_a_run_folder) {
  const fs::path runs = folder_ / "runs";
  RunRecord record = sample::run();
  while_saving(
      [&](int state) {
        record.seed = static_cast<std::uint64_t>(state);
        write_run_folder(runs / "run", record, sample::floor(), sample::ceiling());
      },
      [&] {
        const RunArchive archive(runs);
        ASSERT_EQ(archive.names().size(), 1U);
        EXPECT_EQ(archive.run("run")->at("truth").size(), 9U);
      },
      kills(6));
}

/// Simulates a full disk: each file may grow to this size, then writing fails.
void fill_up(rlim_t bytes) {
  ::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{.rlim_cur = bytes, .rlim_max = bytes};
  ::setrlimit(RLIMIT_FSIZE, &limit);
}

/// Runs in a child process, as limits cannot be raised again; returns its exit code.
int in_child(const std::function<int()>& work) {
  const ::pid_t child = ::fork();
  if (child == 0) ::_exit(work());
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(FullDisk, leaves_the_old_file_and_says_so) {
  const TemporaryFolder folder;
  const fs::path file = folder / "markers.yaml";
  MarkerRegistry registry{.map_from_registry = {}, .markers = {{.id = 5, .position_m = {1.0, 2.0, 2.6}}}};
  save_registry(registry, file);
  const std::string before = content_of(file);
  for (int id = 100; id < 200; ++id) registry.markers.push_back({.id = id, .position_m = {1.0, 2.0, 2.6}});
  const int refused = in_child([&] {
    fill_up(1000);
    try {
      save_registry(registry, file);
    } catch (const InputError&) {
      return 7;
    }
    return 0;
  });
  EXPECT_EQ(refused, 7);
  EXPECT_EQ(content_of(file), before);
  EXPECT_EQ(orphans(folder / ""), 0);
}

TEST(FullDisk, costs_a_drive_its_record_and_no_more) {
  const TemporaryFolder folder;
  const int written = in_child([&] {
    fill_up(100);
    try {
      write_run_folder(folder / "run", sample::run(), sample::floor(), sample::ceiling());
    } catch (const InputError&) {
      return 7;
    }
    return 1;
  });
  EXPECT_EQ(written, 7);
  EXPECT_TRUE(RunArchive(folder / "").names().empty());
}

}  // namespace
}  // namespace lodestar

#include "app/recording/run_origin.hpp"

#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "maps/input_error.hpp"
#include "maps/map_file.hpp"

#include "tests/app/sample_run.hpp"
#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

TEST(RunOrigin, is_read_as_it_was_written_with_the_map_and_the_markers) {
  const TemporaryFolder folder;
  const RunOrigin written{.started = "2026-11-26T09:05:00Z",
                          .program = "0.1.0",
                          .site = "hall \"2\": \\ north",
                          .seed = 18446744073709551615U};
  write_run_origin(folder / "run", written, sample::floor(), sample::ceiling());
  const RunOrigin read = read_run_origin(folder / "run").value();
  EXPECT_EQ(read.started, written.started);
  EXPECT_EQ(read.program, written.program);
  EXPECT_EQ(read.site, written.site);
  EXPECT_EQ(read.seed, written.seed);
  EXPECT_FALSE(read.clock_offset) << "of a simulated drive";
  EXPECT_EQ(load_map(folder / "run" / map_of_run).map.cells, sample::floor().cells);
  EXPECT_EQ(load_registry(folder / "run" / markers_of_run).markers.at(0).id, 77);
}

TEST(RunOrigin, of_a_real_drive_has_no_seed_and_that_of_an_older_one_is_nothing) {
  const TemporaryFolder folder;
  const Duration offset = std::chrono::microseconds(1764061500123456);
  write_run_origin(folder / "run",
                   {.started = "2026-11-26T09:05:00Z", .program = "1", .site = "lab", .clock_offset = offset},
                   sample::floor(), sample::ceiling());
  const RunOrigin read = read_run_origin(folder / "run").value();
  EXPECT_FALSE(read.seed);
  EXPECT_NEAR(seconds(read.clock_offset.value() - offset), 0.0, 1e-6);
  EXPECT_FALSE(read_run_origin(folder / "older"));
}

TEST(RunOrigin, that_is_wrong_is_refused_with_its_line) {
  const TemporaryFolder folder;
  std::ofstream(folder / "run.yaml")
      << "format: lodestar-run\nversion: 1\nstarted: now\nprogram: 1\nsite: a\n"
      << "seed: -1\n";
  try {
    (void)read_run_origin(folder.path());
    FAIL() << "a negative seed was taken";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("run.yaml:6: found '-1'"));
  }
}

}  // namespace
}  // namespace lodestar

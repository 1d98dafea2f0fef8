#include "maps/movingai_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "maps/input_error.hpp"

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

const std::string small_map = "type octile\nheight 2\nwidth 3\nmap\n.@G\nSTW\n";

template <typename Load>
std::string complaint_of(Load load) {
  try {
    load();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no complaint";
}

TEST(MovingAiMap, reads_the_terrain_with_its_first_line_as_row_0) {
  const TemporaryFolder folder;
  const OccupancyMap map = load_movingai_map(folder.write("small.map", small_map));
  EXPECT_EQ(map.columns, 3);
  EXPECT_EQ(map.rows, 2);
  EXPECT_EQ(map.resolution_m, 1.0);
  EXPECT_TRUE(is_drivable(map.at({0, 0})));
  EXPECT_FALSE(is_drivable(map.at({1, 0})));
  EXPECT_TRUE(is_drivable(map.at({2, 0})));
  EXPECT_TRUE(is_drivable(map.at({0, 1})));
  EXPECT_FALSE(is_drivable(map.at({1, 1})));
  EXPECT_FALSE(is_drivable(map.at({2, 1})));
}

TEST(MovingAiMap, reads_lines_that_end_as_on_windows) {
  const TemporaryFolder folder;
  EXPECT_EQ(
      load_movingai_map(folder.write("a.map", "type octile\r\nheight 1\r\nwidth 1\r\nmap\r\n.\r\n")).rows, 1);
}

TEST(MovingAiMap, says_in_which_line_it_is_broken) {
  const TemporaryFolder folder;
  const auto complaint = [&](const std::string& text) {
    return complaint_of([&] { (void)load_movingai_map(folder.write("bad.map", text)); });
  };
  using testing::HasSubstr;
  EXPECT_THAT(complaint("type hex\n"), HasSubstr("bad.map:1: found 'type hex', wanted 'type octile'"));
  EXPECT_THAT(complaint("type octile\nheight x\n"), HasSubstr("bad.map:2: found 'height x'"));
  EXPECT_THAT(complaint("type octile\nheight 2\nwidth 0\n"), HasSubstr("bad.map:3: found 'width 0'"));
  EXPECT_THAT(complaint("type octile\nheight 1\nwidth 99999999\n"), HasSubstr("bad.map:3"));
  EXPECT_THAT(complaint("type octile\nheight 1\nwidth 2\nmap\n.\n"), HasSubstr("bad.map:5: found 1 cells"));
  EXPECT_THAT(complaint("type octile\nheight 1\nwidth 2\nmap\n.x\n"),
              HasSubstr("bad.map:5: found terrain 'x'"));
  EXPECT_THAT(complaint("type octile\nheight 2\nwidth 1\nmap\n.\n"), HasSubstr("bad.map:6: found the end"));
  EXPECT_THAT(complaint_of([&] { (void)load_movingai_map(folder / "none.map"); }), HasSubstr("none.map"));
}

TEST(MovingAiQueries, are_read_with_their_length) {
  const TemporaryFolder folder;
  const OccupancyMap map = load_movingai_map(folder.write("small.map", small_map));
  const auto queries = load_movingai_queries(
      folder.write("small.scen", "version 1.0\n0\tsmall.map\t3\t2\t0\t0\t0\t1\t1.00000000\n\n"), map);
  ASSERT_EQ(queries.size(), 1U);
  EXPECT_EQ(queries[0].start, (Cell{0, 0}));
  EXPECT_EQ(queries[0].goal, (Cell{0, 1}));
  EXPECT_EQ(queries[0].expected_length, 1.0);
  EXPECT_DOUBLE_EQ(queries[0].rounding, 0.5e-8);
}

TEST(MovingAiQueries, know_how_their_length_was_rounded) {
  const TemporaryFolder folder;
  const OccupancyMap map = load_movingai_map(folder.write("small.map", small_map));
  const auto rounding = [&](const std::string& length) {
    return load_movingai_queries(folder.write("a.scen", "version 1\n0 a 3 2 0 0 0 1 " + length + "\n"), map)
        .at(0)
        .rounding;
  };
  EXPECT_DOUBLE_EQ(rounding("2006.4"), 0.005) << "2006.40 in six digits";
  EXPECT_DOUBLE_EQ(rounding("2006.39610307"), 0.5e-8);
  EXPECT_DOUBLE_EQ(rounding("3.82843"), 0.5e-5);
}

TEST(MovingAiQueries, say_in_which_line_they_are_broken) {
  const TemporaryFolder folder;
  const OccupancyMap map = load_movingai_map(folder.write("small.map", small_map));
  const auto complaint = [&](const std::string& text) {
    return complaint_of([&] { (void)load_movingai_queries(folder.write("bad.scen", text), map); });
  };
  using testing::HasSubstr;
  EXPECT_THAT(complaint("version 2\n"), HasSubstr("bad.scen:1: found 'version 2', wanted 'version 1'"));
  EXPECT_THAT(complaint("version 1\n0 a 3 2 0 0\n"), HasSubstr("bad.scen:2: found 6 fields"));
  EXPECT_THAT(complaint("version 1\n0 a 3 9 0 0 0 1 1\n"), HasSubstr("bad.scen:2: found a map of 3 x 9"));
  EXPECT_THAT(complaint("version 1\n0 a 3 2 0 q 0 1 1\n"), HasSubstr("bad.scen:2: found 'q'"));
  EXPECT_THAT(complaint("version 1\n0 a 3 2 1 0 0 1 1\n"),
              HasSubstr("bad.scen:2: found 1 0, wanted a free cell"));
  EXPECT_THAT(complaint("version 1\n0 a 3 2 0 0 3 0 1\n"), HasSubstr("bad.scen:2: found 3 0"));
  EXPECT_THAT(complaint("version 1\n0 a 3 2 0 0 0 1 -1\n"), HasSubstr("bad.scen:2: found length '-1'"));
  EXPECT_THAT(complaint(""), HasSubstr("bad.scen:1: found the end of the file"));
}

}  // namespace
}  // namespace lodestar

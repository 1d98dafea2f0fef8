#include "app/site/arguments.hpp"

#include <gtest/gtest.h>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

TEST(Arguments, read_points_and_goals) {
  EXPECT_EQ(parse_point("--start", "1.5,-2"), Vec2(1.5, -2.0));
  EXPECT_FALSE(parse_goal("--goal", "1,2").heading_rad.has_value());
  EXPECT_DOUBLE_EQ(*parse_goal("--goal", "1,2,90").heading_rad, radians(90.0));
  EXPECT_DOUBLE_EQ(*parse_goal("--goal", "1,2,450").heading_rad, radians(90.0));
}

TEST(Arguments, refuse_what_is_no_place) {
  for (const char* text :
       {"", "1", "1,", ",1", "1,2,3,4", "1;2", "x,y", "1,2m", "inf,0", "1,nan", " 1,2", "1e999,0"}) {
    EXPECT_THROW((void)parse_goal("--goal", text), InputError) << text;
  }
  EXPECT_THROW((void)parse_point("--start", "1,2,3"), InputError);
}

}  // namespace
}  // namespace lodestar

#include "app/site/arguments.hpp"

#include <gmock/gmock.h>

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

TEST(Arguments, read_the_name_of_a_place_as_a_goal) {
  const Places places{.places = {{"desk", {1.0, 2.0}, radians(90.0)}, {"Dock 2", {3.0, 4.0}, std::nullopt}}};
  EXPECT_EQ(parse_goal("--goal", "desk", places).position_m, Vec2(1.0, 2.0));
  EXPECT_DOUBLE_EQ(*parse_goal("--goal", "desk", places).heading_rad, radians(90.0));
  EXPECT_FALSE(parse_goal("--goal", "Dock 2", places).heading_rad);
  EXPECT_EQ(parse_goal("--goal", "5,6", places).position_m, Vec2(5.0, 6.0));
}

TEST(Arguments, say_which_names_are_spelt_most_like_an_unknown_one) {
  const auto refusal = [](const std::string& text, const Places& places) -> std::string {
    try {
      (void)parse_goal("--goal", text, places);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  Places places;
  for (const char* name : {"kitchen", "door", "dock", "Desk", "lift"})
    places.places.push_back({name, Vec2::Zero(), std::nullopt});
  EXPECT_THAT(refusal("deck", places), testing::EndsWith("a place such as 'dock', 'Desk', 'door'"));
  EXPECT_THAT(refusal("", places), testing::HasSubstr("found ''"));
  EXPECT_THAT(refusal("1,2,3,4", places), testing::EndsWith("metres and degrees"));  // no name
  EXPECT_THAT(refusal("deck", {}), testing::EndsWith("metres and degrees"));
}

}  // namespace
}  // namespace lodestar

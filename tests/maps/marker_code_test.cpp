#include "maps/marker_code.hpp"

#include <algorithm>
#include <bit>
#include <gtest/gtest.h>
#include <set>

namespace lodestar {
namespace {

// An independent reader of the grid for comparison: patterns as text, turned character by character.
using Picture = std::vector<std::string>;

Picture picture_of(int id) {
  Picture picture(4, "....");
  for (const GridCell cell : dots_of(id))
    picture[static_cast<std::size_t>(cell.row)][static_cast<std::size_t>(cell.column)] = 'o';
  return picture;
}

Picture rows_as_columns(const Picture& picture) {
  Picture result(4, "....");
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 4; ++column) result[column][row] = picture[row][column];
  }
  return result;
}

Picture upside_down(const Picture& picture) {
  return {picture.rbegin(), picture.rend()};
}

int differences(const Picture& a, const Picture& b) {
  int count = 0;
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 4; ++column) count += a[row][column] != b[row][column] ? 1 : 0;
  }
  return count;
}

/// Swapping rows with columns and turning upside down, alternately, goes through all eight views and back.
int least_over_other_views(int a, int b) {
  int least = 16;
  Picture view = picture_of(b);
  for (int i = 0; i < 7; ++i) {
    view = i % 2 == 0 ? rows_as_columns(view) : upside_down(view);
    least = std::min(least, differences(picture_of(a), view));
  }
  return least;
}

void expect_code(const std::vector<int>& ids, const MarkerCodeOptions& options) {
  EXPECT_TRUE(std::ranges::is_sorted(ids));
  EXPECT_EQ(std::set<int>(ids.begin(), ids.end()).size(), ids.size());
  for (const int a : ids) {
    ASSERT_GE(static_cast<int>(dots_of(a).size()), options.min_dots) << a;
    for (const int b : ids) {
      if (a != b) {
        ASSERT_GE(std::popcount(static_cast<unsigned>(a ^ b)), options.min_distance) << a << " " << b;
      }
      if (options.all_views) {
        ASSERT_GE(least_over_other_views(a, b), options.min_distance) << a << " " << b;
      }
    }
  }
}

TEST(MarkerCode, a_quarter_turn_takes_the_empty_corner_from_top_right_to_top_left) {
  // Marker 0 is O, X and Y: bottom left, bottom right, top left.
  EXPECT_EQ(pattern_of(0), 0b1001'0000'0000'0001);
  EXPECT_EQ(pattern_of(0, {.quarter_turns = 1, .mirrored = false}), 0b1001'0000'0000'1000);
  EXPECT_EQ(pattern_of(0, {.quarter_turns = 0, .mirrored = true}), pattern_of(0)) << "X and Y change places";
}

TEST(MarkerCode, distance_over_the_other_views_agrees_with_pictures_turned_by_hand) {
  for (const auto& [a, b] :
       std::vector<std::pair<int, int>>{{0, 0}, {447, 447}, {447, 1782}, {5, 6}, {4095, 0}, {1, 4}}) {
    EXPECT_EQ(turned_distance(a, b), least_over_other_views(a, b)) << a << " " << b;
    EXPECT_EQ(is_turned(a, b), turned_distance(a, b) == 0) << a << " " << b;
  }
}

TEST(MarkerCode, of_1_and_4_the_one_is_the_mirror_image_of_the_other) {
  // Bit 001 is the cell above O, bit 004 the one to its right.
  EXPECT_EQ(id_distance(1, 4), 2);
  EXPECT_EQ(turned_distance(1, 4), 0);
  EXPECT_GT(turned_distance(1, 1), 0);
  EXPECT_EQ(turned_distance(5, 5), 0) << "with both cells, its own mirror image";
}

TEST(MarkerCode, reaches_the_linear_codes_where_views_do_not_count) {
  for (const auto& [distance, largest] : std::vector<std::pair<int, int>>{{2, 2038}, {3, 256}, {4, 128}}) {
    const MarkerCodeOptions options{.min_distance = distance, .all_views = false};
    const std::vector<int> ids = choose_marker_ids(largest, {}, options);
    EXPECT_EQ(static_cast<int>(ids.size()), largest);
    expect_code(ids, options);
  }
}

TEST(MarkerCode, has_every_id_at_distance_1_but_those_with_few_dots) {
  const MarkerCodeOptions options{.min_distance = 1, .min_dots = 5, .all_views = false};
  EXPECT_EQ(choose_marker_ids(4096 - 1 - 12, {}, options).size(), 4096U - 1 - 12);
}

TEST(MarkerCode, keeps_apart_turned_and_mirrored_views_too) {
  for (const auto& [distance, enough] : std::vector<std::pair<int, std::size_t>>{{3, 100}, {4, 64}}) {
    const MarkerCodeOptions options{.min_distance = distance};
    const std::vector<int> ids = choose_marker_ids(marker_id_count, {}, options);
    EXPECT_GE(ids.size(), enough) << "at distance " << distance;
    expect_code(ids, options);
  }
}

TEST(MarkerCode, is_the_same_for_the_same_seed_and_another_for_another) {
  const MarkerCodeOptions one{.seed = 1};
  const MarkerCodeOptions two{.seed = 2};
  EXPECT_EQ(choose_marker_ids(30, {}, one), choose_marker_ids(30, {}, one));
  EXPECT_NE(choose_marker_ids(30, {}, one), choose_marker_ids(30, {}, two));
}

TEST(MarkerCode, keeps_away_from_ids_that_are_taken) {
  const std::vector<int> taken{447, 1782, 988};
  const MarkerCodeOptions options{.min_distance = 4};
  const std::vector<int> ids = choose_marker_ids(25, taken, options);
  ASSERT_EQ(ids.size(), 25U);
  for (const int id : ids) {
    for (const int other : taken) {
      EXPECT_GE(id_distance(id, other), 4);
      EXPECT_GE(least_over_other_views(id, other), 4);
    }
  }
}

TEST(MarkerCode, of_a_larger_site_is_a_weaker_one) {
  const std::vector<int> few = choose_marker_ids(60, {});
  EXPECT_EQ(few.size(), 60U);
  expect_code(few, {.min_distance = 3});
  const std::vector<int> more = choose_marker_ids(200, {});
  EXPECT_EQ(more.size(), 200U);
  expect_code(more, {.min_distance = 3, .all_views = false});
  const std::vector<int> many = choose_marker_ids(1000, {});
  EXPECT_EQ(many.size(), 1000U);
  expect_code(many, {.min_distance = 2, .all_views = false});
}

TEST(MarkerCode, finds_none_where_there_is_none) {
  EXPECT_TRUE(choose_marker_ids(5, {}, {.min_distance = 3, .min_dots = 16}).empty());
  EXPECT_TRUE(choose_marker_ids(0, {}, {}).empty());
}

}  // namespace
}  // namespace lodestar

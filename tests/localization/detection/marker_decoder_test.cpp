#include "localization/detection/marker_decoder.hpp"

#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <utility>

#include "tests/localization/painted_frame.hpp"

// Dots at exact positions, as a camera would see them; no image is drawn.
namespace lodestar {
namespace {

const CameraModel camera = paper_camera();

Dot dot_seen(const MarkerView& view, GridCell cell) {
  Dot dot;
  dot.center_px = dot_in_image(camera, view, cell);
  dot.radius_px = marker_dot_radius_m * camera.fx_px / view.depth_m * std::sqrt(std::cos(view.tilt_rad));
  return dot;
}

std::vector<Dot> dots_seen(const MarkerView& view, std::vector<GridCell> cells, Random& random) {
  for (std::size_t i = cells.size(); i > 1; --i) std::swap(cells[i - 1], cells[random.below(i)]);
  std::vector<Dot> dots;
  for (const GridCell cell : cells) dots.push_back(dot_seen(view, cell));
  return dots;
}

MarkerView random_view(Random& random, double most_tilt_deg) {
  return {.middle_px = {random.uniform(60.0, 580.0), random.uniform(60.0, 420.0)},
          .depth_m = random.uniform(1.2, 3.0),
          .turn_rad = radians(random.uniform(0.0, 360.0)),
          .tilt_rad = radians(random.uniform(0.0, most_tilt_deg)),
          .tilt_axis_rad = radians(random.uniform(0.0, 360.0))};
}

std::vector<MarkerReading> read_area(std::span<const Dot> dots) {
  AreaReader reader;
  const std::span<const MarkerReading> readings = reader.read(dots);
  return {readings.begin(), readings.end()};
}

std::vector<int> ids(const std::vector<MarkerReading>& readings) {
  std::vector<int> result;
  for (const MarkerReading& reading : readings) result.push_back(reading.id);
  return result;
}

/// Markers of three or four dots are read only when they look nearly upright.
double most_tilt_deg(int id) {
  return dots_of(id).size() < 5 ? 3.0 : 20.0;
}

/// The ID of a marker whose print is mirrored about the diagonal through O.
int transposed(int id) {
  int result = 0;
  for (int row = 0; row < marker_grid_size; ++row) {
    for (int column = 0; column < marker_grid_size; ++column) {
      const GridCell mirrored{marker_grid_size - 1 - column, marker_grid_size - 1 - row};
      if ((id & id_bit({row, column})) != 0) result |= id_bit(mirrored);
    }
  }
  return result;
}

TEST(MarkerDecoder, reads_the_markers_of_the_paper) {
  // Y first row, O and X last row; Q(i, j) of Eq. (9).
  const auto id_of_print = [](const std::array<std::string, 4>& print) {
    std::vector<MarkerDot> dots;
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 4; ++column) {
        if (print[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] == '1') {
          dots.push_back({{row, column}, Vec2::Zero()});
        }
      }
    }
    return id_of(dots);
  };
  EXPECT_EQ(id_of_print({"0110", "1100", "0011", "0110"}), 1782);
  EXPECT_EQ(id_of_print({"0100", "1110", "1110", "0100"}), 447);
}

TEST(MarkerDecoder, reads_every_id_at_any_turn_and_moderate_tilt) {
  Random random(1);
  for (int id = 0; id < marker_id_count; ++id) {
    const MarkerView view = random_view(random, most_tilt_deg(id));
    const std::vector<Dot> dots = dots_seen(view, dots_of(id), random);
    const std::vector<MarkerReading> readings = read_area(dots);
    ASSERT_THAT(ids(readings), testing::ElementsAre(id));
    ASSERT_EQ(readings.front().dots.size(), dots.size());
    for (const MarkerDot& dot : readings.front().dots) {
      EXPECT_LT((dot.center_px - dot_in_image(camera, view, dot.cell)).norm(), 1e-9) << "ID " << id;
    }
  }
}

TEST(MarkerDecoder, finds_the_direction_dots_by_the_papers_rule_below_30_degrees) {
  Random random(2);
  for (int id = 0; id < marker_id_count; ++id) {
    MarkerView view = random_view(random, 30.0);
    view.middle_px = {320.0, 240.0};
    const std::vector<Dot> dots = dots_seen(view, dots_of(id), random);
    const auto found = direction_dots(dots);
    ASSERT_TRUE(found);
    EXPECT_EQ(dots[found->o].center_px, dot_in_image(camera, view, cell_of_o)) << "ID " << id;
    EXPECT_EQ(dots[found->x].center_px, dot_in_image(camera, view, cell_of_x)) << "ID " << id;
    EXPECT_EQ(dots[found->y].center_px, dot_in_image(camera, view, cell_of_y)) << "ID " << id;
  }
}

TEST(MarkerDecoder, knows_where_the_empty_cells_are) {
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    const auto id = static_cast<int>(random.below(marker_id_count));
    const MarkerView view = random_view(random, most_tilt_deg(id));
    const std::vector<MarkerReading> readings = read_area(dots_seen(view, dots_of(id), random));
    ASSERT_EQ(readings.size(), 1U);
    for (int row = 0; row < marker_grid_size; ++row) {
      for (int column = 0; column < marker_grid_size; ++column) {
        const Vec2 place = readings.front().grid.center_px({row, column});
        EXPECT_LT((place - dot_in_image(camera, view, {row, column})).norm(),
                  0.1 * readings.front().grid.pitch_px());
      }
    }
  }
}

TEST(MarkerDecoder, refuses_every_id_that_lacks_a_direction_dot) {
  Random random(4);
  for (int id = 0; id < marker_id_count; ++id) {
    for (const GridCell lost : {cell_of_o, cell_of_x, cell_of_y}) {
      std::vector<GridCell> cells = dots_of(id);
      std::erase(cells, lost);
      EXPECT_THAT(read_area(dots_seen(random_view(random, 20.0), cells, random)), testing::IsEmpty())
          << "ID " << id;
    }
  }
}

TEST(MarkerDecoder, a_mirrored_print_is_the_marker_with_the_transposed_id) {
  Random random(5);
  for (int id = 0; id < marker_id_count; ++id) {
    const MarkerView view = random_view(random, most_tilt_deg(id));
    std::vector<Dot> dots = dots_seen(view, dots_of(id), random);
    for (Dot& dot : dots) dot.center_px.x() = camera.width_px - dot.center_px.x();
    EXPECT_THAT(ids(read_area(dots)), testing::ElementsAre(transposed(id)));
  }
}

TEST(MarkerDecoder, refuses_a_dot_that_stands_in_no_cell) {
  Random random(6);
  const MarkerView view = random_view(random, 10.0);
  std::vector<Dot> dots = dots_seen(view, dots_of(1782), random);
  Dot glint = dots.front();
  glint.center_px = 0.5 * (dot_in_image(camera, view, {1, 1}) + dot_in_image(camera, view, {2, 2}));
  dots.push_back(glint);
  EXPECT_THAT(read_area(dots), testing::IsEmpty());
}

TEST(MarkerDecoder, refuses_a_dot_in_the_corner_opposite_o) {
  Random random(7);
  const MarkerView view = random_view(random, 10.0);
  std::vector<Dot> dots = dots_seen(view, dots_of(447), random);
  dots.push_back(dot_seen(view, cell_always_empty));
  EXPECT_THAT(read_area(dots), testing::IsEmpty());
}

TEST(MarkerDecoder, refuses_dots_of_unlike_size) {
  Random random(8);
  const MarkerView view = random_view(random, 10.0);
  std::vector<Dot> dots = dots_seen(view, dots_of(1782), random);
  dots[4].radius_px *= 1.3;
  EXPECT_THAT(read_area(dots), testing::IsEmpty());
}

TEST(MarkerDecoder, refuses_dots_too_large_or_small_for_the_pitch) {
  Random random(9);
  const MarkerView view = random_view(random, 10.0);
  for (const double factor : {0.7, 1.5}) {
    std::vector<Dot> dots = dots_seen(view, dots_of(0), random);
    for (Dot& dot : dots) dot.radius_px *= factor;
    EXPECT_THAT(read_area(dots), testing::IsEmpty());
  }
}

TEST(MarkerDecoder, refuses_one_cell_with_two_dots) {
  Random random(10);
  const MarkerView view = random_view(random, 10.0);
  std::vector<Dot> dots = dots_seen(view, dots_of(447), random);
  dots.push_back(dot_seen(view, {1, 1}));
  dots.back().center_px.x() += 0.1;
  EXPECT_THAT(read_area(dots), testing::IsEmpty());
}

TEST(MarkerDecoder, of_too_few_dots_or_too_many_reads_nothing) {
  Random random(11);
  const MarkerView view = random_view(random, 10.0);
  EXPECT_FALSE(direction_dots({}));
  EXPECT_THAT(read_area({}), testing::IsEmpty());
  EXPECT_THAT(read_area(dots_seen(view, {cell_of_o, cell_of_x}, random)), testing::IsEmpty());
  EXPECT_THAT(read_area(std::vector<Dot>(3, dot_seen(view, cell_of_o))), testing::IsEmpty());
  EXPECT_THAT(read_area(std::vector<Dot>(100, dot_seen(view, cell_of_o))), testing::IsEmpty());
}

// Centres 25 cm apart: the nearest dots of the two may be 2 pitches from each other.
TEST(MarkerDecoder, reads_two_markers_that_dilation_joined) {
  Random random(12);
  int read = 0;
  const int pairs = 400;
  for (int i = 0; i < pairs; ++i) {
    MarkerView left = random_view(random, 5.0);
    left.middle_px = {250.0, 240.0};
    MarkerView right = left;
    right.turn_rad = radians(random.uniform(0.0, 360.0));
    right.middle_px.x() += 0.25 * camera.fx_px / left.depth_m;
    const std::array<int, 2> truth{static_cast<int>(random.below(marker_id_count)),
                                   static_cast<int>(random.below(marker_id_count))};
    std::vector<Dot> dots = dots_seen(left, dots_of(truth[0]), random);
    for (const Dot& dot : dots_seen(right, dots_of(truth[1]), random)) dots.push_back(dot);
    const std::vector<MarkerReading> readings = read_area(dots);
    for (const MarkerReading& reading : readings) EXPECT_THAT(truth, testing::Contains(reading.id));
    read += readings.size() == 2 ? 1 : 0;
  }
  EXPECT_GT(read, pairs * 9 / 10);
}

TEST(MarkerDecoder, reads_a_marker_beside_which_a_glint_lies) {
  Random random(13);
  const MarkerView view{.middle_px = {300.0, 200.0}, .depth_m = 2.0};
  std::vector<Dot> dots = dots_seen(view, dots_of(1782), random);
  Dot glint = dots.front();
  glint.center_px = dot_in_image(camera, view, cell_of_x) + Vec2(3.0 * glint.radius_px * 4.0, 0.0);
  dots.push_back(glint);
  EXPECT_THAT(ids(read_area(dots)), testing::ElementsAre(1782));
}

}  // namespace
}  // namespace lodestar

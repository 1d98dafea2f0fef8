#include "app/placement/board_choice.hpp"

#include <gtest/gtest.h>

#include "tests/localization/board_picture.hpp"

// The views of a board that are taken while somebody moves it before a camera.
namespace lodestar {
namespace {

const CameraModel camera{640, 480, 400.0, 400.0, 320.0, 240.0, Distortion::plumb_bob, {-0.2, 0.05, 0, 0, 0}};

/// Half a metre away, so far to the right, as corners found to a tenth of a pixel.
BoardView view_at(double right_m, Random& random) {
  Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
  place.translation() << right_m - 0.1, -0.08, 0.5;
  return testing::ideal_view(camera, 8, 6, 0.03, place, 0.05, random);
}

TEST(BoardChoice, takes_each_place_once_and_only_when_the_board_is_still) {
  Random random(3);
  BoardChoice choice(camera.width_px);
  EXPECT_FALSE(choice.takes(view_at(0.0, random))) << "it may be moving";
  EXPECT_TRUE(choice.takes(view_at(0.0, random)));
  EXPECT_FALSE(choice.takes(view_at(0.0, random))) << "taken already";
  for (int i = 1; i <= 20; ++i) EXPECT_FALSE(choice.takes(view_at(0.005 * i, random))) << "on its way";
  EXPECT_TRUE(choice.takes(view_at(0.1, random)));
  EXPECT_FALSE(choice.takes(view_at(0.11, random)));
  EXPECT_FALSE(choice.takes(view_at(0.11, random))) << "8 px from a place that was taken";
  EXPECT_FALSE(choice.takes(view_at(0.0, random)));
  EXPECT_FALSE(choice.takes(view_at(0.0, random))) << "back at the first";
}

TEST(BoardChoice, takes_nothing_right_after_the_board_was_out_of_view) {
  Random random(4);
  BoardChoice choice(camera.width_px);
  EXPECT_FALSE(choice.takes(std::nullopt));
  EXPECT_FALSE(choice.takes(view_at(0.0, random)));
  EXPECT_FALSE(choice.takes(std::nullopt));
  EXPECT_FALSE(choice.takes(view_at(0.0, random)));
  EXPECT_TRUE(choice.takes(view_at(0.0, random)));
}

/// Of a ChArUco board each view may show another part.
TEST(BoardChoice, takes_another_part_of_the_board_as_another_view) {
  Random random(5);
  const auto part = [&](std::size_t from, std::size_t to) {
    const BoardView whole = view_at(0.0, random);
    BoardView some;
    for (std::size_t i = from; i < to; ++i) {
      some.points_m.push_back(whole.points_m[i]);
      some.pixels.push_back(whole.pixels[i]);
    }
    return some;
  };
  BoardChoice choice(camera.width_px);
  choice.takes(part(0, 20));
  EXPECT_TRUE(choice.takes(part(0, 20)));
  EXPECT_FALSE(choice.takes(part(10, 30))) << "at the same place";
  choice.takes(part(30, 48));
  EXPECT_TRUE(choice.takes(part(30, 48)));
}

}  // namespace
}  // namespace lodestar

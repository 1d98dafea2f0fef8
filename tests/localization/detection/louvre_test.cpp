#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <utility>
#include <vector>

#include "localization/detection/dark_line.hpp"
#include "localization/detection/frame_noise.hpp"

#include "tests/localization/detection/detector_frames.hpp"

// Markers on slats between dark slots that are about as wide as a dot.
namespace lodestar {
namespace {

constexpr int side_px = 160;
constexpr int registered_ids = 25;

struct Louvre {
  double slat_gray = 0.0;
  double slot_gray = 0.0;
  double period_m = 0.0;
  double slot_m = 0.0;
  double turn_rad = 0.0;
  double shift = 0.0;  ///< of the slots, in periods
};

Louvre some_louvre(Random& random) {
  Louvre louvre{.slat_gray = random.uniform(90.0, 140.0),
                .slot_gray = 0.0,
                .period_m = random.uniform(0.02, 0.04),
                .slot_m = 0.0,
                .turn_rad = random.uniform(0.0, radians(180.0)),
                .shift = random.uniform(0.0, 1.0)};
  louvre.slot_gray = louvre.slat_gray * random.uniform(0.15, 0.45);
  louvre.slot_m = louvre.period_m * random.uniform(0.3, 0.5);
  return louvre;
}

MarkerView some_marker_view(Random& random) {
  return {.middle_px = {random.uniform(77.0, 83.0), random.uniform(77.0, 83.0)},
          .depth_m = random.uniform(1.8, 3.0),
          .turn_rad = random.uniform(0.0, radians(360.0))};
}

PaintedFrame painted(const Louvre& louvre, double px_per_m) {
  PaintedFrame frame({side_px, side_px}, louvre.slat_gray);
  const Vec2 along(std::cos(louvre.turn_rad), std::sin(louvre.turn_rad));
  const Vec2 across(-along.y(), along.x());
  const Vec2 middle(0.5 * side_px, 0.5 * side_px);
  const double period_px = louvre.period_m * px_per_m;
  const auto slots = static_cast<int>(side_px / period_px);
  for (int i = -slots; i <= slots; ++i) {
    const Vec2 on_slot = middle + (i + louvre.shift) * period_px * across;
    frame.tube(on_slot - side_px * along, on_slot + side_px * along, louvre.slot_m * px_per_m,
               louvre.slot_gray);
  }
  return frame;
}

std::vector<int> some_other_ids(int id) {
  std::vector<int> ids{id};
  for (int i = 1; i < registered_ids; ++i) ids.push_back((id + 797 * i) % marker_id_count);
  return ids;
}

/// Those that differ by one dot first.
std::vector<int> ids_alike(int id) {
  std::vector<int> ids{id};
  for (int bit = 1; bit < marker_id_count; bit *= 2) ids.push_back(id ^ bit);
  return ids;
}

DetectorOptions expecting_ids(std::vector<int> ids) {
  DetectorOptions options;
  options.registered_ids = std::move(ids);
  return options;
}

struct Tally {
  int right = 0;
  int wrong = 0;
};

void count(const std::vector<DetectedMarker>& found, int id, Tally& tally) {
  for (const DetectedMarker& marker : found) ++(marker.id == id ? tally.right : tally.wrong);
}

cv::Mat finished(const PaintedFrame& frame, Random& random) {
  return frame.finished(random, random.uniform(1.0, 4.0), random.uniform(0.5, 0.9));
}

// Slots taken for the background, cells over them for covered, and slats for noise, cost every sixth.
TEST(Louvre, markers_on_it_are_read) {
  constexpr int frames = 300;
  Random random(3);
  const CameraModel camera = cropped(paper_camera(), side_px);
  Tally tally;
  for (int i = 0; i < frames; ++i) {
    const MarkerView view = some_marker_view(random);
    const int id = random_id(random);
    PaintedFrame frame = painted(some_louvre(random), camera.fx_px / view.depth_m);
    frame.marker(camera, view, id);
    count(detect_markers(finished(frame, random), expecting_ids(some_other_ids(id))), id, tally);
  }
  EXPECT_GE(tally.right, 294);
  EXPECT_EQ(tally.wrong, 0);
}

// The hardest case: as dark as the slots, it hides a dot, and all IDs that differ by one dot are expected. A
// level taken from the slots made 21 of these wrong, a slot that may be as wide as a sheet 16.
TEST(Louvre, a_dark_sheet_before_it_is_rarely_taken_for_a_slot) {
  constexpr int frames = 300;
  Random random(4);
  const CameraModel camera = cropped(paper_camera(), side_px);
  Tally tally;
  for (int i = 0; i < frames; ++i) {
    const MarkerView view = some_marker_view(random);
    const int id = random_id(random);
    const Louvre louvre = some_louvre(random);
    const double px_per_m = camera.fx_px / view.depth_m;
    PaintedFrame frame = painted(louvre, px_per_m);
    frame.marker(camera, view, id);
    const std::vector<GridCell> dots = dots_of(id);
    const double sheet_px = random.uniform(1.5, 4.0) * marker_dot_radius_m * px_per_m;
    const double angle = random.uniform(0.0, radians(360.0));
    const Vec2 off = random.uniform(0.0, 0.5) * sheet_px * Vec2(std::cos(angle), std::sin(angle));
    frame.disc(dot_in_image(camera, view, dots[random.below(dots.size())]) + off, sheet_px,
               louvre.slot_gray * random.uniform(0.9, 1.1));
    count(detect_markers(finished(frame, random), expecting_ids(ids_alike(id))), id, tally);
  }
  EXPECT_LE(tally.wrong, 8);
}

// Where every row crosses slats, they are no noise: it would hide every dot.
TEST(FrameNoise, is_the_pixels_and_not_that_of_slats_all_over) {
  for (const double noise_gray : {1.0, 3.0, 8.0}) {
    for (const double turn : {0.0, 20.0, 45.0, 90.0, 135.0}) {
      Random random(5);
      const Louvre louvre{.slat_gray = 120.0,
                          .slot_gray = 40.0,
                          .period_m = 0.03,
                          .slot_m = 0.012,
                          .turn_rad = radians(turn),
                          .shift = 0.0};
      const double found = noise_of(painted(louvre, 250.0).finished(random, noise_gray));
      EXPECT_LT(found, noise_gray + 4.5) << turn;
      EXPECT_GT(found, 0.8 * noise_gray) << turn;
    }
  }
}

TEST(FrameNoise, of_an_even_ceiling_is_the_pixels) {
  for (const double noise_gray : {1.0, 4.0, 6.0, 12.0}) {
    Random random(6);
    const double found = noise_of(PaintedFrame({640, 480}).finished(random, noise_gray));
    EXPECT_NEAR(found, noise_gray, 0.12 * noise_gray);
  }
}

constexpr double level_gray = 120.0;
constexpr double dark_gray = 40.0;
constexpr double dot_px = 5.0;

DiscOnCeiling in_the_middle() {
  return {.center_px = {40.0, 40.0},
          .side_px = 1.4 * dot_px,
          .ring_px = 2.2 * dot_px,
          .level_gray = level_gray,
          .tolerance_gray = 12.0};
}

cv::Mat without_noise(const PaintedFrame& frame) {
  Random random(7);
  return frame.finished(random, 0.0, 0.7);
}

TEST(DarkLine, shows_where_it_is_as_dark_and_narrow_as_beside) {
  PaintedFrame line({80, 80}, level_gray);
  line.tube({0.0, 30.0}, {80.0, 50.0}, 1.6 * dot_px, dark_gray);
  EXPECT_TRUE(shows_dark_line(without_noise(line), in_the_middle()));
  EXPECT_FALSE(shows_dark_line(without_noise(PaintedFrame({80, 80}, level_gray)), in_the_middle()));

  PaintedFrame dark_band({80, 80}, level_gray);
  dark_band.tube({0.0, 30.0}, {80.0, 50.0}, 5.0 * dot_px, dark_gray);
  EXPECT_FALSE(shows_dark_line(without_noise(dark_band), in_the_middle())) << "no ceiling beside it";

  PaintedFrame covered = line;
  covered.disc({40.0, 40.0}, 1.4 * dot_px, dark_gray);
  EXPECT_FALSE(shows_dark_line(without_noise(covered), in_the_middle())) << "a cover on it is wider";

  PaintedFrame end({80, 80}, level_gray);
  end.tube({0.0, 30.0}, {40.0, 40.0}, 1.6 * dot_px, dark_gray);
  EXPECT_FALSE(shows_dark_line(without_noise(end), in_the_middle())) << "it does not go through";
}

TEST(DarkLine, is_behind_a_dot_that_interrupts_it) {
  PaintedFrame frame({80, 80}, level_gray);
  frame.tube({0.0, 30.0}, {80.0, 50.0}, dot_px, dark_gray);
  frame.disc({40.0, 40.0}, dot_px, 246.0);
  EXPECT_TRUE(is_before_dark_line(without_noise(frame), in_the_middle()));

  PaintedFrame beside({80, 80}, level_gray);
  beside.tube({0.0, 52.0}, {80.0, 52.0}, 2.0 * dot_px, dark_gray);
  beside.disc({40.0, 40.0}, dot_px, 246.0);
  EXPECT_FALSE(is_before_dark_line(without_noise(beside), in_the_middle())) << "a cable that passes beside";
}

TEST(DarkLine, is_not_looked_for_where_the_border_cuts_the_ring) {
  PaintedFrame frame({80, 80}, level_gray);
  frame.tube({0.0, 6.0}, {80.0, 6.0}, dot_px, dark_gray);
  DiscOnCeiling at_border = in_the_middle();
  at_border.center_px = {40.0, 6.0};
  EXPECT_FALSE(shows_dark_line(without_noise(frame), at_border));
  EXPECT_FALSE(is_before_dark_line(without_noise(frame), at_border));
}

}  // namespace
}  // namespace lodestar

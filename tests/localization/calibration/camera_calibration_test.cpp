#include "localization/calibration/camera_calibration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/localization/board_picture.hpp"

namespace lodestar {
namespace {

using testing::board_places;
using testing::BoardCamera;
using testing::chessboard;
using ::testing::Contains;
using testing::difference_px;
using ::testing::ElementsAre;
using testing::Holding;
using testing::ideal_view;
using ::testing::IsEmpty;

constexpr int columns = 8;
constexpr int rows = 6;
constexpr double square_m = 0.03;
const Vec2 first_m(-1.5 * square_m, -1.5 * square_m);  // the board's outline
const Vec2 last_m((columns + 0.5) * square_m, (rows + 0.5) * square_m);

CameraModel wide() {
  return {
      640, 480, 402.0, 399.0, 331.0, 236.0, Distortion::plumb_bob, {-0.22, 0.06, 0.0006, -0.0009, -0.008}};
}
CameraModel fisheye() {
  return {640, 480, 262.0, 264.0, 312.0, 246.0, Distortion::equidistant, {0.02, -0.012, 0.004, -0.001}};
}
CameraModel rational() {
  return {640,
          480,
          402.0,
          399.0,
          331.0,
          236.0,
          Distortion::rational_polynomial,
          {0.3, -0.1, 0.0005, 0.001, 0.01, 0.5, -0.05, 0.01}};
}

/// Views of a board as a good detector finds them.
std::vector<BoardView> views_of(const CameraModel& camera, std::size_t count, const Holding& holding,
                                std::uint64_t seed, double sigma_px = 0.05) {
  Random random(seed);
  std::vector<BoardView> views;
  for (const auto& place : board_places(camera, first_m, last_m, count, holding, random)) {
    views.push_back(ideal_view(camera, columns, rows, square_m, place, sigma_px, random));
  }
  return views;
}

CameraCalibration calibrated(const std::vector<BoardView>& views, LensModel model = LensModel::pinhole) {
  CameraCalibrationOptions options;
  options.model = model;
  return calibrate_camera(views, 640, 480, options);
}

std::vector<BoardView> seen_in_pictures(const CameraModel& camera, const Holding& holding) {
  Random random(5);
  const BoardCamera taker(camera);
  std::vector<BoardView> views;
  for (const auto& place : board_places(camera, first_m, last_m, 14, holding, random)) {
    const cv::Mat picture = taker.picture(chessboard(columns, rows, square_m), place, random);
    const auto view = find_board(picture, {BoardKind::chessboard, columns, rows, square_m});
    if (view) views.push_back(*view);
  }
  return views;
}

TEST(CalibrateCamera, finds_a_wide_lens_from_pictures) {
  const std::vector<BoardView> views = seen_in_pictures(wide(), {});
  EXPECT_GE(views.size(), 13U);
  const CameraCalibration result = calibrated(views);
  ASSERT_THAT(result.flaws, IsEmpty());
  EXPECT_LT(result.fit->all_rms_px, 0.15);
  EXPECT_NEAR(result.fit->camera.fx_px, 402.0, 1.0);
  EXPECT_LT(difference_px(wide(), result.fit->camera), 0.4);
}

TEST(CalibrateCamera, finds_a_fisheye_lens_from_pictures) {
  const std::vector<BoardView> views = seen_in_pictures(fisheye(), {.distance_m = 0.3});
  EXPECT_GE(views.size(), 13U);
  const CameraCalibration result = calibrated(views, LensModel::fisheye);
  ASSERT_THAT(result.flaws, IsEmpty());
  EXPECT_LT(result.fit->all_rms_px, 0.15);
  EXPECT_NEAR(result.fit->camera.fx_px, 262.0, 1.0);
  EXPECT_LT(difference_px(fisheye(), result.fit->camera), 0.4);
}

TEST(CalibrateCamera, says_how_uncertain_each_number_is) {
  // Over many sets, an estimate is off by its standard deviation, on average.
  for (const LensModel model : {LensModel::pinhole, LensModel::fisheye}) {
    const CameraModel truth = model == LensModel::fisheye ? fisheye() : wide();
    constexpr int sets = 12;
    double fx = 0.0;
    double cy = 0.0;
    double k1 = 0.0;
    for (int set = 0; set < sets; ++set) {
      const auto views = views_of(truth, 12, {}, static_cast<std::uint64_t>(100 + set), 0.2);
      const CameraCalibration result = calibrated(views, model);
      ASSERT_TRUE(result.fit.has_value());
      const CameraModel& camera = result.fit->camera;
      const IntrinsicSigmas& sigmas = result.fit->sigmas;
      fx += std::pow((camera.fx_px - truth.fx_px) / sigmas.fx_px, 2) / sets;
      cy += std::pow((camera.cy_px - truth.cy_px) / sigmas.cy_px, 2) / sets;
      k1 += std::pow((camera.coefficients[0] - truth.coefficients[0]) / sigmas.coefficients[0], 2) / sets;
      EXPECT_NEAR(result.fit->all_rms_px, 0.2 * std::numbers::sqrt2, 0.02);
    }
    for (const double mean_square : {fx, cy, k1}) {  // chi-square with 12 degrees of freedom, 99.9 %
      EXPECT_GT(mean_square, 0.18);
      EXPECT_LT(mean_square, 2.75);
    }
  }
}

TEST(CalibrateCamera, fits_the_rational_model) {
  const CameraCalibration result = calibrated(views_of(rational(), 20, {}, 3), LensModel::rational);
  ASSERT_THAT(result.flaws, IsEmpty());
  EXPECT_EQ(result.fit->camera.distortion, Distortion::rational_polynomial);
  EXPECT_LT(difference_px(rational(), result.fit->camera), 0.6);
}

TEST(CalibrateCamera, refuses_too_few_boards) {
  EXPECT_THAT(calibrated({}).flaws, Contains(CameraFlaw::too_few_boards));
  EXPECT_THAT(calibrated(views_of(wide(), 7, {}, 1)).flaws, ElementsAre(CameraFlaw::too_few_boards));
  EXPECT_THAT(calibrated(views_of(wide(), 14, {}, 1)).flaws, IsEmpty());
}

TEST(CalibrateCamera, refuses_boards_of_one_orientation) {
  EXPECT_THAT(calibrated(views_of(wide(), 20, {.most_tilt_rad = radians(4.0)}, 1)).flaws,
              Contains(CameraFlaw::one_orientation));
  // Copies of one image are no set either.
  const std::vector<BoardView> copies(12, views_of(wide(), 1, {}, 1).front());
  EXPECT_THAT(calibrated(copies).flaws, Contains(CameraFlaw::one_orientation));
}

TEST(CalibrateCamera, refuses_boards_that_stay_in_the_middle) {
  EXPECT_THAT(calibrated(views_of(wide(), 14, {.distance_m = 0.9, .reach = 0.1}, 1)).flaws,
              ElementsAre(CameraFlaw::poor_coverage));
}

TEST(CalibrateCamera, refuses_a_large_error) {
  EXPECT_THAT(calibrated(views_of(wide(), 14, {}, 1, 0.6)).flaws, Contains(CameraFlaw::large_error));
}

TEST(CalibrateCamera, names_the_images_that_do_not_fit) {
  std::vector<BoardView> views = views_of(wide(), 16, {}, 2);
  Random random(9);
  for (cv::Point2f& pixel : views[5].pixels)
    pixel += cv::Point2f(static_cast<float>(3.0 * random.normal()), 0.0F);
  const CameraCalibration result = calibrated(views);
  EXPECT_THAT(result.flaws, Contains(CameraFlaw::outlier_views));
  EXPECT_THAT(result.outliers, ElementsAre(5U));
}

TEST(CalibrateCamera, refuses_a_lens_that_the_boards_hardly_determine) {
  // Eight small, distant boards: each image is consistent, but the focal length is undetermined.
  const auto views = views_of(wide(), 8, {.most_tilt_rad = radians(14.0), .distance_m = 4.0}, 4, 0.3);
  EXPECT_THAT(calibrated(views).flaws, Contains(CameraFlaw::undetermined));
}

}  // namespace
}  // namespace lodestar

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "maps/camera_model.hpp"

#include "tests/localization/board_picture.hpp"
#include "tests/scenarios/command_line.hpp"

#ifdef LODESTAR_ARUCO
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/imgproc.hpp>
#endif

// `lodestar calibrate camera` on images of a board, taken by a known camera.
namespace lodestar {
namespace {

namespace fs = std::filesystem;
using testing::board_places;
using testing::BoardCamera;
using testing::chessboard;
using testing::difference_px;
using ::testing::HasSubstr;
using testing::Holding;

constexpr double square_m = 0.03;
const Vec2 first_m(-1.5 * square_m, -1.5 * square_m);
const Vec2 last_m(8.5 * square_m, 6.5 * square_m);

const CameraModel wide{
    640, 480, 402.0, 399.0, 331.0, 236.0, Distortion::plumb_bob, {-0.22, 0.06, 0.0006, -0.0009, -0.008}};
const CameraModel fisheye{
    640, 480, 262.0, 264.0, 312.0, 246.0, Distortion::equidistant, {0.02, -0.012, 0.004, -0.001}};

class CalibrateCameraCommand : public ::testing::Test {
 protected:
  void take_pictures(const CameraModel& camera, std::size_t count, const Holding& holding) {
    const BoardCamera taker(camera);
    int number = 10;
    for (const auto& place : board_places(camera, first_m, last_m, count, holding, random_)) {
      save(std::to_string(number++), taker.picture(chessboard(8, 6, square_m), place, random_));
    }
  }
  void save(const std::string& name, const cv::Mat& picture) {
    fs::create_directories(scratch_.path() / "pictures");
    cv::imwrite((scratch_.path() / "pictures" / (name + ".png")).string(), picture);
  }
  Ran calibrate(const std::string& more = "") {
    return run_lodestar(
        "calibrate camera --board chessboard --cols 8 --rows 6 --square-m 0.03 -o camera.yaml " + more +
            " pictures",
        scratch_.path());
  }
  [[nodiscard]] bool has_written() const { return fs::exists(scratch_.path() / "camera.yaml"); }

  Random random_{7};
  ScratchFolder scratch_;
};

TEST_F(CalibrateCameraCommand, writes_the_camera_that_took_the_pictures) {
  take_pictures(wide, 14, {});
  save("without", cv::Mat(480, 640, CV_8UC1, cv::Scalar(90)));
  const Ran ran = calibrate("--json");
  ASSERT_EQ(ran.exit_code, 0) << ran.out << ran.err;
  const auto report = nlohmann::json::parse(ran.out);
  EXPECT_TRUE(report["usable"].get<bool>());
  EXPECT_EQ(report["images"].size(), 14U);
  EXPECT_THAT(report["images_without_board"][0].get<std::string>(), HasSubstr("without.png"));
  EXPECT_LT(report["rms_px"].get<double>(), 0.15);
  EXPECT_LT(difference_px(wide, load_camera(scratch_.path() / "camera.yaml")), 0.4);
}

TEST_F(CalibrateCameraCommand, writes_a_fisheye_camera) {
  take_pictures(fisheye, 14, {.distance_m = 0.35});
  const Ran ran = calibrate("--model fisheye");
  ASSERT_EQ(ran.exit_code, 0) << ran.out << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("reprojection error 0."));
  const CameraModel camera = load_camera(scratch_.path() / "camera.yaml");
  EXPECT_EQ(camera.distortion, Distortion::equidistant);
  EXPECT_LT(difference_px(fisheye, camera), 0.4);
}

/// Somebody moves a board before the camera on the robot: it rests for half a second at each place, and is on
/// its way in between.
TEST_F(CalibrateCameraCommand, takes_the_pictures_itself_by_a_sites_camera) {
  fs::copy(fs::path(LODESTAR_SOURCE_DIR) / "sites/lab", scratch_.path() / "site",
           fs::copy_options::recursive | fs::copy_options::copy_symlinks);
  std::string site = read_text(scratch_.path() / "site/site.yaml");
  const std::string simulated = "camera: simulated";
  ASSERT_THAT(site, HasSubstr(simulated));
  write_text(scratch_.path() / "site/site.yaml",
             site.replace(site.find(simulated), simulated.size(), "camera: video:board.avi"));
  constexpr std::size_t places = 14;
  constexpr int frames_at_rest = 10;
  cv::VideoWriter film((scratch_.path() / "site/board.avi").string(),
                       cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 20.0, {640, 480}, false);
  if (!film.isOpened()) GTEST_SKIP() << "OpenCV cannot write MJPG here";
  const BoardCamera taker(wide);
  const auto all = board_places(wide, first_m, last_m, places, {}, random_);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const cv::Mat at_rest = taker.picture(chessboard(8, 6, square_m), all[i], random_);
    for (int frame = 0; frame < frames_at_rest; ++frame) film.write(at_rest);
    Eigen::Isometry3d on_its_way = all[i];
    on_its_way.translation().x() += 0.02;
    film.write(taker.picture(chessboard(8, 6, square_m), on_its_way, random_));
  }
  film.release();
  const Ran ran = run_lodestar(
      "calibrate camera --board chessboard --cols 8 --rows 6 --square-m 0.03 -o camera.yaml --json site",
      scratch_.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.out << ran.err;
  const auto report = nlohmann::json::parse(ran.out);
  EXPECT_GE(report["images"].size(), places - 4) << "two may be near each other, or a busy machine miss one";
  EXPECT_LE(report["images"].size(), places) << "a place twice, or one on the way";
  EXPECT_THAT(ran.err, HasSubstr("board 8, corners in "));
  EXPECT_LT(difference_px(wide, load_camera(scratch_.path() / "camera.yaml")), 0.6);
}

TEST_F(CalibrateCameraCommand, writes_nothing_for_a_poor_set) {
  take_pictures(wide, 3, {.distance_m = 0.8, .reach = 0.1});
  const Ran ran = calibrate();
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.err, HasSubstr("too-few-boards: found the board in 3 of 3 images, wanted at least 8"));
  EXPECT_THAT(ran.err, HasSubstr("poor-coverage"));
  EXPECT_FALSE(has_written());
}

TEST_F(CalibrateCameraCommand, names_the_image_that_does_not_fit) {
  take_pictures(wide, 13, {});
  const CameraModel other{640, 480, 560.0, 380.0, 300.0, 250.0, Distortion::plumb_bob, {0.3, 0.2}};
  const auto place = board_places(other, first_m, last_m, 1, {}, random_).front();
  save("other-lens", BoardCamera(other).picture(chessboard(8, 6, square_m), place, random_));
  const Ran ran = calibrate();
  EXPECT_EQ(ran.exit_code, 1) << ran.out;
  EXPECT_THAT(ran.err, ::testing::ContainsRegex("outlier-views: .*take them out: pictures/other-lens.png\n"));
  EXPECT_FALSE(has_written());
}

TEST_F(CalibrateCameraCommand, refuses_what_it_cannot_use) {
  save("small", cv::Mat::zeros(240, 320, CV_8UC1));
  save("wide", cv::Mat::zeros(480, 640, CV_8UC1));
  const Ran sizes = calibrate();
  EXPECT_EQ(sizes.exit_code, 2);
  EXPECT_THAT(sizes.err,
              HasSubstr("wide.png: found 640 x 480 pixels, wanted 320 x 240 as in pictures/small.png"));
  EXPECT_EQ(calibrate("--marker-m 0.02").exit_code, 2) << "a chessboard has no markers";
  EXPECT_EQ(
      run_lodestar("calibrate camera --board charuco --cols 8 --rows 6 --square-m 0.03 -o c.yaml pictures",
                   scratch_.path())
          .exit_code,
      2)
      << "a ChArUco board has";
  EXPECT_FALSE(has_written());
}

#ifdef LODESTAR_ARUCO
TEST_F(CalibrateCameraCommand, reads_charuco_boards_that_are_partly_in_view) {
  static constexpr int print_px = 60;  // per square of the sheet
  static constexpr double side_m = 0.05;
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50);
  const auto board = cv::aruco::CharucoBoard::create(7, 6, static_cast<float>(side_m), 0.037F, dictionary);
  cv::Mat sheet;
  board->draw({7 * print_px, 6 * print_px}, sheet, 0, 1);
  cv::GaussianBlur(sheet, sheet, {}, 1.2);  // about what a pixel of the camera covers
  const testing::Print print = [&sheet](const Vec2& point, double) -> std::optional<double> {
    const Vec2 at = point / side_m * print_px - Vec2(0.5, 0.5);
    if (at.minCoeff() < 0.0 || at.x() >= sheet.cols - 1 || at.y() >= sheet.rows - 1) return std::nullopt;
    const auto u = static_cast<int>(at.x());
    const auto v = static_cast<int>(at.y());
    const auto gray = [&](int du, int dv) {
      return static_cast<double>(sheet.at<std::uint8_t>(v + dv, u + du));
    };
    return std::lerp(std::lerp(gray(0, 0), gray(1, 0), at.x() - u),
                     std::lerp(gray(0, 1), gray(1, 1), at.x() - u), at.y() - v);
  };
  const Vec2 from(2.0 * side_m, 2.0 * side_m);  // only the middle of the sheet must be in view
  const Vec2 to(5.0 * side_m, 4.0 * side_m);
  const BoardCamera taker(wide);
  int number = 10;
  for (const auto& place : board_places(wide, from, to, 20, {.distance_m = 0.4}, random_)) {
    save(std::to_string(number++), taker.picture(print, place, random_));
  }
  const std::string command =
      "calibrate camera --board charuco --cols 7 --rows 6 --square-m 0.05 --marker-m 0.037 ";
  const Ran ran = run_lodestar(command + "--dictionary DICT_4X4_50 -o camera.yaml pictures", scratch_.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.out << ran.err;
  EXPECT_LT(difference_px(wide, load_camera(scratch_.path() / "camera.yaml")), 1.0);
  const Ran unknown = run_lodestar(command + "--dictionary DICT_9X9 -o other.yaml pictures", scratch_.path());
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("--dictionary: found 'DICT_9X9'"));
}
#endif

}  // namespace
}  // namespace lodestar

#include <fstream>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "tests/scenarios/shots.hpp"

// Sources of frames, and the drawings of what was detected in them.
namespace lodestar {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<std::string> column(const std::vector<std::vector<std::string>>& rows, std::size_t index) {
  std::vector<std::string> cells;
  for (std::size_t i = 1; i < rows.size(); ++i) cells.push_back(rows[i].at(index));
  return cells;
}

class FrameSources : public Shots {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return (scratch_.path() / name).string(); }

  /// A video of a camera that moves 1 cm a frame, at 20 frames a second. False when OpenCV has no writer.
  bool film(const std::string& name, int frames) {
    cv::VideoWriter writer(path(name), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 20.0, {640, 480}, false);
    for (int i = 0; i < frames && writer.isOpened(); ++i)
      writer.write(shot(Pose2{{1.2 + 0.01 * i, 2.1}, radians(75.0)}));
    return writer.isOpened();
  }

  const std::string localize_ = "localize --markers markers.yaml --camera camera.yaml --upright ";
};

TEST_F(FrameSources, a_pattern_names_the_images_that_the_shell_left_alone) {
  take("10.5", Pose2{{1.2, 2.1}, 0.0});
  const Ran ran = run(localize_ + "'frames/*.png'");
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_THAT(column(rows_of(ran.out), 0),
              ElementsAre("frames/0.5.png", "frames/1.5.png", "frames/10.5.png"));
  EXPECT_THAT(ran.err, HasSubstr("pose in 3 of 3 frames"));
}

TEST_F(FrameSources, numbered_images_are_taken_in_their_numbers_order) {
  for (const char* name : {"shot10", "shot9", "shot100"}) {
    fs::copy_file(path("frames/0.5.png"), path(std::string("frames/") + name + ".png"));
  }
  const Ran ran = run(localize_ + "'frames/shot*.png'");
  EXPECT_THAT(column(rows_of(ran.out), 0),
              ElementsAre("frames/shot9.png", "frames/shot10.png", "frames/shot100.png"));
  EXPECT_THAT(column(rows_of(ran.out), 1), ElementsAre("0.000000", "1.000000", "2.000000"));
}

TEST_F(FrameSources, stops_after_so_many_frames) {
  EXPECT_EQ(rows_of(run(localize_ + "--frames 1 frames").out).size(), 2U);
}

TEST_F(FrameSources, a_video_is_read_with_its_own_time) {
  if (!film("drive.avi", 5)) GTEST_SKIP() << "OpenCV cannot write MJPG here";
  const Ran ran = run(localize_ + "drive.avi");
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const auto rows = rows_of(ran.out);
  EXPECT_THAT(column(rows, 0),
              ElementsAre("drive.avi#0", "drive.avi#1", "drive.avi#2", "drive.avi#3", "drive.avi#4"));
  EXPECT_THAT(column(rows, 1), ElementsAre("0.000000", "0.050000", "0.100000", "0.150000", "0.200000"));
  for (std::size_t i = 1; i < rows.size(); ++i) {
    EXPECT_NEAR(std::stod(rows[i][3]), 1.2 + 0.01 * static_cast<double>(i - 1), 0.003);
    EXPECT_NEAR(std::stod(rows[i][4]), 2.1, 0.003);
  }
}

TEST_F(FrameSources, tracking_through_a_video_gives_the_rows_of_searching_every_frame) {
  if (!film("drive.avi", 5)) GTEST_SKIP() << "OpenCV cannot write MJPG here";
  const Ran searched = run(localize_ + "drive.avi");
  const Ran tracked = run(localize_ + "--track drive.avi");
  EXPECT_GT(rows_of(searched.out).size(), 3U);
  EXPECT_EQ(tracked.out, searched.out);
}

TEST_F(FrameSources, a_cut_video_is_read_as_far_as_it_goes_and_said_to_be_short) {
  if (!film("drive.avi", 20)) GTEST_SKIP() << "OpenCV cannot write MJPG here";
  fs::resize_file(path("drive.avi"), fs::file_size(path("drive.avi")) / 2);
  const Ran ran = run(localize_ + "drive.avi");
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("drive.avi: ends after"));
}

TEST_F(FrameSources, a_video_without_a_frame_is_refused) {
  std::string noise = "RIFF";
  noise.resize(5000, '\0');
  write_text(path("noise.avi"), noise);
  const Ran ran = run(localize_ + "noise.avi");
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_THAT(ran.err, HasSubstr("noise.avi: found no image and no video that can be decoded"));
}

TEST_F(FrameSources, a_video_of_another_size_than_the_cameras_is_refused) {
  cv::VideoWriter writer(path("small.avi"), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 20.0, {320, 240});
  if (!writer.isOpened()) GTEST_SKIP() << "OpenCV cannot write MJPG here";
  writer.write(cv::Mat::zeros(240, 320, CV_8UC3));
  writer.release();
  const Ran ran = run(localize_ + "small.avi");
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_THAT(ran.err, HasSubstr("small.avi#0: found 320 x 240 pixels, wanted the camera's 640 x 480"));
}

TEST_F(FrameSources, colour_alpha_and_16_bits_give_the_same_pose) {
  const cv::Mat gray = cv::imread(path("frames/0.5.png"), cv::IMREAD_GRAYSCALE);
  cv::Mat colour;
  cv::Mat alpha;
  cv::Mat deep;
  cv::cvtColor(gray, colour, cv::COLOR_GRAY2BGR);
  cv::Mat planes[] = {gray, gray, gray, cv::Mat::zeros(gray.size(), CV_8UC1)};  // all of it transparent
  cv::merge(planes, 4, alpha);
  gray.convertTo(deep, CV_16U, 257.0);
  cv::imwrite(path("colour.png"), colour);
  cv::imwrite(path("alpha.png"), alpha);
  cv::imwrite(path("deep.png"), deep);
  cv::imwrite(path("deep.pgm"), deep);
  const std::string wanted = column(rows_of(run(localize_ + "frames/0.5.png").out), 3).at(0);
  // One run each: within a run the camera's noise is learned, and poses change by a micrometre.
  for (const char* same : {"colour.png", "alpha.png", "deep.png", "deep.pgm"})
    EXPECT_EQ(column(rows_of(run(localize_ + same).out), 3).at(0), wanted) << same;
}

TEST_F(FrameSources, damaged_images_are_refused_by_name) {
  const cv::Mat gray = cv::imread(path("frames/0.5.png"), cv::IMREAD_GRAYSCALE);
  for (const char* ending : {".png", ".pgm", ".bmp", ".jpg", ".tiff"}) {
    const std::string name = std::string("cut") + ending;
    cv::imwrite(path(name), gray);
    EXPECT_EQ(run("detect " + name).exit_code, 0) << name;
    fs::resize_file(path(name), fs::file_size(path(name)) - 100);
    const Ran ran = run("detect " + name);
    EXPECT_EQ(ran.exit_code, 2) << name;
    EXPECT_THAT(ran.err, HasSubstr(name + ": found")) << name;
  }
  write_text(path("empty.png"), "");
  EXPECT_THAT(run("detect empty.png").err, HasSubstr("empty.png: found an empty file"));
  cv::imwrite(path("float.tiff"), cv::Mat::zeros(48, 64, CV_32FC1));
  EXPECT_THAT(run("detect float.tiff").err, HasSubstr("float.tiff: found floating-point pixels"));
  write_text(path("notes.txt"), "not a film\n");
  EXPECT_THAT(run("detect notes.txt").err, HasSubstr("notes.txt: found no image and no video"));
}

TEST_F(FrameSources, drawings_are_named_after_their_frames_and_show_the_refused_ones_too) {
  cv::imwrite(path("frames/dark.png"), cv::Mat::zeros(480, 640, CV_8UC1));
  fs::create_directories(path("more"));
  fs::copy_file(path("frames/0.5.png"), path("more/0.5.png"));
  const Ran ran = run(localize_ + "--draw seen frames more");
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  for (const char* name : {"0.5", "1.5", "dark", "0.5-2"}) {
    const cv::Mat picture = cv::imread(path(std::string("seen/") + name + ".png"));
    EXPECT_EQ(picture.cols, 1280) << name;
    EXPECT_GT(picture.rows, 960) << name << ": text below the enlarged frame";
  }
}

TEST_F(FrameSources, a_name_with_a_comma_is_one_cell_and_one_of_no_text_is_still_json) {
  fs::copy_file(path("frames/0.5.png"), path("a,b.png"));
  fs::copy_file(path("frames/0.5.png"), path("\xff.png"));
  EXPECT_THAT(run(localize_ + "a,b.png").out, HasSubstr("\n\"a,b.png\",0.000000,"));
  EXPECT_THAT(run("detect a,b.png").out, HasSubstr("\n\"a,b.png\",447,"));
  EXPECT_TRUE(nlohmann::json::accept(run(localize_ + "--format json \xff.png").out));
  EXPECT_TRUE(nlohmann::json::accept(run("detect --format json \xff.png").out));
}

TEST_F(FrameSources, the_tilt_of_the_mount_and_how_well_it_holds_count_for_every_source) {
  const std::string base = "localize --markers markers.yaml --camera camera.yaml --quiet frames/0.5.png ";
  const auto sigma_x = [&](const std::string& options) {
    const Ran ran = run(base + options);
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    EXPECT_EQ(ran.err, "");
    return std::stod(column(rows_of(ran.out), 9).at(0));
  };
  const double upright = sigma_x("--upright");
  const double nearly = sigma_x("--tilt-sigma-deg 0.3");
  const double free = sigma_x("");
  EXPECT_LT(upright, nearly);
  EXPECT_LT(nearly, free);

  // The camera is 10 cm behind the robot's centre, 2 cm to its left, and as high as it took the images.
  std::string robot = read_text(std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab/robot.yaml");
  const std::size_t at = robot.find("camera_mount:");
  robot.replace(at, robot.find('\n', at) - at,
                "camera_mount: {x_m: -0.10, y_m: 0.02, z_m: 0.6, roll_deg: 0, pitch_deg: 0, yaw_deg: 0}");
  write_text(path("robot.yaml"), robot);
  const Ran ran = run(base + "--upright --mount robot.yaml");
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const auto row = rows_of(ran.out).at(1);
  const Vec2 robot_in_map = Pose2{{1.2, 2.1}, radians(75.0)} * Vec2(0.10, -0.02);
  EXPECT_NEAR(std::stod(row[3]), robot_in_map.x(), 0.003);
  EXPECT_NEAR(std::stod(row[4]), robot_in_map.y(), 0.003);
  EXPECT_NEAR(std::stod(row[5]), 0.0, 0.01) << "it stands on the floor";
  EXPECT_NEAR(std::stod(row[6]), 75.0, 0.2);
}

TEST_F(FrameSources, drawings_of_a_video_are_numbered) {
  if (!film("drive.avi", 2)) GTEST_SKIP() << "OpenCV cannot write MJPG here";
  ASSERT_EQ(run("detect --draw seen drive.avi").exit_code, 0);
  EXPECT_TRUE(fs::exists(path("seen/drive-000000.png")));
  EXPECT_TRUE(fs::exists(path("seen/drive-000001.png")));
}

TEST_F(FrameSources, drawings_never_go_where_the_images_are) {
  const Ran ran = run("detect --draw ./frames/../frames frames/0.5.png");
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_THAT(ran.err, HasSubstr("found the folder of the images themselves"));
}

}  // namespace
}  // namespace lodestar

#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "app/site/site.hpp"
#include "drivers/base/base_driver.hpp"
#include "drivers/simulation/simulation.hpp"

#include "tests/scenarios/command_line.hpp"

// `lodestar calibrate mount` on the log of a simulated robot whose camera mount differs from its file.
namespace lodestar {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

const fs::path lab = fs::path(LODESTAR_SOURCE_DIR) / "sites/lab";

/// Drives the simulated base through the lab and records what a real robot would: images and wheel readings.
class Logger {
 public:
  /// `late`: the images' stamps after their exposures.
  Logger(const Eigen::Isometry3d& base_from_camera, const fs::path& folder, Duration late)
      : site_(load_site(lab)),
        simulation_(made(site_, base_from_camera)),
        base_(simulation_.can()),
        folder_(folder),
        late_(late) {
    fs::create_directories(folder);
    wheels_.open(folder / "wheels.csv");
    wheels_ << "stamp_s,left_m,right_m\n" << std::setprecision(12);
  }

  void drive(const BodyVelocity& velocity, double duration_s) {
    const Stamp end = simulation_.now() + from_seconds(duration_s);
    while (simulation_.now() < end) {
      simulation_.advance(std::chrono::milliseconds(20));
      for (const WheelTravel& travel : base_.poll(simulation_.now()).travel) {
        wheels_ << seconds(travel.stamp) << ',' << travel.left_m << ',' << travel.right_m << '\n';
      }
      while (const std::optional<Frame> frame = simulation_.camera().poll()) keep(*frame);
      base_.command(velocity);
    }
  }

 private:
  static Simulation made(const Site& site, const Eigen::Isometry3d& base_from_camera) {
    SimulationOptions options;
    options.start = site.start;
    options.base_from_camera = base_from_camera;
    options.base.track_width_m = site.robot.track_width_m;
    options.seed = 11;
    return {site.map.map, site.registry, site.cameras.at("wide"), options};
  }

  void keep(const Frame& frame) {
    if (count_++ % 3 != 0) return;
    cv::imwrite((folder_ / (std::to_string(seconds(frame.stamp + late_)) + ".pgm")).string(), frame.gray);
  }

  Site site_;
  Simulation simulation_;
  BaseDriver base_;
  fs::path folder_;
  Duration late_;
  std::ofstream wheels_;
  int count_ = 0;
};

TEST(CalibrateMountCommand, corrects_the_robot_file_from_turns_and_a_straight_drive) {
  const ScratchFolder scratch;
  const RollPitchYaw angles{radians(0.9), radians(-0.7), radians(1.5)};
  Eigen::Isometry3d truth = Eigen::Isometry3d::Identity();
  truth.linear() = rotation_from(angles);
  truth.translation() << -0.115, 0.035, 1.088;
  {
    Logger logger(truth, scratch.path() / "log", std::chrono::milliseconds(30));
    logger.drive({}, 0.5);
    logger.drive({.forward_mps = 0.0, .turn_radps = 1.2}, 27.0);  // five turns
    logger.drive({}, 1.0);
    logger.drive({.forward_mps = 0.4}, 4.0);
    logger.drive({.forward_mps = -0.4}, 4.0);
    logger.drive({}, 0.5);
  }
  std::string robot = read_text(lab / "robot.yaml");
  write_text(scratch.path() / "robot.yaml", "# the lab's robot\n" + robot);

  const Ran ran = run_lodestar(
      "calibrate mount --json --robot robot.yaml " + lab.string() + " log -o new.yaml", scratch.path());

  ASSERT_EQ(ran.exit_code, 0) << ran.out << ran.err;
  const Robot found = load_robot(scratch.path() / "new.yaml");
  EXPECT_LT((found.base_from_camera.translation() - truth.translation()).head<2>().norm(), 0.002) << ran.out;
  EXPECT_NEAR(found.base_from_camera.translation().z(), truth.translation().z(), 0.003) << ran.out;
  EXPECT_NEAR(degrees(found.camera_mount.roll_rad), 0.9, 0.06);
  EXPECT_NEAR(degrees(found.camera_mount.pitch_rad), -0.7, 0.06);
  EXPECT_NEAR(degrees(found.camera_mount.yaw_rad), 1.5, 0.3);
  EXPECT_THAT(read_text(scratch.path() / "new.yaml"), HasSubstr("# the lab's robot\n"));
  const auto report = nlohmann::json::parse(ran.out);
  EXPECT_NEAR(report["time_offset"]["late_ms"].get<double>(), 30.0, 4.0) << ran.out;
  EXPECT_TRUE(report["camera_mount"]["yaw_deg"]["measured"].get<bool>());
  EXPECT_NEAR(report["wheels"]["left_scale"].get<double>() / report["wheels"]["right_scale"].get<double>(),
              1.006 / 0.994, 0.006);
}

TEST(CalibrateMountCommand, takes_the_folder_of_a_run) {
  const ScratchFolder scratch;
  std::string turns;
  for (int turn = 0; turn < 3; ++turn) turns += " --goal 4.2,5.3,0 --goal 4.2,5.3,120 --goal 4.2,5.3,-120";
  ASSERT_EQ(run_lodestar("replay " + lab.string() + turns + " --goal 5.4,4.3 --quiet -o run", scratch.path())
                .exit_code,
            0);
  const std::string text = read_text(lab / "robot.yaml");
  const std::string mount = "camera_mount: {x_m: -0.10, y_m: 0.02, z_m: 1.1,";
  ASSERT_THAT(text, HasSubstr(mount));
  write_text(scratch.path() / "by-hand.yaml",
             std::string(text).replace(text.find(mount), mount.size(),
                                       "camera_mount: {x_m: -0.12, y_m: 0.0, z_m: 1.08,"));
  const Ran ran = run_lodestar("calibrate mount --robot by-hand.yaml " + lab.string() + " run -o new.yaml",
                               scratch.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.out << ran.err;
  const Vec3 found_m = load_robot(scratch.path() / "new.yaml").base_from_camera.translation();
  const Vec3 true_m = load_robot(lab / "robot.yaml").base_from_camera.translation();
  EXPECT_LT((found_m - true_m).norm(), 0.002) << ran.out;
}

/// A log without markers in view, to which tests add further errors.
class BadLog : public ::testing::Test {
 protected:
  BadLog() {
    write_text(scratch_.path() / "log/wheels.csv", "stamp_s,left_m,right_m\n0,0,0\n1,0.1,0.1\n");
    cv::imwrite((scratch_.path() / "log/0.5.png").string(), cv::Mat::zeros(480, 640, CV_8UC1));
  }

  Ran calibrate() {
    Ran ran = run_lodestar("calibrate mount " + lab.string() + " log -o new.yaml", scratch_.path());
    EXPECT_FALSE(fs::exists(scratch_.path() / "new.yaml"));
    return ran;
  }

  ScratchFolder scratch_;
};

TEST_F(BadLog, without_markers_in_view_has_exit_code_1_and_a_reason) {
  const Ran ran = calibrate();
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.err, HasSubstr("too-few-fixes: found 0 places"));
  EXPECT_THAT(ran.err, HasSubstr("too-few-turns"));
}

TEST_F(BadLog, is_refused_with_its_line) {
  write_text(scratch_.path() / "log/wheels.csv", "stamp_s,left_m,right_m\n0,0,0\n1,0.1\n");
  Ran ran = calibrate();
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_THAT(ran.err, HasSubstr("wheels.csv:3: found '1,0.1'"));
  write_text(scratch_.path() / "log/wheels.csv", "stamp_s,left_m,right_m\n1,0,0\n1,0.1,0.1\n");
  EXPECT_THAT(calibrate().err, HasSubstr("wheels.csv:3: found a stamp of 1 s, wanted one after 1 s"));
  write_text(scratch_.path() / "log/wheels.csv", "time,left,right\n");
  EXPECT_THAT(calibrate().err, HasSubstr("wheels.csv:1: found 'time,left,right'"));
  fs::remove(scratch_.path() / "log/wheels.csv");
  EXPECT_THAT(calibrate().err, HasSubstr("wheels.csv: found"));
}

TEST_F(BadLog, with_an_image_that_has_no_stamp_is_refused) {
  cv::imwrite((scratch_.path() / "log/first.png").string(), cv::Mat::zeros(480, 640, CV_8UC1));
  const Ran ran = calibrate();
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_THAT(ran.err, HasSubstr("first.png: found an image named 'first'"));
}

TEST_F(BadLog, without_site_wants_all_three_files) {
  const Ran ran = run_lodestar("calibrate mount log -o new.yaml", scratch_.path());
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_THAT(ran.err, HasSubstr("--markers, --camera and --robot"));
}

}  // namespace
}  // namespace lodestar

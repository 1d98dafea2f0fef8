#include "app/site/base_setup.hpp"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <iterator>

#include "drivers/base/agilex_v2.hpp"
#include "maps/input_error.hpp"

#include "tests/drivers/base/base_driver_fixture.hpp"
#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

using ::testing::HasSubstr;

const std::filesystem::path lab = std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab";

/// The lab's robot.yaml with more lines at its end.
Robot robot_with(const std::string& lines) {
  std::ifstream stream(lab / "robot.yaml");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const TemporaryFolder folder;
  return load_robot(folder.write("robot.yaml", text + lines));
}

std::string refusal(const std::string& lines, const BaseConnection& connection = {}) {
  try {
    (void)make_protocol(connection, robot_with(lines));
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

/// What a driver set up for this robot makes of a base that is in CAN mode and reports these bits.
BaseFeedback feedback_on(const Robot& robot, std::uint32_t fault_bits) {
  testing::ScriptedBus bus;
  std::unique_ptr<BaseProtocol> protocol = make_protocol({}, robot);
  const BaseDriverOptions options = base_driver_options(robot, *protocol);
  BaseDriver driver(bus, std::move(protocol), options);
  const SystemState state{.mode = ControlMode::can, .fault_bits = fault_bits};
  for (const CanFrame& frame :
       {agilex::encode_system_state(state), agilex::encode_motion_state({}), agilex::encode_odometer({})})
    bus.arriving.push_back({Stamp(), frame});
  return driver.poll(Stamp());
}

TEST(BaseSetup, gives_the_driver_the_limits_of_the_robot) {
  Robot robot = robot_with("");
  robot.max_forward_mps = 0.37;
  robot.max_turn_radps = 0.73;
  robot.max_wheel_mps = 0.41;
  robot.track_width_m = 0.51;
  const BaseDriverOptions options = base_driver_options(robot);
  EXPECT_EQ(options.max_forward_mps, 0.37);
  EXPECT_EQ(options.max_turn_radps, 0.73);
  EXPECT_EQ(options.max_wheel_mps, 0.41);
  EXPECT_EQ(options.track_width_m, 0.51);
}

TEST(BaseSetup, ignores_the_faults_that_the_robot_names) {
  EXPECT_EQ(feedback_on(robot_with(""), 0x0900).details, "battery under-voltage, unknown fault bits 0x0800");
  const Robot lenient = robot_with("base: {ignored_faults: [battery under-voltage, 0x0800]}\n");
  EXPECT_EQ(feedback_on(lenient, 0x0900).state, BaseState::ready);
  EXPECT_EQ(feedback_on(lenient, 0x1900).details, "unknown fault bits 0x1000");
}

TEST(BaseSetup, reads_control_modes_as_the_robot_says) {
  const Robot robot = robot_with("base: {modes: [remote, standby, can]}\n");
  const auto protocol = make_protocol({}, robot);
  EXPECT_EQ(protocol->enable(), (std::vector<CanFrame>{{agilex::control_mode_id, 1, {2}}}));
}

TEST(BaseSetup, refuses_faults_and_modes_that_the_base_does_not_have) {
  EXPECT_THAT(
      refusal("base: {ignored_faults: [fog]}\n"),
      HasSubstr("ignored_faults: 'fog', wanted the number of a bit, such as 0x0800, or one of: battery"));
  EXPECT_THAT(refusal("base: {ignored_faults: [0xfog]}\n"), HasSubstr("'0xfog'"));
  EXPECT_THAT(refusal("base: {ignored_faults: fog}\n"), HasSubstr("a list of words"));
  EXPECT_THAT(refusal("base: {modes: [standby, joystick]}\n"),
              HasSubstr("found 'joystick', wanted standby, can, uart or remote"));
  EXPECT_THAT(refusal("base: {modes: [standby]}\n"), HasSubstr("one can"));
  EXPECT_THAT(refusal("base: {colour: red}\n"), HasSubstr("colour"));
  EXPECT_THAT(refusal("base: {modes: [standby, can]}\n", {.protocol = "odrive"}),
              HasSubstr("only for protocol agilex"));
  EXPECT_EQ(refusal("base: {ignored_faults: [thermistor]}\n", {.protocol = "odrive"}), "");
}

/// The lab with another camera, and these settings of it.
Site site_with(const std::string& camera_lines) {
  const TemporaryFolder folder;
  std::filesystem::copy(lab, folder.path());
  std::ifstream stream(lab / "site.yaml");
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  const std::string camera = "camera: simulated\n";
  text.replace(text.find(camera), camera.size(), camera_lines);
  folder.write("site.yaml", text);
  return load_site(folder.path());
}

std::string site_refusal(const std::string& camera_lines) {
  try {
    (void)site_with(camera_lines);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(CameraSettings, are_read_from_the_site) {
  const CameraSettings settings =
      site_with(
          "camera: v4l2:/dev/video0\n"
          "camera_settings: {exposure_ms: 2.5, gain: 12, rate_hz: 30, latency_ms: 8, stamped_at: arrival}\n")
          .camera_settings;
  EXPECT_DOUBLE_EQ(*settings.exposure_s, 0.0025);
  EXPECT_EQ(settings.gain, 12);
  EXPECT_EQ(settings.rate_hz, 30.0);
  EXPECT_DOUBLE_EQ(settings.latency_s, 0.008);
  EXPECT_EQ(settings.stamped_at_start, false);
}

TEST(CameraSettings, of_a_machine_vision_camera_have_a_gain_in_decibels) {
  EXPECT_EQ(site_with("camera: genicam:Basler-1\ncamera_settings: {gain: -1.5}\n").camera_settings.gain,
            -1.5);
}

TEST(CameraSettings, are_refused_where_they_mean_nothing) {
  EXPECT_THAT(site_refusal("camera: genicam:any\ncamera_settings: {stamped_at: arrival}\n"),
              HasSubstr("stamped_at"));
  EXPECT_THAT(site_refusal("camera: simulated\ncamera_settings: {gain: 12}\n"), HasSubstr("only for v4l2:"));
  EXPECT_THAT(site_refusal("camera: v4l2:/dev/video0\ncamera_settings: {stamped_at: noon}\n"),
              HasSubstr("found 'noon', wanted exposure_start or arrival"));
  EXPECT_THAT(site_refusal("camera: v4l2:/dev/video0\ncamera_settings: {exposure_s: 1}\n"),
              HasSubstr("exposure_s"));
}

}  // namespace
}  // namespace lodestar

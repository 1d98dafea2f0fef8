#include <sstream>

#include "tests/can/lab.hpp"

// `lodestar doctor` reports why the robot does not move.
namespace lodestar {
namespace {

using namespace std::chrono_literals;

class Doctor : public CanLab {
 protected:
  /// Returns the exit code; the output is in `report`.
  std::optional<int> examine(const std::string& options = "") {
    Process doctor(
        {"sh", "-c", LODESTAR_BINARY " doctor " + site + " --can " + navigator_end + " " + options});
    const auto ended = doctor.wait(40s);
    report = doctor.end();
    return ended;
  }

  /// The line of that finding, and its remedy from the next line, if any.
  [[nodiscard]] std::string finding(const std::string& what) const {
    std::istringstream lines(report);
    std::string found;
    for (std::string line; std::getline(lines, line);) {
      const bool is_remedy = line.starts_with("    ");
      if (!found.empty()) return is_remedy ? found + line : found;
      constexpr std::size_t after_verdict = 4;
      if (!is_remedy && line.find(what + " ") == after_verdict) found = line;
    }
    return found;
  }

  void start_speaking_base(const std::string& options = "") {
    start_base(options);
    ASSERT_TRUE(witness->wait_for([](const CanFrame&) { return true; }, Stamp{}, 20s));
  }

  std::string report;
};

TEST_F(Doctor, finds_nothing_wrong_with_a_base_that_waits_for_a_drive) {
  start_speaking_base();
  EXPECT_EQ(examine(), 0) << report;
  for (const char* what :
       {"map", "registry", "interface", "base", "mode", "e-stop", "faults", "masters", "camera", "markers"}) {
    EXPECT_EQ(finding(what).substr(0, 2), "ok") << what << " in:\n" << report;
  }
  EXPECT_TRUE(witness->heard(is_motion_command, Stamp{}).empty()) << "the doctor commanded motion";

  EXPECT_EQ(examine("--json >doctor.json"), 0);
  EXPECT_TRUE(
      shell("python3 -c 'import json; found = json.load(open(\"doctor.json\")); "
            "assert {\"what\", \"verdict\", \"found\", \"remedy\"} == set(found[0]) and len(found) > 8'"));
}

TEST_F(Doctor, names_an_interface_that_is_missing_or_switched_off) {
  navigator_end = "vcan9";
  EXPECT_EQ(examine(), 1);
  EXPECT_NE(finding("interface").find("ip link add dev vcan9 type vcan"), std::string::npos) << report;

  navigator_end = "vcan0";
  ASSERT_TRUE(shell("ip link set vcan0 down"));
  EXPECT_EQ(examine(), 1);
  EXPECT_NE(finding("interface").find("ip link set vcan0 up"), std::string::npos) << report;
}

TEST_F(Doctor, names_a_base_that_is_off_and_a_camera_without_images) {
  EXPECT_EQ(examine(), 1);
  EXPECT_NE(finding("base").find("silent"), std::string::npos) << report;
  EXPECT_NE(finding("camera").find("no image"), std::string::npos) << report;
}

TEST_F(Doctor, names_a_camera_that_is_not_plugged_in) {
  ASSERT_TRUE(
      shell("cp -r " LODESTAR_SOURCE_DIR
            "/sites/lab plugged && sed -i 's|^camera:.*|camera: v4l2:/dev/video9|' plugged/site.yaml"));
  site = "plugged";
  start_speaking_base();
  EXPECT_EQ(examine(), 1);
  EXPECT_NE(finding("camera").find("/dev/video9"), std::string::npos) << report;
  EXPECT_EQ(finding("base").substr(0, 2), "ok") << "the other checks run nevertheless\n" << report;
}

/// Another master drives the base for a moment, then its emergency stop is pressed.
TEST_F(Doctor, names_an_emergency_stop_and_another_master) {
  start_speaking_base("--fault estop@0.1");
  Process other({"sh", "-c",
                 "cansend " + base_end + " 421#01; while sleep 0.02; do cansend " + base_end +
                     " 111#0064000000000000; done"});
  ASSERT_TRUE(witness->wait_for(
      [](const CanFrame& frame) {
        const auto state = agilex::decode_system_state(frame);
        return state && state->vehicle == VehicleState::emergency_stop;
      },
      Stamp{}, 20s));
  EXPECT_EQ(examine(), 1);
  EXPECT_NE(finding("e-stop").find("pressed"), std::string::npos) << report;
  EXPECT_NE(finding("masters").find("another program"), std::string::npos) << report;
  EXPECT_EQ(finding("masters").substr(0, 2), "??");
}

/// A fault that the base carries before anybody has driven it.
TEST_F(Doctor, names_a_fault_and_what_clears_it) {
  start_speaking_base("--protocol odrive --watchdog 0.3");
  ASSERT_TRUE(shell(
      "cp -r " LODESTAR_SOURCE_DIR
      "/sites/lab expired && sed -i 's/^base:.*/base: {bus: socketcan:vcan0, protocol: odrive, "
      "wheel_diameter_m: 0.17, left_node: 0, right_node: 1, right_is_mirrored: true}/' expired/site.yaml"));
  site = "expired";
  ASSERT_TRUE(shell("cansend vcan0 007#0800000000000000 && cansend vcan0 027#0800000000000000 && sleep 1"));
  EXPECT_EQ(examine(), 1);
  EXPECT_NE(finding("faults").find("watchdog expired"), std::string::npos) << report;
  EXPECT_NE(finding("faults").find("start a run and type resume"), std::string::npos) << report;
}

/// As `run` does. The modules are there again for the next test.
TEST_F(Doctor, names_a_kernel_without_can) {
  witness.reset();
  take_cable_away();
  ASSERT_TRUE(shell("rmmod can-gw slcan vxcan vcan can-raw can-dev can"));
  EXPECT_EQ(examine(), 1);
  EXPECT_NE(finding("interface").find("this kernel has no CAN"), std::string::npos) << report;
  EXPECT_EQ(finding("interface").find("ip link add"), std::string::npos) << report;
  EXPECT_TRUE(shell(
      "cd /usr/lib/uml/modules/$(uname -r)/kernel && for module in net/can/can net/can/can-raw "
      "net/can/can-gw "
      "drivers/net/can/dev/can-dev drivers/net/can/vcan drivers/net/can/vxcan drivers/net/can/slcan/slcan; "
      "do insmod $module.ko; done"));
}

}  // namespace
}  // namespace lodestar

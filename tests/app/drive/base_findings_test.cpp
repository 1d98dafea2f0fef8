#include "app/drive/base_findings.hpp"

#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/base/agilex_v2.hpp"
#include "drivers/system/clock.hpp"

namespace lodestar {
namespace {

using ::testing::HasSubstr;

/// A base that is listened to for a second.
struct ListenedTo {
  std::vector<Finding> examine(std::uint32_t ignored_bits = 0) {
    const auto protocol = make_agilex_protocol();
    HeardBase heard;
    const Stamp now = monotonic_now();
    for (int i = 0; i < 50; ++i) {
      if (counter_runs) ++state.counter;
      std::vector<CanFrame> frames{agilex::encode_system_state(state), agilex::encode_motion_state({})};
      if (has_odometer) frames.push_back(agilex::encode_odometer({}));
      for (const CanFrame& frame : frames) {
        const StampedCanFrame received{now - std::chrono::milliseconds(20 * (50 - i)), frame};
        heard.take(received, protocol->decode(received));
      }
    }
    return look_at_base(heard, *protocol, ignored_bits);
  }

  Finding finding(const std::string& what, std::uint32_t ignored_bits = 0) {
    const std::vector<Finding> findings = examine(ignored_bits);
    const auto found = std::ranges::find(findings, what, &Finding::what);
    return found == findings.end() ? Finding{} : *found;
  }

  SystemState state;
  bool counter_runs = true;
  bool has_odometer = true;
};

TEST(BaseFindings, of_a_base_that_waits_are_all_good) {
  for (const Finding& finding : ListenedTo().examine())
    EXPECT_EQ(finding.verdict, Verdict::good) << finding.what << ": " << finding.found;
}

TEST(BaseFindings, name_a_counter_that_stands_still) {
  ListenedTo base;
  base.counter_runs = false;
  base.state.counter = 7;
  EXPECT_EQ(base.finding("base").verdict, Verdict::bad);
  EXPECT_THAT(base.finding("base").found, HasSubstr("the counter in its state stands still at 7"));
}

TEST(BaseFindings, name_feedback_that_is_missing) {
  ListenedTo base;
  base.has_odometer = false;
  EXPECT_EQ(base.finding("base").verdict, Verdict::bad);
  EXPECT_THAT(base.finding("base").found, HasSubstr("no odometer"));
}

TEST(BaseFindings, tell_faults_from_warnings_and_from_what_the_robot_ignores) {
  ListenedTo base;
  base.state.fault_bits = 0x0400;
  EXPECT_EQ(base.finding("faults").verdict, Verdict::doubtful);
  EXPECT_THAT(base.finding("faults").found, HasSubstr("none that stops the robot, but: remote control lost"));
  base.state.fault_bits = 0x0500;
  EXPECT_EQ(base.finding("faults").verdict, Verdict::bad);
  EXPECT_EQ(base.finding("faults").found, "battery under-voltage");
  EXPECT_EQ(base.finding("faults", 0x0100).verdict, Verdict::doubtful);
}

TEST(BaseFindings, name_an_exception_without_a_fault_bit) {
  ListenedTo base;
  base.state.vehicle = VehicleState::exception;
  EXPECT_EQ(base.finding("faults").verdict, Verdict::bad);
  EXPECT_THAT(base.finding("faults").found, HasSubstr("exception"));
}

}  // namespace
}  // namespace lodestar

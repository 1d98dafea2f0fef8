#include "tests/can/lab.hpp"

// A bad or cut cable between navigator and base.
namespace lodestar {
namespace {

using namespace std::chrono_literals;

class CutLab : public CanLab {
 protected:
  /// Expects that the navigator, which no longer receives anything, stops within 100 ms and one command
  /// period, and reports the fault. Returns when it last received a frame of the base; nothing when it did
  /// not stop.
  std::optional<Stamp> expect_cut_noticed(const std::string& cut_by) {
    const auto says_anything = [](const CanFrame& frame) {
      return frame.id == agilex::system_state_id || frame.id == agilex::odometer_id;
    };
    Witness navigator_side(navigator_end);
    EXPECT_TRUE(navigator_side.wait_for(says_anything, Stamp{}, 1s));
    const Stamp cut = monotonic_now();
    EXPECT_TRUE(shell(cut_by));
    const auto zero = navigator_side.wait_for(is_zero_command, cut, 2s);
    EXPECT_TRUE(zero) << "no zero command";
    if (!zero) return std::nullopt;
    const Stamp last = navigator_side.heard(says_anything, Stamp{}, zero->stamp).back().stamp;
    expect_within(120ms, last, zero->stamp, "the zero command");
    EXPECT_TRUE(navigator_side.heard(is_moving_command, zero->stamp).empty());
    expect_said_within(120ms, "base: stopped by a fault", last);
    return last;
  }
};

class Cable : public CutLab {
 protected:
  void lay_cable() override {
    navigator_end = "vxcan0";
    base_end = "vxcan1";
    ASSERT_TRUE(
        shell("ip link add dev vxcan0 type vxcan peer name vxcan1 && ip link set vxcan0 txqueuelen 10 up && "
              "ip link set vxcan1 txqueuelen 10 up"));
  }
  void take_cable_away() override { (void)shell("ip link del vxcan0 2>/dev/null"); }

  /// In both directions.
  void spoil(const std::string& how) {
    for (const std::string& end : {navigator_end, base_end}) {
      ASSERT_TRUE(shell("tc qdisc replace dev " + end + " root netem limit 1000 " + how));
    }
  }

  void expect_to_arrive() {
    start_base();
    start_run("--goal 2.4,5.5");
    EXPECT_EQ(wait_for_the_end(40s), 0);
    const Truth truth = end_base();
    EXPECT_NEAR(truth.x_m, 2.4, 0.04);
    EXPECT_NEAR(truth.y_m, 5.5, 0.04);
    EXPECT_EQ(truth.contacts, 0);
  }
};

TEST_F(Cable, that_loses_a_third_of_the_frames_is_driven_through) {
  spoil("loss 30%");
  expect_to_arrive();
  EXPECT_FALSE(wait_for_words("fault", 0s)) << run->output();
}

TEST_F(Cable, that_loses_frames_in_bursts_is_driven_through) {
  spoil("loss gemodel 5% 30%");
  expect_to_arrive();
  EXPECT_FALSE(wait_for_words("fault", 0s)) << run->output();
}

TEST_F(Cable, that_delays_doubles_and_reorders_frames_is_driven_through) {
  spoil("delay 50ms 10ms duplicate 20%");
  expect_to_arrive();
  EXPECT_FALSE(wait_for_words("fault", 0s)) << run->output();
}

/// This bus has no checksum: a received frame may have a wrong arbitration ID, length or data.
TEST_F(Cable, that_spoils_what_the_base_says_breaks_nothing) {
  start_base();
  start_run("--goal 2.4,5.5");
  wait_until_driving();
  ASSERT_TRUE(shell("tc qdisc replace dev " + base_end + " root netem limit 1000 corrupt 20%"));
  EXPECT_FALSE(run->wait(3s)) << "the run ended early";
  ASSERT_TRUE(shell("tc qdisc del dev " + base_end + " root"));
  const bool is_stopped = wait_for_words("base: stopped by a fault", 1s);  // corrupt frames may say so
  EXPECT_EQ(is_stopped ? resume_and_wait_for_the_end(40s) : wait_for_the_end(40s), 0);
  const Truth truth = end_base();
  EXPECT_NEAR(truth.x_m, 2.4, 0.04);
  EXPECT_EQ(truth.contacts, 0);
}

TEST_F(Cable, that_is_cut_is_noticed_within_100_ms) {
  start_base();
  start_run("--goal 2.4,5.5");
  wait_until_driving();
  const std::optional<Stamp> last_heard = expect_cut_noticed("ip link set vxcan1 down");
  ASSERT_TRUE(last_heard);
  measure("cable cut", *last_heard);

  const Stamp back = monotonic_now();
  ASSERT_TRUE(shell("ip link set vxcan1 up"));
  EXPECT_FALSE(witness->wait_for(is_moving_command, back, 1s)) << "motion commanded without a resume";
  EXPECT_EQ(resume_and_wait_for_the_end(40s), 0);
}

TEST_F(Cable, that_takes_no_more_frames_is_noticed_and_brings_no_old_ones_later) {
  start_base();
  start_run("--goal 2.4,5.5");
  wait_until_driving();
  ASSERT_TRUE(shell("tc qdisc replace dev vxcan0 root netem limit 1 delay 1500ms"));
  EXPECT_TRUE(wait_for_words("base: stopped by a fault", 5s));
  const Stamp stalled = witness->last(is_moving_command).value_or(Stamp{});
  expect_said_within(140ms, "base: stopped by a fault", stalled);
  measure("interface takes no frames", stalled);
  ASSERT_TRUE(shell("tc qdisc del dev vxcan0 root"));
  const Stamp flows = monotonic_now();
  EXPECT_LE(witness->heard(is_moving_command, stalled + 300ms).size(), 2U) << "more than two old commands";
  EXPECT_FALSE(witness->wait_for(is_moving_command, flows, 1s)) << "motion commanded without a resume";
  EXPECT_EQ(resume_and_wait_for_the_end(40s), 0);
}

/// Two buses joined by a gateway that neither end sees: cutting it leaves both interfaces up.
class Gateway : public CutLab {
 protected:
  void lay_cable() override {
    navigator_end = "vcan0";
    base_end = "vcan1";
    ASSERT_TRUE(
        shell("for i in vcan0 vcan1; do ip link add dev $i type vcan && ip link set $i up || exit 1; done; "
              "cangw -A -s vcan0 -d vcan1 -e && cangw -A -s vcan1 -d vcan0 -e"));
  }
  void take_cable_away() override {
    (void)shell("cangw -F; ip link del vcan0; ip link del vcan1 2>/dev/null");
  }
};

TEST_F(Gateway, that_forwards_no_more_is_noticed_within_100_ms) {
  start_base();
  start_run("--goal 2.4,5.5");
  wait_until_driving();
  EXPECT_TRUE(expect_cut_noticed("cangw -F"));
}

}  // namespace
}  // namespace lodestar

#include <algorithm>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "drivers/base/base_driver.hpp"
#include "drivers/can/in_process_bus.hpp"
#include "drivers/simulation/disturbed_ceiling.hpp"
#include "drivers/simulation/fault_schedule.hpp"
#include "drivers/simulation/faulty_bus.hpp"
#include "drivers/simulation/faulty_camera.hpp"
#include "drivers/simulation/simulation.hpp"

// Each fault that the simulation injects, by itself.
#include "tests/maps/empty_floor.hpp"

namespace lodestar {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

MarkerRegistry three_markers() {
  return {{},
          {{447, {1.0, 1.0, 2.0}, 0.0, 0}, {1782, {2.0, 1.0, 2.0}, 0.0, 0}, {5, {5.0, 1.0, 2.0}, 0.0, 0}}};
}

Fault on_marker(FaultKind kind, int id) {
  return {.kind = kind, .marker = id, .shift_m = 0.5, .direction_rad = radians(90.0), .turn_rad = 0.1};
}

/// Frames whose gray level is their number.
class NumberedCamera final : public Camera {
 public:
  std::optional<Frame> poll() override {
    if (next_ == asked_for_) return std::nullopt;
    ++next_;
    return Frame{Stamp(milliseconds(50) * next_), cv::Mat(4, 4, CV_8UC1, cv::Scalar(next_))};
  }
  void expose() { ++asked_for_; }

 private:
  int next_ = 0;
  int asked_for_ = 0;
};

TEST(FaultSchedule, tells_what_is_on_and_whom_it_befalls) {
  FaultSchedule schedule({{.kind = FaultKind::marker_moved, .begin = seconds(2), .lasts = seconds(3)},
                          {.kind = FaultKind::camera_black, .begin = seconds(4), .latest_begin = seconds(6)}},
                         1);
  const MarkerRegistry markers = three_markers();
  EXPECT_FALSE(schedule.advance(Stamp(seconds(1)), {1.9, 1.0}, markers));
  EXPECT_TRUE(schedule.advance(Stamp(seconds(2)), {1.9, 1.0}, markers));
  ASSERT_EQ(schedule.active().size(), 1U);
  EXPECT_EQ(schedule.active().front().marker, 1782);
  schedule.advance(Stamp(milliseconds(5500)), {5.0, 1.0}, markers);
  EXPECT_TRUE(std::ranges::none_of(schedule.active(),
                                   [](const Fault& fault) { return fault.kind == FaultKind::marker_moved; }));
  schedule.advance(Stamp(seconds(6)), {5.0, 1.0}, markers);
  const std::vector<FaultEvent> events = schedule.events();
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].end, Stamp(seconds(5)));
  EXPECT_GE(events[1].begin, Stamp(seconds(4)));
  EXPECT_LE(events[1].begin, Stamp(seconds(6)));
  EXPECT_FALSE(events[1].end);
}

TEST(DisturbedCeiling, hangs_markers_as_the_faults_have_them) {
  const MarkerRegistry markers = three_markers();
  EXPECT_TRUE(disturbed(markers, {{.kind = FaultKind::markers_occluded}}).markers.empty());
  EXPECT_EQ(disturbed(markers, {on_marker(FaultKind::markers_occluded, 447)}).find(447), nullptr);
  const MarkerRegistry moved = disturbed(markers, {on_marker(FaultKind::marker_moved, 447)});
  EXPECT_LT((moved.find(447)->position_m - Vec3(1.0, 1.5, 2.0)).norm(), 1e-12);
  const MarkerRegistry doubled = disturbed(markers, {on_marker(FaultKind::marker_duplicated, 447)});
  EXPECT_EQ(std::ranges::count(doubled.markers, 447, &RegisteredMarker::id), 2);
  const MarkerRegistry wrong = disturbed(markers, {on_marker(FaultKind::marker_wrong_id, 447)});
  EXPECT_EQ(wrong.markers.front().id, 1782) << "the neighbour's ID";
  const MarkerRegistry swapped = disturbed(markers, {on_marker(FaultKind::markers_swapped, 447)});
  EXPECT_EQ(swapped.find(447)->position_m.x(), 2.0);
  EXPECT_EQ(swapped.find(1782)->position_m.x(), 1.0);
}

TEST(DisturbedCeiling, puts_lamps_around_the_marker) {
  Fault fault = on_marker(FaultKind::decoy_lamps, 447);
  fault.count = 30.0;
  const std::vector<CeilingDisc> lamps = decoy_lamps(three_markers(), {fault}, 3);
  ASSERT_EQ(lamps.size(), 30U);
  for (const CeilingDisc& lamp : lamps) EXPECT_LE((lamp.center_m - Vec3(1.0, 1.0, 2.0)).norm(), 0.5);
}

TEST(FaultyCamera, repeats_drops_blinds_and_delays) {
  NumberedCamera numbered;
  FaultyCamera camera(numbered, 1);
  int number = 0;
  const auto next = [&](const std::vector<Fault>& faults) {
    numbered.expose();
    camera.advance(Stamp(milliseconds(50) * ++number));
    camera.suffer(faults);
    return camera.poll();
  };
  const auto first_pixel = [](const Frame& frame) { return frame.gray.at<std::uint8_t>(0, 0); };
  EXPECT_EQ(first_pixel(next({}).value()), 1);
  const Frame frozen = next({{.kind = FaultKind::camera_frozen}}).value();
  EXPECT_EQ(first_pixel(frozen), 1);
  EXPECT_EQ(frozen.stamp, Stamp(milliseconds(100)));
  EXPECT_FALSE(next({{.kind = FaultKind::camera_dropped}}));
  EXPECT_LT(first_pixel(next({{.kind = FaultKind::camera_black}}).value()), 4);
  EXPECT_EQ(first_pixel(next({{.kind = FaultKind::camera_saturated}}).value()), 255);
  EXPECT_EQ(next({{.kind = FaultKind::clock_jump, .delay_s = 3600.0}})->stamp,
            Stamp(milliseconds(300) + seconds(3600)));
  EXPECT_FALSE(next({{.kind = FaultKind::camera_late, .delay_s = 0.1}}));
  EXPECT_FALSE(next({{.kind = FaultKind::camera_late, .delay_s = 0.1}}));
  EXPECT_EQ(next({{.kind = FaultKind::camera_late, .delay_s = 0.1}})->stamp, Stamp(milliseconds(350)));
}

TEST(FaultyBus, loses_doubles_delays_and_spoils_as_told) {
  constexpr int sent = 400;
  const auto received = [](const std::vector<Fault>& faults) {
    InProcessBus wire;
    CanBus& far_end = wire.attach();
    FaultyBus bus(wire.attach(), 5);
    bus.suffer(faults);
    std::vector<StampedCanFrame> frames;
    const CanFrame frame{.id = 0x221, .length = 8, .data = {1, 2, 3, 4, 5, 6, 7, 8}};
    for (int ms = 0; ms < 2 * sent + 200; ++ms) {
      if (ms % 2 == 0 && ms < 2 * sent) {
        EXPECT_TRUE(far_end.send(frame));
      }
      wire.advance(Stamp(milliseconds(ms)));
      bus.advance(Stamp(milliseconds(ms)));
      while (const auto heard = bus.poll()) {
        EXPECT_LE(heard->stamp, Stamp(milliseconds(ms)));
        frames.push_back(*heard);
      }
    }
    return frames;
  };
  EXPECT_EQ(received({}).size(), 400U);
  EXPECT_NEAR(static_cast<double>(received({{.kind = FaultKind::can_loss, .share = 0.3}}).size()), 280, 40);
  EXPECT_NEAR(static_cast<double>(received({{.kind = FaultKind::can_duplication, .share = 0.3}}).size()), 520,
              40);
  EXPECT_EQ(received({{.kind = FaultKind::can_delay, .delay_s = 0.05}}).size(), 400U);
  const auto spoiled = received({{.kind = FaultKind::can_corruption, .share = 0.2}});
  EXPECT_NEAR(
      static_cast<double>(std::ranges::count_if(
          spoiled, [](const auto& heard) { return heard.frame.id != 0x221 || heard.frame.length != 8; })),
      80, 30);
}

OccupancyMap free_floor() {
  return empty_floor(100, 60, 0.1);
}

/// Ground-truth distance after 3 s of a robot that is commanded to drive ahead.
double driven_m(const std::vector<Fault>& faults) {
  CameraModel camera;
  camera.width_px = 64;
  camera.height_px = 48;
  camera.fx_px = camera.fy_px = 32.0;
  SimulationOptions options;
  options.start.position_m = {3.0, 3.0};
  options.faults = faults;
  Simulation simulation(free_floor(), three_markers(), camera, options);
  BaseDriver driver(simulation.can());
  while (simulation.now() < Stamp(seconds(3))) {
    simulation.advance(milliseconds(20));
    driver.poll(simulation.now());
    driver.command({0.4, 0.0});
  }
  return (simulation.scorer().track().back().map_from_base.position_m - options.start.position_m).norm();
}

TEST(SimulationWithFaults, lets_wheels_slip_and_carries_the_robot_off) {
  const double usual_m = driven_m({});
  const double slipping_m =
      driven_m({{.kind = FaultKind::wheel_slip, .left_share = 0.5, .right_share = 0.5}});
  EXPECT_NEAR(slipping_m, 0.5 * usual_m, 0.05);
  const double carried_m =
      driven_m({{.kind = FaultKind::kidnapping, .begin = milliseconds(20), .shift_m = 1.5}});
  EXPECT_GT(std::abs(carried_m - usual_m), 0.1);
}

}  // namespace
}  // namespace lodestar

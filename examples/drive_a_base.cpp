// Drives a simulated base along a path, and prints where it is each second. The base answers late, and its
// left wheel is 2 % larger than anybody knows; the controller goes by the true pose, as markers would show
// it.
#include <chrono>
#include <cstdio>

#include "control/rotate_then_drive.hpp"

struct SimulatedBase {
  lodestar::Pose2 map_from_base;
  double left_mps = 0.0;
  double right_mps = 0.0;

  void step(const lodestar::BodyVelocity& command, double period_s) {
    constexpr double track_width_m = 0.40;
    constexpr double lag_s = 0.08;  // of its speed loop
    constexpr double left_share = 1.02;
    const double follows = period_s / (lag_s + period_s);
    const double half_turn_mps = 0.5 * track_width_m * command.turn_radps;
    left_mps += follows * (left_share * (command.forward_mps - half_turn_mps) - left_mps);
    right_mps += follows * (command.forward_mps + half_turn_mps - right_mps);
    const double forward_m = 0.5 * (left_mps + right_mps) * period_s;
    const double turn_rad = (right_mps - left_mps) / track_width_m * period_s;
    map_from_base = map_from_base * lodestar::Pose2{.position_m = {forward_m, 0.0}, .yaw_rad = turn_rad};
  }
};

int main() {
  using namespace std::chrono_literals;
  const lodestar::Path path{{{0.0, 0.0}, {2.0, 0.0}, {2.0, 1.5}}};
  const double final_yaw_rad = 0.0;
  lodestar::RotateThenDrive drive(path, final_yaw_rad);
  SimulatedBase base;

  const lodestar::Duration period = 20ms;
  const double period_s = std::chrono::duration<double>(period).count();
  lodestar::PoseEstimate estimate;
  for (int step = 0; step < 3000 && drive.phase() != lodestar::DrivePhase::arrived; ++step) {
    base.step(drive.update(estimate, period), period_s);
    estimate.map_from_base = base.map_from_base;
    estimate.stamp += period;
    const lodestar::Vec2& at_m = base.map_from_base.position_m;
    if (step % 50 == 0)
      std::printf("%5.1f s  x %.3f m  y %.3f m  yaw %.3f rad\n", step * period_s, at_m.x(), at_m.y(),
                  base.map_from_base.yaw_rad);
  }
  const bool has_arrived = drive.phase() == lodestar::DrivePhase::arrived;
  std::printf("%s at x %.3f m, y %.3f m\n", has_arrived ? "arrived" : "not arrived",
              base.map_from_base.position_m.x(), base.map_from_base.position_m.y());
  return has_arrived ? 0 : 1;
}

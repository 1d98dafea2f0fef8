// Follows a path with a base that does exactly what it is told, and prints where it is each second.
#include <chrono>
#include <cstdio>

#include "control/rotate_then_drive.hpp"

int main() {
  using namespace std::chrono_literals;
  const lodestar::Path path{{{0.0, 0.0}, {2.0, 0.0}, {2.0, 1.5}}};
  const double final_yaw_rad = 0.0;
  lodestar::RotateThenDrive drive(path, final_yaw_rad);

  const lodestar::Duration period = 20ms;
  const double period_s = std::chrono::duration<double>(period).count();
  lodestar::PoseEstimate estimate;
  for (int step = 0; step < 3000 && drive.phase() != lodestar::DrivePhase::arrived; ++step) {
    const lodestar::BodyVelocity command = drive.update(estimate, period);
    const lodestar::Pose2 motion{.position_m = {command.forward_mps * period_s, 0.0},
                                 .yaw_rad = command.turn_radps * period_s};
    estimate.map_from_base = estimate.map_from_base * motion;
    estimate.stamp += period;
    if (step % 50 == 0)
      std::printf("%5.1f s  x %.3f m  y %.3f m  yaw %.3f rad\n", step * period_s,
                  estimate.map_from_base.position_m.x(), estimate.map_from_base.position_m.y(),
                  estimate.map_from_base.yaw_rad);
  }
  const bool has_arrived = drive.phase() == lodestar::DrivePhase::arrived;
  std::printf("%s at x %.3f m, y %.3f m\n", has_arrived ? "arrived" : "not arrived",
              estimate.map_from_base.position_m.x(), estimate.map_from_base.position_m.y());
  return has_arrived ? 0 : 1;
}

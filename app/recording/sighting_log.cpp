#include "app/recording/sighting_log.hpp"

#include <fmt/ostream.h>

#include "maps/input_error.hpp"

namespace lodestar {

SightingLog::SightingLog(const std::filesystem::path& folder, const Robot& robot, const CameraModel& camera,
                         const SightingLogOptions& options)
    : folder_(folder),
      dots_(folder / "dots.csv", std::ios::binary | std::ios::trunc),
      wheels_(folder / "wheels.csv", std::ios::binary | std::ios::trunc),
      ceiling_(folder / "ceiling.csv", std::ios::binary | std::ios::trunc),
      follower_(robot, camera),
      on_frame_(options.on_frame),
      on_travel_(options.on_travel),
      on_ceiling_(options.on_ceiling),
      writer_(
          {.most_waiting = options.most_waiting,
           .can_wait = options.can_wait,
           .collect = std::chrono::milliseconds(100),
           .tell = options.tell,
           .disk = options.disk},
          [this](const Item& item) { write(item); },
          [this] {
            dots_.flush();
            wheels_.flush();
            ceiling_.flush();
            check();
          }) {
  dots_ << "stamp_s,id,dot,u_px,v_px,sigma_px\n";
  wheels_ << "stamp_s,left_m,right_m\n";
  ceiling_ << "from_s,to_s,x_m,y_m,yaw_deg,xx,xy,xyaw,yy,yyaw,yawyaw,sway_m\n";
  check();
}

void SightingLog::take(const SensorInput& input) {
  if (input.frames.empty() && input.base.travel.empty()) return;
  writer_.put({.frames = input.frames, .travel = input.base.travel});
}

void SightingLog::write(const Item& item) {
  check();
  for (const WheelTravel& travel : item.travel) {
    if (last_travel_ && travel.stamp - *last_travel_ < std::chrono::microseconds(1))
      continue;  // written alike
    last_travel_ = travel.stamp;
    fmt::print(wheels_, "{:.6f},{:.6f},{:.6f}\n", seconds(travel.stamp), travel.left_m, travel.right_m);
    follower_.add(travel);
    if (on_travel_) on_travel_(travel);
  }
  for (const Frame& frame : item.frames) write(frame);
}

void SightingLog::write(const Frame& frame) {
  SurveyFrame sighted{.stamp = frame.stamp, .markers = {}};
  const std::span<const DetectedMarker> markers = detector_.detect(frame.gray);
  for (const DetectedMarker& marker : markers) {
    sighted.markers.push_back({marker.id, marker.dots});
    for (const MarkerDot& dot : marker.dots)
      fmt::print(dots_, "{:.6f},{},{},{:.4f},{:.4f},{:.4f}\n", seconds(frame.stamp), marker.id,
                 marker_grid_size * dot.cell.row + dot.cell.column, dot.center_px.x(), dot.center_px.y(),
                 dot.sigma_px);
  }
  if (on_frame_) on_frame_(sighted);
  if (const auto motion = follower_.see(frame, markers)) write(*motion);
}

/// The motion's frame is the base at `from_s`; xx to yawyaw are its covariance, in metres and radians.
void SightingLog::write(const VisualOdometryIncrement& motion) {
  const Pose2& pose = motion.then_from_now;
  const Eigen::Matrix3d& c = motion.covariance;
  fmt::print(ceiling_,
             "{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.5f}\n",
             seconds(motion.from), seconds(motion.to), pose.position_m.x(), pose.position_m.y(),
             degrees(pose.yaw_rad), c(0, 0), c(0, 1), c(0, 2), c(1, 1), c(1, 2), c(2, 2), motion.sway_m);
  if (on_ceiling_) on_ceiling_(motion);
}

void SightingLog::check() const {
  if (!dots_) throw InputError(folder_ / "dots.csv", 0, "a file that cannot be written", "one that can");
  if (!ceiling_)
    throw InputError(folder_ / "ceiling.csv", 0, "a file that cannot be written", "one that can");
  if (!wheels_) throw InputError(folder_ / "wheels.csv", 0, "a file that cannot be written", "one that can");
}

}  // namespace lodestar

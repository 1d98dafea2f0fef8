#include "app/bench/survey_world.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "localization/pose/map_estimate.hpp"
#include "maps/marker.hpp"
#include "maps/random.hpp"
#include "maps/rotation_vector.hpp"

namespace lodestar {
namespace {

constexpr std::uint64_t hanging_stream = 1;
constexpr std::uint64_t lean_stream = 2;
constexpr std::uint64_t slip_stream = 3;
constexpr std::uint64_t dots_stream = 4;
constexpr std::uint64_t view_stream = 5;
constexpr double step_s = 0.01;
constexpr int readings_every = 2;  // steps: 50 Hz

/// A lean that wanders about zero (Ornstein and Uhlenbeck 1930).
class Lean {
 public:
  Lean(double sigma, double time_s, Random random)
      : kept_(std::exp(-step_s / time_s)), fresh_(sigma * std::sqrt(1.0 - kept_ * kept_)), random_(random) {}
  const Vec2& next() {
    for (int axis = 0; axis < 2; ++axis) lean_[axis] = kept_ * lean_[axis] + fresh_ * random_.normal();
    return lean_;
  }

 private:
  double kept_;
  double fresh_;
  Random random_;
  Vec2 lean_ = Vec2::Zero();
};

/// One drive in small steps.
class Drive {
 public:
  Drive(const SurveyWorld& world, const std::vector<Vec2>& way_m, std::uint64_t seed, Stamp start)
      : world_(world),
        options_(world.options),
        way_(way_m),
        stamp_(start),
        lean_(options_.lean_sigma_rad, options_.lean_time_s, Random(seed).stream(lean_stream)),
        slip_(Random(seed).stream(slip_stream)),
        dots_(Random(seed).stream(dots_stream)),
        view_(Random(seed).stream(view_stream)) {}

  SurveyDrive run() {
    pose_ = {way_.front(), way_.size() > 1 ? heading_between(way_[0], way_[1]) : 0.0};
    read_wheels();
    see();
    for (std::size_t i = 1; i < way_.size(); ++i) {
      turn_to(heading_between(pose_.position_m, way_[i]));
      go((way_[i] - pose_.position_m).norm());
    }
    return std::move(drive_);
  }

 private:
  void turn_to(double heading) {
    double left = wrap_angle(heading - pose_.yaw_rad);
    while (std::abs(left) > 1e-9) {
      const double turn = std::clamp(left, -options_.turn_radps * step_s, options_.turn_radps * step_s);
      step(0.0, turn);
      left -= turn;
    }
  }

  void go(double distance_m) {
    while (distance_m > 1e-9) {
      const double way = std::min(distance_m, options_.speed_mps * step_s);
      step(way, 0.0);
      distance_m -= way;
    }
    drive_.length_m += distance_m;
  }

  /// The base moves by (way, turn); wheels report what they roll, which is that and slip.
  void step(double way_m, double turn_rad) {
    const double track_m = options_.track_scale * world_.belief.track_width_m;
    const Vec2 rolled(way_m - 0.5 * turn_rad * track_m, way_m + 0.5 * turn_rad * track_m);
    for (int wheel = 0; wheel < 2; ++wheel) {
      const double slip =
          options_.slip_sigma_per_sqrt_m * std::sqrt(std::abs(rolled[wheel])) * slip_.normal();
      reported_[wheel] += (rolled[wheel] + slip) / options_.wheel_scales[wheel];
    }
    const double sideways =
        options_.sideways_sigma_per_sqrt_m * std::sqrt(0.5 * rolled.cwiseAbs().sum()) * slip_.normal();
    const double middle = pose_.yaw_rad + 0.5 * turn_rad;
    pose_.position_m += way_m * Vec2(std::cos(middle), std::sin(middle)) +
                        sideways * Vec2(-std::sin(middle), std::cos(middle));
    pose_.yaw_rad = wrap_angle(pose_.yaw_rad + turn_rad);
    drive_.length_m += std::abs(way_m);
    lean_now_ = lean_.next();
    stamp_ += from_seconds(step_s);
    ++steps_;
    if (steps_ % readings_every == 0) read_wheels();
    if (steps_ % frame_every() == 0) see();
  }

  [[nodiscard]] int frame_every() const {
    return std::max(1, static_cast<int>(std::lround(1.0 / (options_.frames_hz * step_s))));
  }

  void read_wheels() {
    const auto counted = [this](double travel_m) {
      return options_.encoder_step_m * std::floor(travel_m / options_.encoder_step_m);
    };
    drive_.log.wheels.push_back(
        {stamp_ + options_.wheels_late, counted(reported_[0]), counted(reported_[1])});
  }

  void see() {
    CameraModel camera = world_.camera;
    camera.coefficients[0] += options_.k1_off;
    const Eigen::Isometry3d map_from_camera =
        lifted(pose_) * Eigen::Isometry3d(rotation_by({lean_now_.x(), lean_now_.y(), 0.0})) *
        options_.base_from_camera;
    SurveyFrame frame{.stamp = stamp_};
    constexpr double near_m = 4.0;
    for (std::size_t m = 0; m < world_.markers.size(); ++m) {
      if ((world_.markers[m].position_m.head<2>() - pose_.position_m).norm() > near_m) continue;
      if (auto sighting = sighting_of(m, map_from_camera, camera))
        frame.markers.push_back(std::move(*sighting));
    }
    if (options_.follows_ceiling) follow_ceiling(map_from_camera);
    drive_.log.frames.push_back(std::move(frame));
    drive_.map_from_base.push_back(pose_);
    drive_.leans_rad.push_back(lean_now_);
  }

  /// Where the camera looks at the ceiling, and how it is turned.
  [[nodiscard]] Pose2 view_of(const Eigen::Isometry3d& map_from_camera) const {
    const Vec3 axis = map_from_camera.linear().col(2);
    const Vec3 across = map_from_camera.linear().col(0);
    const double above_m = world_.markers.front().position_m.z() - map_from_camera.translation().z();
    return {map_from_camera.translation().head<2>() + above_m / axis.z() * axis.head<2>(),
            std::atan2(across.y(), across.x())};
  }

  /// As visual odometry sees it: keyframes every half a metre, its own noise, a believed mount and height.
  void follow_ceiling(const Eigen::Isometry3d& map_from_camera) {
    constexpr double keyframe_m = 0.5;
    constexpr double nearest_m = 0.01;
    constexpr double sigma_m = 0.0006;
    constexpr double sigma_rad = radians(0.025);
    const Pose2 view = view_of(map_from_camera);
    if (!keyframe_) {
      keyframe_ = {stamp_, view};
      return;
    }
    Pose2 way = inverse(keyframe_->second) * view;
    if (way.position_m.norm() < nearest_m && std::abs(way.yaw_rad) < sigma_rad * 40.0) return;
    const bool is_far = way.position_m.norm() > keyframe_m || std::abs(way.yaw_rad) > radians(40.0);
    way.position_m = options_.ceiling_scale * way.position_m + sigma_m * Vec2(view_.normal(), view_.normal());
    way.yaw_rad = wrap_angle(way.yaw_rad + sigma_rad * view_.normal());
    const Pose2 mount{world_.belief.base_from_camera.translation().head<2>(), 0.0};
    const double above_m = world_.markers.front().position_m.z() - map_from_camera.translation().z();
    VisualOdometryIncrement motion{.from = keyframe_->first,
                                   .to = stamp_,
                                   .then_from_now = mount * way * inverse(mount),
                                   .sway_m = above_m * options_.lean_sigma_rad};
    motion.covariance.diagonal() << square(sigma_m), square(sigma_m), square(sigma_rad);
    drive_.log.ceiling.push_back(motion);
    if (is_far) keyframe_ = {stamp_, view};
  }

  std::optional<SightedMarker> sighting_of(std::size_t m, const Eigen::Isometry3d& map_from_camera,
                                           const CameraModel& camera) {
    constexpr double margin_px = 5.0;
    const RegisteredMarker& marker = world_.markers[m];
    const Eigen::Matrix3d tilt = rotation_by({0.0, 0.0, marker.yaw_rad}) *
                                 rotation_by({world_.tilts_rad[m].x(), world_.tilts_rad[m].y(), 0.0}) *
                                 Eigen::DiagonalMatrix<double, 3>(1.0, -1.0, -1.0);
    SightedMarker sighting{.id = marker.id};
    for (const GridCell cell : dots_of(marker.id)) {
      const auto index = static_cast<std::size_t>(marker_grid_size * cell.row + cell.column);
      const Vec2 in_plane = options_.print_scale * (cell_in_marker(cell) + world_.dot_offsets_m[m][index]);
      const Vec3 point = marker.position_m + tilt * Vec3(in_plane.x(), in_plane.y(), 0.0);
      const auto seen = project_dot(map_from_camera, point, camera);
      if (!seen || !camera.contains(seen->pixel, margin_px)) return std::nullopt;
      const Vec2 noise(options_.dot_sigma_px * dots_.normal(), options_.dot_sigma_px * dots_.normal());
      sighting.dots.push_back({cell, seen->pixel + noise, options_.dot_sigma_px});
    }
    return sighting;
  }

  const SurveyWorld& world_;
  const SurveyWorldOptions& options_;
  const std::vector<Vec2>& way_;
  Stamp stamp_;
  Lean lean_;
  Random slip_;
  Random dots_;
  Random view_;
  std::optional<std::pair<Stamp, Pose2>> keyframe_;
  Pose2 pose_;
  Vec2 lean_now_ = Vec2::Zero();
  Vec2 reported_ = Vec2::Zero();
  int steps_ = 0;
  SurveyDrive drive_;
};

}  // namespace

SurveyWorld make_survey_world(std::vector<RegisteredMarker> markers, const SurveyWorldOptions& options,
                              std::uint64_t seed) {
  SurveyWorld world{.options = options, .markers = std::move(markers)};
  world.camera = {.width_px = 640,
                  .height_px = 480,
                  .fx_px = options.focal_px,
                  .fy_px = options.focal_px,
                  .cx_px = 319.5,
                  .cy_px = 239.5,
                  .distortion = Distortion::plumb_bob,
                  .coefficients = {-0.06, 0.01}};
  world.belief.lean_sigma_rad = options.lean_sigma_rad;
  world.belief.base_from_camera.translation() = Vec3(-0.1, 0.02, 1.1);
  world.belief.wheels.sideways_sigma_per_sqrt_m = 0.001;
  // Off by a centimetre and by what a bracket is bent.
  Random random = Random(seed).stream(hanging_stream);
  world.options.base_from_camera = Eigen::Isometry3d::Identity();
  world.options.base_from_camera.translation() = Vec3(-0.11, 0.028, 1.1);
  world.options.base_from_camera.linear() = rotation_by({radians(0.3), radians(-0.2), radians(1.0)});
  for (RegisteredMarker& marker : world.markers) {
    marker.position_m.z() +=
        std::tan(options.incline_rad) * marker.position_m.x() + options.roughness_m * random.normal();
    std::vector<Vec2>& offsets = world.dot_offsets_m.emplace_back();
    for (int cell = 0; cell < marker_grid_size * marker_grid_size; ++cell)
      offsets.emplace_back(options.dot_place_sigma_m * random.normal(),
                           options.dot_place_sigma_m * random.normal());
    world.tilts_rad.emplace_back(options.marker_tilt_sigma_rad * random.normal(),
                                 options.marker_tilt_sigma_rad * random.normal());
  }
  if (options.step_m != 0.0) {
    const double middle_m = 0.5 * std::ranges::max_element(world.markers, {}, [](const RegisteredMarker& m) {
                                    return m.position_m.x();
                                  })->position_m.x();
    for (RegisteredMarker& marker : world.markers)
      if (marker.position_m.x() > middle_m) marker.position_m.z() -= options.step_m;
  }
  return world;
}

SurveyDrive drive_survey(const SurveyWorld& world, const std::vector<Vec2>& way_m, std::uint64_t seed,
                         Stamp start) {
  return Drive(world, way_m, seed, start).run();
}

std::vector<RegisteredMarker> marker_grid(double width_m, double depth_m, double pitch_m, double height_m,
                                          std::uint64_t seed) {
  Random random(seed);
  std::set<int> used;
  std::vector<RegisteredMarker> markers;
  for (double y = 0.5 * pitch_m; y < depth_m; y += pitch_m) {
    for (double x = 0.5 * pitch_m; x < width_m; x += pitch_m) {
      int id = 0;
      do id = static_cast<int>(random.below(marker_id_count));
      while (dots_of(id).size() < 6 || !used.insert(id).second);
      constexpr double askew_m = 0.15;
      markers.push_back({.id = id,
                         .position_m = {x + random.uniform(-askew_m, askew_m),
                                        y + random.uniform(-askew_m, askew_m), height_m},
                         .yaw_rad = random.uniform(-std::numbers::pi, std::numbers::pi)});
    }
  }
  return markers;
}

std::vector<Vec2> mower_lanes(double width_m, double depth_m, double lane_m, double margin_m) {
  std::vector<Vec2> way;
  bool back = false;
  for (double y = margin_m; y <= depth_m - margin_m + 1e-9; y += lane_m, back = !back) {
    way.emplace_back(back ? width_m - margin_m : margin_m, y);
    way.emplace_back(back ? margin_m : width_m - margin_m, y);
  }
  return way;
}

std::vector<Vec2> cross_lanes(double width_m, double depth_m, double lane_m, double margin_m) {
  std::vector<Vec2> way = mower_lanes(depth_m, width_m, lane_m, margin_m);
  for (Vec2& point : way) std::swap(point.x(), point.y());
  return way;
}

}  // namespace lodestar

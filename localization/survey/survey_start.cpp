#include "localization/survey/survey_start.hpp"

#include <cmath>
#include <numbers>

#include "localization/survey/heading_chain.hpp"
#include "localization/survey/linear_rows.hpp"

namespace lodestar {
namespace {

constexpr double heading_sigma_rad = radians(0.1);  // of a marker seen by a robot that leans
constexpr double lean_sigma = 0.005;                // of its place, over its distance
constexpr int reweightings = 4;

Vec2 turned(double heading_rad, const Vec2& v) {
  return Eigen::Rotation2Dd(heading_rad) * v;
}

/// Cauchy's weight of a residual in sigmas.
double weight_of(double residual) {
  constexpr double scale = 5.0;
  return 1.0 / (1.0 + square(residual / scale));
}

/// (b) Unknowns: the heading of each keyframe, the yaw of each marker, and turn per reported metre of the
/// right and of the left wheel.
struct Headings {
  std::vector<double> of_keyframe;
  std::vector<double> of_marker;
  Vec2 turn_per_m = Vec2::Zero();  ///< left, right
};

std::optional<Headings> solve_headings(const SurveyKeyframes& keyframes, const SurveyBelief& belief,
                                       const SurveyOptions& options) {
  const auto frames = static_cast<int>(keyframes.frames.size());
  const auto markers = static_cast<int>(keyframes.ids.size());
  const HeadingChain chain = chain_headings(keyframes, belief.track_width_m);
  const int left_at = frames + markers;
  const int right_at = left_at + 1;
  const double per_m = 1.0 / belief.track_width_m;
  const WheelGauge nominal{.track_m = belief.track_width_m};
  Eigen::VectorXd solution;
  for (int round = 0; round < reweightings; ++round) {
    LinearRows rows(right_at + 1);
    rows.add({{0, 1.0}}, chain.heading_rad[0], 1e-6);
    rows.add({{left_at, 1.0}}, per_m, per_m * options.wheel_sigma);
    rows.add({{right_at, 1.0}}, per_m, per_m * options.wheel_sigma);
    for (int i = 0; i < frames; ++i) {
      const SurveyKeyframe& frame = keyframes.frames[static_cast<std::size_t>(i)];
      if (frame.from_previous) {
        const Vec2 rolled = frame.from_previous->travel_m();
        const double sigma = std::sqrt(frame.from_previous->covariance(nominal, belief.wheels)(2, 2));
        rows.add({{i, 1.0}, {i - 1, -1.0}, {right_at, -rolled.y()}, {left_at, rolled.x()}}, 0.0, sigma);
      }
      for (std::size_t k = 0; k < frame.sightings.size(); ++k) {
        const int marker_at = frames + static_cast<int>(frame.sightings[k].marker);
        const double yaw = chain.yaw_less_heading[static_cast<std::size_t>(i)][k];
        double sigma = heading_sigma_rad;
        if (round > 0)
          sigma /= std::sqrt(weight_of((solution[marker_at] - solution[i] - yaw) / heading_sigma_rad));
        rows.add({{marker_at, 1.0}, {i, -1.0}}, yaw, sigma);
      }
    }
    std::optional<Eigen::VectorXd> solved = rows.solve();
    if (!solved) return std::nullopt;
    solution = std::move(*solved);
  }
  Headings headings{.turn_per_m = {solution[left_at], solution[right_at]}};
  headings.of_keyframe.assign(solution.data(), solution.data() + frames);
  headings.of_marker.assign(solution.data() + frames, solution.data() + left_at);
  return headings;
}

/// Turn = ((1 + d) right - (1 - d) left) / track.
WheelGauge gauge_of(const Vec2& turn_per_m) {
  const double sum = turn_per_m.sum();
  return {.difference = (turn_per_m.y() - turn_per_m.x()) / sum, .track_m = 2.0 / sum};
}

/// (c) Unknowns: x and y of each keyframe and marker, of the mount, and the wheels' scale.
bool solve_positions(const SurveyKeyframes& keyframes, const Headings& headings, const SurveyBelief& belief,
                     const SurveyOptions& options, SurveyStart& start) {
  const auto frames = static_cast<int>(keyframes.frames.size());
  const auto markers = static_cast<int>(keyframes.ids.size());
  const int mount_at = 2 * (frames + markers);
  const int scale_at = mount_at + 2;
  const Vec2 mount = belief.base_from_camera.translation().head<2>();
  Eigen::VectorXd solution;
  for (int round = 0; round < reweightings; ++round) {
    LinearRows rows(scale_at + 1);
    rows.add({{scale_at, 1.0}}, 1.0, options.wheel_sigma);
    for (int axis = 0; axis < 2; ++axis) {
      rows.add({{axis, 1.0}}, 0.0, 1e-6);
      rows.add({{mount_at + axis, 1.0}}, mount[axis], options.mount_sigma_m);
    }
    for (int i = 0; i < frames; ++i) {
      const SurveyKeyframe& frame = keyframes.frames[static_cast<std::size_t>(i)];
      const double heading = headings.of_keyframe[static_cast<std::size_t>(i)];
      if (frame.from_previous) {
        const double before = headings.of_keyframe[static_cast<std::size_t>(i - 1)];
        const WheelMotion rolled = frame.from_previous->motion(start.gauge);
        const Vec2 way = turned(before, rolled.way_m);
        const Eigen::Matrix3d covariance = frame.from_previous->covariance(start.gauge, belief.wheels);
        const double sigma = std::sqrt(covariance.topLeftCorner<2, 2>().trace() + square(2e-3));
        for (int axis = 0; axis < 2; ++axis)
          rows.add({{2 * i + axis, 1.0}, {2 * (i - 1) + axis, -1.0}, {scale_at, -way[axis]}}, 0.0, sigma);
      }
      // What the mount is off by turns with the robot.
      Eigen::Matrix2d turn;
      turn << std::cos(heading), -std::sin(heading), std::sin(heading), std::cos(heading);
      for (const KeyframeSighting& sighting : frame.sightings) {
        const int marker_at = 2 * (frames + static_cast<int>(sighting.marker));
        const Vec2 seen = turn * (sighting.base_from_marker.position_m - mount);
        double sigma = std::max(lean_sigma * sighting.above_camera_m, 1e-3);
        if (round > 0) {
          const Vec2 off = solution.segment<2>(marker_at) - solution.segment<2>(2 * i) -
                           turn * solution.segment<2>(mount_at) - seen;
          sigma /= std::sqrt(weight_of(off.norm() / sigma));
        }
        for (int axis = 0; axis < 2; ++axis) {
          rows.add({{marker_at + axis, 1.0},
                    {2 * i + axis, -1.0},
                    {mount_at, -turn(axis, 0)},
                    {mount_at + 1, -turn(axis, 1)}},
                   seen[axis], sigma);
        }
      }
    }
    std::optional<Eigen::VectorXd> solved = rows.solve();
    if (!solved) return false;
    solution = std::move(*solved);
  }
  for (int i = 0; i < frames; ++i)
    start.map_from_base.push_back(
        {solution.segment<2>(2 * i), wrap_angle(headings.of_keyframe[static_cast<std::size_t>(i)])});
  for (int m = 0; m < markers; ++m)
    start.map_from_marker.push_back(
        {solution.segment<2>(2 * (frames + m)), wrap_angle(headings.of_marker[static_cast<std::size_t>(m)])});
  start.mount_m = solution.segment<2>(mount_at);
  start.wheel_scale = solution[scale_at];
  return true;
}

}  // namespace

std::optional<SurveyStart> start_survey(const SurveyKeyframes& keyframes, const SurveyBelief& belief,
                                        const SurveyOptions& options) {
  const std::optional<Headings> headings = solve_headings(keyframes, belief, options);
  if (!headings) return std::nullopt;
  SurveyStart start;
  start.gauge = gauge_of(headings->turn_per_m);
  if (!solve_positions(keyframes, *headings, belief, options, start)) return std::nullopt;
  return start;
}

}  // namespace lodestar

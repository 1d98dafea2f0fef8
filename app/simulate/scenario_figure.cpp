#include "app/simulate/scenario_figure.hpp"

#include <fmt/format.h>

#include "app/report/canvas.hpp"

namespace lodestar {
namespace {

// Blue, green, red.
const cv::Scalar robot_color(190, 90, 20);
const cv::Scalar disc_color(50, 50, 220);
const cv::Scalar faint_disc_color(190, 190, 240);
const cv::Scalar faint_robot_color(235, 205, 180);
const cv::Scalar goal_color(70, 150, 40);
const cv::Scalar ink(40, 40, 40);

constexpr double width_px = 1600.0;
constexpr Duration second = std::chrono::seconds(1);

void draw_disc_way(Canvas& canvas, const MovingDisc& disc, Stamp end) {
  constexpr Duration step = std::chrono::milliseconds(100);
  const double radius_px = disc.radius_m * canvas.pixels_per_m();
  FollowedTrajectory way(disc);
  std::vector<Vec2> points_m;
  Vec2 last_m = Vec2::Zero();
  for (Stamp now; now <= end; now += step) {
    last_m = way.at(now).position_m;
    if (now.time_since_epoch() % second == Duration::zero() && disc.trajectory.keys.size() > 1)
      canvas.draw_ring(last_m, radius_px, faint_disc_color, 1.0);
    points_m.push_back(last_m);
  }
  if (points_m.size() > 1) canvas.draw_line(points_m, faint_disc_color, 1.5);
  canvas.draw_ring(last_m, radius_px, disc_color, 2.0);
}

void draw_track(Canvas& canvas, const std::vector<TruePose>& track, double radius_m) {
  std::vector<Vec2> points_m;
  for (const TruePose& pose : track) {
    points_m.push_back(pose.map_from_base.position_m);
    if (pose.stamp.time_since_epoch() % second == Duration::zero())
      canvas.draw_ring(points_m.back(), radius_m * canvas.pixels_per_m(), faint_robot_color, 1.0);
  }
  if (points_m.size() > 1) canvas.draw_line(points_m, robot_color, 2.5);
  if (!points_m.empty())
    canvas.draw_ring(points_m.back(), radius_m * canvas.pixels_per_m(), robot_color, 2.5);
}

}  // namespace

cv::Mat draw_scenario(const Scenario& scenario, const ScenarioRun& run) {
  Canvas canvas = canvas_for(scenario.site.map.map, width_px);
  canvas.draw_map(scenario.site.map.map);
  canvas.draw_frame();
  const Vec2& goal_m = scenario.site.goals.front().position_m;
  canvas.draw_ring(goal_m, scenario.goal_radius_m * canvas.pixels_per_m(), goal_color, 2.5);
  canvas.draw_disc(goal_m, 4.0, goal_color);
  canvas.draw_disc(scenario.site.start.position_m, 6.0, robot_color);
  const Stamp end = run.track.empty() ? Stamp{} : run.track.back().stamp;
  for (const MovingDisc& disc : scenario.discs) draw_disc_way(canvas, disc, end);
  draw_track(canvas, run.track, scenario.site.robot.radius_m);
  const Vec2 corner_px = canvas.pixel(canvas.low_m());
  canvas.draw_text_px({corner_px.x(), corner_px.y() + 40.0},
                      fmt::format("{}, seed {}: {} after {:.1f} s; contacts while moving {}, excused {}, at "
                                  "rest {}",
                                  scenario.site.name, run.seed, run.reason, run.time_s, run.contacts.moving,
                                  run.contacts.excused, run.contacts.at_rest),
                      16.0, ink);
  return canvas.picture();
}

}  // namespace lodestar

#include "app/report/figure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "app/report/canvas.hpp"
#include "app/report/places_figure.hpp"
#include "app/report/run_statistics.hpp"
#include "app/report/ticks.hpp"
#include "app/report/visibility_figure.hpp"
#include "maps/marker.hpp"

namespace lodestar {
namespace {

// Blue, green, red.
const cv::Scalar ink(40, 40, 40);
const cv::Scalar faint(130, 130, 130);
const cv::Scalar marker_color(0, 140, 255);
const cv::Scalar planned_color(50, 50, 220);
const std::array track_colors{cv::Scalar(190, 90, 20), cv::Scalar(140, 160, 0)};  ///< there, back
const cv::Scalar start_color(70, 150, 40);
const cv::Scalar white(255, 255, 255);

constexpr double figure_width_px = 1800.0;
constexpr double text_px = 20.0;
constexpr double marker_radius_px = 9.0;
constexpr double track_radius_px = 5.0;
constexpr double track_spacing_m = 0.2;
const Vec3 middle_of_marker(1.5 * marker_pitch_m, 1.5 * marker_pitch_m, 0.0);

std::vector<double> ticks(double low_m, double high_m, double spacing_m) {
  std::vector<double> result;
  const int last = static_cast<int>(std::floor(high_m / spacing_m + 1e-9));
  for (int k = static_cast<int>(std::ceil(low_m / spacing_m - 1e-9)); k <= last; ++k) {
    result.push_back(k * spacing_m);
  }
  return result;
}

void draw_axes(Canvas& canvas) {
  canvas.draw_frame();
  const Vec2 low = canvas.pixel(canvas.low_m());
  const double spacing = tick_spacing((canvas.high_m() - canvas.low_m()).maxCoeff(), 10.0);
  for (const double x : ticks(canvas.low_m().x(), canvas.high_m().x(), spacing)) {
    const double at = canvas.pixel({x, 0.0}).x();
    canvas.draw_line_px({at, low.y()}, {at, low.y() + 8.0}, faint, 1.5);
    canvas.draw_text_px({at, low.y() + 26.0}, fmt::format("{:g}", x), text_px * 0.85, ink, 0.5);
  }
  for (const double y : ticks(canvas.low_m().y(), canvas.high_m().y(), spacing)) {
    const double at = canvas.pixel({0.0, y}).y();
    canvas.draw_line_px({low.x() - 8.0, at}, {low.x(), at}, faint, 1.5);
    canvas.draw_text_px({low.x() - 16.0, at}, fmt::format("{:g}", y), text_px * 0.85, ink, 1.0);
  }
  canvas.draw_text_px({low.x() - 74.0, canvas.pixel(canvas.high_m()).y() - 30.0}, "y (m)", text_px * 0.85,
                      ink);
  canvas.draw_text_px({canvas.pixel(canvas.high_m()).x(), low.y() + 56.0}, "x (m)", text_px * 0.85, ink, 1.0);
}

/// A disc at the centre of each marker and a stroke in the direction O to X.
void draw_markers(Canvas& canvas, const MarkerRegistry& registry) {
  for (const RegisteredMarker& marker : registry.markers) {
    const Eigen::Isometry3d pose = map_from_marker(registry, marker);
    const Vec2 at = canvas.pixel((pose * middle_of_marker).head<2>());
    const Vec3 x_axis = pose.linear().col(0);
    const Vec2 ahead(x_axis.x(), -x_axis.y());
    canvas.draw_line_px(at, at + 19.0 * ahead, marker_color, 2.5);
    canvas.draw_disc_px(at, marker_radius_px, marker_color);
  }
}

/// How much a label at this offset would cover: the marker's own stroke, an obstacle, a planned curve.
int covered_by_label(const Canvas& canvas, const OccupancyMap& map, const std::vector<Path>& paths,
                     const Vec2& ahead_px, const Vec2& marker_px, const Vec2& offset_px) {
  int covered = offset_px.normalized().dot(ahead_px) > 0.7 ? 1 : 0;
  for (const double along_px : {-20.0, 0.0, 20.0}) {
    const Vec2 at_m = canvas.point_m(marker_px + offset_px + Vec2(along_px, 0.0));
    const Cell cell = map.cell_at(at_m);
    if (!map.contains(cell) || !is_drivable(map.at(cell))) ++covered;
    for (const Path& path : paths) {
      if (distance_to_path_m(path, at_m) * canvas.pixels_per_m() < 14.0) ++covered;
    }
  }
  return covered;
}

/// Labels each marker below its disc, or where the label covers less.
void draw_marker_ids(Canvas& canvas, const OccupancyMap& map, const MarkerRegistry& registry,
                     const std::vector<Path>& paths) {
  const std::array<Vec2, 4> offsets_px{Vec2(0.0, 24.0), Vec2(0.0, -24.0), Vec2(38.0, 0.0), Vec2(-38.0, 0.0)};
  for (const RegisteredMarker& marker : registry.markers) {
    const Eigen::Isometry3d pose = map_from_marker(registry, marker);
    const Vec2 at = canvas.pixel((pose * middle_of_marker).head<2>());
    const Vec2 ahead(pose.linear()(0, 0), -pose.linear()(1, 0));
    const Vec2 offset = *std::ranges::min_element(offsets_px, {}, [&](const Vec2& candidate_px) {
      return covered_by_label(canvas, map, paths, ahead, at, candidate_px);
    });
    canvas.draw_label_px(at + offset, fmt::format("{}", marker.id), 11.0, ink, 0.5);
  }
}

void draw_place(Canvas& canvas, const Vec2& at_m, const std::string& letter, const cv::Scalar& color) {
  canvas.draw_disc(at_m, 17.0, white);
  canvas.draw_disc(at_m, 15.0, color);
  canvas.draw_text(at_m, letter, 16.0, white);
}

/// Hollow circles at even distances along the true track, in one colour per goal (there, back).
void draw_track(Canvas& canvas, const RunRecord& record) {
  const std::vector<std::vector<TruePose>> parts = parts_of_track(record);
  for (std::size_t part = 0; part < parts.size(); ++part) {
    Vec2 last = Vec2::Constant(std::numeric_limits<double>::infinity());
    for (const TruePose& pose : parts[part]) {
      const Vec2& at = pose.map_from_base.position_m;
      if ((at - last).norm() < track_spacing_m) continue;
      canvas.draw_ring(at, track_radius_px, track_colors[part % track_colors.size()], 1.5);
      last = at;
    }
  }
}

void draw_scale_bar(Canvas& canvas, double right_px, double y_px) {
  const double length_px = canvas.pixels_per_m();
  const Vec2 from(right_px - length_px, y_px);
  const Vec2 to(right_px, y_px);
  canvas.draw_line_px(from, to, ink, 3.0);
  for (const Vec2& end : {from, to})
    canvas.draw_line_px(end - Vec2(0.0, 7.0), end + Vec2(0.0, 7.0), ink, 3.0);
  canvas.draw_text_px(0.5 * (from + to) + Vec2(0.0, 24.0), "1 m", text_px, ink, 0.5);
}

/// Adds a sample and its text for each kind of line or mark, left to right.
class Legend {
 public:
  Legend(Canvas& canvas, const Vec2& at) : canvas_(canvas), at_(at) {}

  void line(const cv::Scalar& color, double width_px, const std::string& words) {
    canvas_.draw_line_px(at_, at_ + Vec2(44.0, 0.0), color, width_px);
    end(words, 56.0);
  }
  void rings(const cv::Scalar& color, const std::string& words) {
    for (const double x : {7.0, 22.0, 37.0})
      canvas_.draw_ring_px(at_ + Vec2(x, 0.0), track_radius_px, color, 1.5);
    end(words, 56.0);
  }
  void disc(const cv::Scalar& color, double radius_px, const std::string& words) {
    canvas_.draw_disc_px(at_ + Vec2(radius_px, 0.0), radius_px, color);
    end(words, 2.0 * radius_px + 12.0);
  }

 private:
  void end(const std::string& words, double sample_px) {
    canvas_.draw_text_px(at_ + Vec2(sample_px, 0.0), words, text_px, ink);
    constexpr double gap_px = 40.0;
    at_.x() += sample_px + Canvas::text_width_px(words, text_px) + gap_px;
  }

  Canvas& canvas_;
  Vec2 at_;
};

Legend legend_of(Canvas& canvas) {
  const Vec2 low = canvas.pixel(canvas.low_m());
  draw_scale_bar(canvas, canvas.pixel(canvas.high_m()).x(), low.y() + 96.0);
  return {canvas, {low.x(), low.y() + 104.0}};
}

}  // namespace

cv::Mat draw_experiment(const RunRecord& record, const OccupancyMap& map, const MarkerRegistry& registry,
                        const Places& places) {
  Canvas canvas = canvas_for(map, figure_width_px);
  canvas.draw_map(map);
  draw_places(canvas, places);
  draw_axes(canvas);
  draw_markers(canvas, registry);
  std::vector<Path> planned;
  for (const GoalRecord& goal : record.goals) planned.push_back(goal.planned);
  for (const Path& path : planned) canvas.draw_line(path.waypoints_m, planned_color, 3.0);
  draw_track(canvas, record);
  draw_marker_ids(canvas, map, registry, planned);
  draw_place(canvas, record.start.position_m, "S", start_color);
  for (const GoalRecord& goal : record.goals) {
    const bool back_at_start = (goal.goal.position_m - record.start.position_m).norm() < 0.2;
    if (!back_at_start) draw_place(canvas, goal.goal.position_m, "E", planned_color);
  }

  const std::string title =
      fmt::format("{}: planned and driven, {} camera, seed {}", record.site, record.camera, record.seed);
  canvas.draw_text_px({canvas.pixel(canvas.low_m()).x() + 0.5 * figure_width_px, 34.0}, title, text_px * 1.15,
                      ink, 0.5);
  Legend legend = legend_of(canvas);
  legend.disc(marker_color, marker_radius_px, "marker, ID");
  legend.line(planned_color, 3.0, "planned");
  legend.rings(track_colors[0], record.goals.size() > 1 ? "driven, there" : "driven");
  if (record.goals.size() > 1) legend.rings(track_colors[1], "driven, back");
  legend.disc(start_color, 10.0, "start");
  legend.disc(planned_color, 10.0, "end");
  return canvas.picture();
}

cv::Mat draw_plan(const OccupancyMap& map, const MarkerRegistry& registry, const Vec2& start_m,
                  const Vec2& goal_m, const Path& path, const Visibility* visibility) {
  Canvas canvas = canvas_for(map, figure_width_px);
  canvas.draw_map(map);
  if (visibility != nullptr) draw_visible_cells(canvas, *visibility);
  draw_axes(canvas);
  draw_markers(canvas, registry);
  canvas.draw_line(path.waypoints_m, planned_color, 3.0);
  for (const Vec2& waypoint : path.waypoints_m) canvas.draw_disc(waypoint, 5.0, planned_color);
  draw_marker_ids(canvas, map, registry, {path});
  draw_place(canvas, start_m, "S", start_color);
  draw_place(canvas, goal_m, "E", planned_color);
  Legend legend = legend_of(canvas);
  if (!registry.markers.empty()) legend.disc(marker_color, marker_radius_px, "marker, ID");
  legend.line(planned_color, 3.0, "planned");
  legend.disc(start_color, 10.0, "start");
  legend.disc(planned_color, 10.0, "end");
  if (visibility != nullptr) {
    legend.disc(visibility_color(0), 10.0, "sees none");
    legend.disc(visibility_color(1), 10.0, "one marker");
    legend.disc(visibility_color(2), 10.0, "two");
  }
  return canvas.picture();
}

}  // namespace lodestar

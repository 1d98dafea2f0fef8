#include "app/bench/localize.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <span>

#include "app/bench/cramer_rao.hpp"
#include "app/bench/truth.hpp"
#include "app/common/stopwatch.hpp"
#include "app/report/run_statistics.hpp"

namespace lodestar {
namespace {

enum ScenePurpose : std::uint64_t { markers_of_scene = 61, views_of_scene, ceiling_of_scene };

/// Accumulates squares for root mean squares.
class SpreadSum {
 public:
  void add(double lateral_m, double height_m, double yaw_rad) {
    ++count_;
    lateral_m2_ += lateral_m * lateral_m;
    height_m2_ += height_m * height_m;
    yaw_rad2_ += yaw_rad * yaw_rad;
  }
  [[nodiscard]] PoseSpread spread() const {
    const double n = std::max(count_, 1);
    return {count_, std::sqrt(lateral_m2_ / n), std::sqrt(height_m2_ / n), std::sqrt(yaw_rad2_ / n)};
  }

 private:
  int count_ = 0;
  double lateral_m2_ = 0.0;
  double height_m2_ = 0.0;
  double yaw_rad2_ = 0.0;
};

constexpr int runs_of_a_frame = 5;

/// The minimum of several runs, to exclude cold caches and interrupted runs.
double microseconds_of_threshold(const cv::Mat& gray, cv::Mat& binary) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < runs_of_a_frame; ++i) {
    least = std::min(least,
                     microseconds_of([&] { cv::threshold(gray, binary, 199.0, 255.0, cv::THRESH_BINARY); }));
  }
  return least;
}

/// The same for quick methods; the result is that of the first run.
MethodResult run_method(BenchMethod& method, const cv::Mat& gray, const MarkerRegistry& registry,
                        const CameraModel& camera, const Eigen::Matrix3d& tilt) {
  MethodResult result = method.run(gray, registry, camera, tilt);
  for (int i = 1; i < runs_of_a_frame && method.is_quick(); ++i)
    result.microseconds =
        std::min(result.microseconds, method.run(gray, registry, camera, tilt).microseconds);
  return result;
}

double lower_median(const std::vector<double>& values) {
  return percentile(values, 0.5).value_or(0.0);
}

std::vector<InformativeDot> informative(const std::vector<SeenDot>& seen) {
  std::vector<InformativeDot> dots;
  dots.reserve(seen.size());
  for (const SeenDot& dot : seen) dots.push_back({dot.center_in_map_m, dot.information_per_px2});
  return dots;
}

/// Errors and bounds of one kind of pose, frame by frame.
class Score {
 public:
  void add(const std::optional<Eigen::Isometry3d>& estimate, const Eigen::Isometry3d& truth,
           const std::optional<PoseBound>& bound) {
    if (!estimate || !bound) return;
    const Vec3 off = estimate->translation() - truth.translation();
    const double yaw = angles_of(estimate->linear() * truth.linear().transpose()).yaw_rad;
    errors_.add(off.head<2>().norm(), off.z(), yaw);
    bounds_.add(bound->lateral_m(), bound->height_m(), bound->yaw_rad());
  }
  [[nodiscard]] PoseSpread errors() const { return errors_.spread(); }
  [[nodiscard]] PoseSpread bounds() const { return bounds_.spread(); }

 private:
  SpreadSum errors_;
  SpreadSum bounds_;
};

struct SweepPlan {
  std::string name;
  std::string quantity;
  std::vector<double> values;
  void (*set)(BenchScene& scene, double value);
};

const std::vector<SweepPlan>& plans() {
  static const std::vector<SweepPlan> all{
      {"noise",
       "noise sigma (gray levels)",
       {1, 2, 4, 6, 8, 10, 12},
       [](BenchScene& scene, double value) { scene.noise_gray = value; }},
      {"blur",
       "blur sigma (px)",
       {0.3, 0.5, 0.8, 1.1, 1.4, 1.7, 2.0},
       [](BenchScene& scene, double value) { scene.blur_sigma_px = value; }},
      {"height",
       "ceiling above the camera (m)",
       {1.5, 2.0, 2.6, 3.0, 3.5, 4.0},
       [](BenchScene& scene, double value) { scene.height_m = value; }},
      {"tilt",
       "tilt (degrees)",
       {0, 5, 10, 15, 20},
       [](BenchScene& scene, double value) { scene.tilt_rad = radians(value); }},
      {"light",
       "share of the usual light",
       {0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0},
       [](BenchScene& scene, double value) { scene.light = value; }},
      {"occlusion",
       "share of the marker's side that is hidden",
       {0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5},
       [](BenchScene& scene, double value) { scene.covered = value; }},
  };
  return all;
}

const SweepPlan& plan_of(const std::string& name) {
  return *std::ranges::find(plans(), name, &SweepPlan::name);
}

}  // namespace

ScenePoint measure(const BenchScene& scene, const MethodChoice& choice, int trials, std::uint64_t seed) {
  const Random random(seed);
  const MarkerRegistry registry = bench_registry(scene, random.stream(markers_of_scene));
  const CameraModel camera = camera_of(scene);
  Random views = random.stream(views_of_scene);
  ImageFormer ours(registry, camera, light_of(scene), random.stream(ceiling_of_scene).bits());
  ImageFormer former = ours;
  const std::unique_ptr<BenchMethod> method = choice.make();
  method->install(registry, camera, former);

  ScenePoint point;
  Score upright;
  Score free;
  std::vector<double> method_us;
  std::vector<double> threshold_us;
  cv::Mat binary;
  for (int trial = 0; trial < trials; ++trial) {
    const BenchView view = some_view(scene, registry, views);
    former.cover(view.covers);
    const cv::Mat gray =
        former.expose(view.map_from_camera, view.map_from_camera, static_cast<std::uint64_t>(trial));
    threshold_us.push_back(microseconds_of_threshold(gray, binary));
    const MethodResult result = run_method(*method, gray, registry, camera, view.tilt);
    method_us.push_back(result.microseconds);

    const ReadingCount count =
        judged(result.markers, markers_in_view(*method, registry, view.map_from_camera, camera));
    point.markers += scene.markers;
    point.read += count.right;
    point.wrong += count.wrong;
    const std::vector<InformativeDot> dots = informative(ours.dots_in_view(view.map_from_camera));
    upright.add(result.upright, view.map_from_camera,
                cramer_rao_bound(view.map_from_camera, dots, camera, Tilt::known));
    free.add(result.free, view.map_from_camera,
             cramer_rao_bound(view.map_from_camera, dots, camera, Tilt::free));
  }
  point.median_us = lower_median(method_us);
  point.threshold_us = lower_median(threshold_us);
  point.upright = upright.errors();
  point.upright_bound = upright.bounds();
  point.free = free.errors();
  point.free_bound = free.bounds();
  return point;
}

const std::vector<std::string>& sweep_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> result;
    for (const SweepPlan& plan : plans()) result.push_back(plan.name);
    return result;
  }();
  return names;
}

std::size_t points_of(const std::string& name) {
  return plan_of(name).values.size();
}

Sweep run_sweep(const std::string& name, const std::vector<MethodChoice>& methods, int trials,
                std::uint64_t seed, const std::function<void()>& done) {
  const SweepPlan& plan = plan_of(name);
  Sweep sweep{plan.name, plan.quantity, plan.values, {}};
  for (const MethodChoice& method : methods) {
    std::vector<ScenePoint>& points = sweep.points.emplace_back();
    for (const double value : plan.values) {
      BenchScene scene;
      plan.set(scene, value);
      points.push_back(measure(scene, method, trials, seed));
      done();
    }
  }
  return sweep;
}

std::vector<TriedSettings> try_settings(const BenchScene& scene, const std::vector<MethodChoice>& choices,
                                        int trials, std::uint64_t seed) {
  std::vector<TriedSettings> tried;
  for (const MethodChoice& choice : choices) tried.push_back({choice, measure(scene, choice, trials, seed)});
  return tried;
}

const TriedSettings& best_of(const std::vector<TriedSettings>& tried) {
  return *std::ranges::min_element(tried, [](const TriedSettings& a, const TriedSettings& b) {
    if (a.point.read != b.point.read) return a.point.read > b.point.read;
    return a.point.upright.lateral_m < b.point.upright.lateral_m;
  });
}

}  // namespace lodestar

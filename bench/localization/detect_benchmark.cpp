#include <benchmark/benchmark.h>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "localization/ceiling/ceiling_motion.hpp"
#include "localization/detection/bright_areas.hpp"
#include "localization/detection/marker_detector.hpp"
#include "localization/pose/pose_fixer.hpp"
#include "maps/marker.hpp"
#include "maps/random.hpp"

// Detection in a 640 x 480 frame with three markers and noise, against cv::threshold on the same frame in the
// same run as the reference.
namespace {

using namespace lodestar;

constexpr double ceiling_m = 2.6;

/// As long as the paper's, with square pixels.
CameraModel square_pixel_camera() {
  return {.width_px = 640, .height_px = 480, .fx_px = 755.0, .fy_px = 755.0, .cx_px = 320.0, .cy_px = 240.0};
}

/// Brightness of a blurred disc at `distance` from its centre.
double edge(double distance_px, double radius_px) {
  constexpr double blur_sigma_px = 0.67;
  return 0.5 * std::erfc((distance_px - radius_px) / (std::sqrt(2.0) * blur_sigma_px));
}

void draw_marker(cv::Mat& frame, int id, const Vec2& o_px, double turn_rad) {
  const double pitch_px = square_pixel_camera().fx_px * marker_pitch_m / ceiling_m;
  const Eigen::Rotation2Dd turn(turn_rad);
  for (const GridCell cell : dots_of(id)) {
    const Vec2 center = o_px + turn * Vec2(cell.column * pitch_px, (cell.row - 3) * pitch_px);
    for (int v = 0; v < frame.rows; ++v) {
      for (int u = 0; u < frame.cols; ++u) {
        const double distance = (Vec2(u, v) - center).norm();
        if (distance < pitch_px)
          frame.at<float>(v, u) += static_cast<float>(211.0 * edge(distance, 0.25 * pitch_px));
      }
    }
  }
}

cv::Mat frame_of_three_markers() {
  Random random(1);
  cv::Mat frame(480, 640, CV_32FC1, cv::Scalar(35.0));
  draw_marker(frame, 1782, {300.0, 250.0}, 0.3);
  draw_marker(frame, 447, {120.0, 140.0}, 2.0);
  draw_marker(frame, 3003, {500.0, 350.0}, 4.0);
  cv::Mat gray(frame.size(), CV_8UC1);
  for (int v = 0; v < gray.rows; ++v) {
    for (int u = 0; u < gray.cols; ++u) {
      gray.at<std::uint8_t>(v, u) =
          cv::saturate_cast<std::uint8_t>(frame.at<float>(v, u) + 4.0 * random.normal());
    }
  }
  return gray;
}

void threshold_alone(benchmark::State& state) {
  cv::setNumThreads(1);
  const cv::Mat frame = frame_of_three_markers();
  cv::Mat binary;
  for ([[maybe_unused]] auto _ : state) {
    cv::threshold(frame, binary, 199.0, 255.0, cv::THRESH_BINARY);
    benchmark::DoNotOptimize(binary.data);
  }
}
BENCHMARK(threshold_alone)->Unit(benchmark::kMicrosecond);

void local_thresholds(benchmark::State& state) {
  const cv::Mat frame = frame_of_three_markers();
  LocalThresholds thresholds;
  for ([[maybe_unused]] auto _ : state) {
    thresholds.find(frame, {});
    benchmark::DoNotOptimize(thresholds.of_tile(0, 0));
  }
}
BENCHMARK(local_thresholds)->Unit(benchmark::kMicrosecond);

void dots_of_a_frame(benchmark::State& state) {
  const cv::Mat frame = frame_of_three_markers();
  DotFinder finder;
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(finder.find(frame).data());
}
BENCHMARK(dots_of_a_frame)->Unit(benchmark::kMicrosecond);

void markers_of_a_frame(benchmark::State& state) {
  const cv::Mat frame = frame_of_three_markers();
  MarkerDetector detector;
  for ([[maybe_unused]] auto _ : state) {
    const std::span<const DetectedMarker> markers = detector.detect(frame);
    if (markers.size() != 3) state.SkipWithError("a marker was not read");
    benchmark::DoNotOptimize(markers.data());
  }
}
BENCHMARK(markers_of_a_frame)->Unit(benchmark::kMicrosecond);

/// Registered where they were drawn, for a camera 2.6 m below them.
MarkerRegistry three_markers(const CameraModel& camera) {
  const auto registered = [&](int id, const Vec2& o_px, double turn_rad) {
    const Vec2 ray = *camera.normalized(o_px) * ceiling_m;
    return RegisteredMarker{id, {ray.x(), ray.y(), ceiling_m}, turn_rad};
  };
  return {{},
          {registered(1782, {300.0, 250.0}, 0.3), registered(447, {120.0, 140.0}, 2.0),
           registered(3003, {500.0, 350.0}, 4.0)}};
}

void pose_of_a_frame(benchmark::State& state) {
  const CameraModel camera = square_pixel_camera();
  const MarkerRegistry registry = three_markers(camera);
  const cv::Mat frame = frame_of_three_markers();
  MarkerDetector detector(expecting(registry));
  PoseFixer fixer(registry, camera);
  PoseFixOptions options;
  options.prior.tilt_sigma_rad = 0.0;
  for ([[maybe_unused]] auto _ : state) {
    const std::span<const DetectedMarker> markers = detector.detect(frame);
    const PoseFix* const fix = fixer.fix(Stamp{}, markers, options);
    if (fix == nullptr || fix->ids.size() != 3) state.SkipWithError("no pose from three markers");
    benchmark::DoNotOptimize(fix);
  }
}
BENCHMARK(pose_of_a_frame)->Unit(benchmark::kMicrosecond);

/// Stains of a few centimetres with image noise, as seen by the camera 10 cm further on.
void motion_by_the_ceiling(benchmark::State& state) {
  cv::setNumThreads(1);
  const CameraModel camera = square_pixel_camera();
  constexpr int way_px = 29;
  cv::Mat1f stains(camera.height_px, camera.width_px + way_px);
  cv::RNG random(1);
  random.fill(stains, cv::RNG::NORMAL, 0.0, 120.0);
  cv::GaussianBlur(stains, stains, {}, 8.0);
  const auto frame_at = [&](int left_px, double time_s) {
    cv::Mat1f noise(camera.height_px, camera.width_px);
    random.fill(noise, cv::RNG::NORMAL, 40.0, 2.0);
    Frame frame{Stamp(from_seconds(time_s)), {}};
    cv::Mat(noise + stains(cv::Rect(left_px, 0, noise.cols, noise.rows))).convertTo(frame.gray, CV_8U);
    return frame;
  };
  CeilingMotion ceiling(camera, Eigen::Isometry3d::Identity(), ceiling_m, 0.002);
  ceiling.set_frame(frame_at(0, 0.0));
  if (!ceiling.set_keyframe()) return state.SkipWithError("too plain a ceiling");
  const Frame frame = frame_at(way_px, 0.05);
  const Pose2 expected{{ceiling_m * way_px / camera.fx_px + 0.004, -0.003}, 0.005};
  for ([[maybe_unused]] auto _ : state) {
    ceiling.set_frame(frame);
    const std::optional<VisualOdometryIncrement> motion = ceiling.motion(expected);
    if (!motion) state.SkipWithError("the pictures do not agree");
    benchmark::DoNotOptimize(motion);
  }
}
BENCHMARK(motion_by_the_ceiling)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();

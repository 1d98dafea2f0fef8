#include "app/bench/paper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/bench/scene.hpp"
#include "app/common/stopwatch.hpp"
#include "drivers/simulation/image_former.hpp"
#include "localization/detection/marker_detector.hpp"
#include "localization/pose/paper_pose.hpp"
#include "maps/marker.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

constexpr double ceiling_m = 2.6;  ///< Z of Table 3
constexpr double inf = std::numeric_limits<double>::infinity();

/// One marker on the ceiling whose frame is the experiment's: X and Y of the map are X and -Y of the paper's
/// tables.
MarkerRegistry single_marker(int id) {
  return {.markers = {{.id = id, .position_m = {0.0, 0.0, ceiling_m}}}};
}

Eigen::Isometry3d camera_at(const Vec3& position, double yaw_rad, double roll_rad, double pitch_rad) {
  Eigen::Isometry3d map_from_camera = Eigen::Isometry3d::Identity();
  map_from_camera.linear() = rotation_from({0.0, 0.0, yaw_rad}) * rotation_from({roll_rad, pitch_rad, 0.0});
  map_from_camera.translation() = position;
  return map_from_camera;
}

SimulatedCameraOptions varied_light(Random& random) {
  SimulatedCameraOptions light;
  light.dot_gray = random.uniform(230.0, 250.0);
  light.background_gray = random.uniform(10.0, 90.0);
  light.read_noise_gray = random.uniform(1.0, 4.0);
  return light;
}

constexpr int frames_of_a_ceiling = 5;  // generating the ceiling's texture takes far longer than a frame

/// The IDs of Table 1's experiment.
std::vector<int> different_ids() {
  constexpr int count = 100;
  constexpr int step = 37;  // coprime to 4096: they are spread over all of them
  std::vector<int> ids;
  for (int i = 0; i < count; ++i) ids.push_back(i * step % marker_id_count);
  return ids;
}

/// The marker to be read, near the point that the camera looks at, and up to two others farther off.
MarkerRegistry some_markers(std::span<const int> ids, std::size_t which, Random& random) {
  MarkerRegistry registry = single_marker(ids[which]);
  const Vec3 center(1.5 * marker_pitch_m, -1.5 * marker_pitch_m, 0.0);
  registry.markers.front().yaw_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
  const auto others = random.below(3);
  for (std::uint64_t i = 0; i < others; ++i) {
    const double direction = random.uniform(-0.4, 0.4) + (i == 0 ? 0.0 : std::numbers::pi);
    const Vec3 offset(0.5 * std::cos(direction), 0.5 * std::sin(direction), 0.0);
    const std::size_t half =
        (ids.size() - 1) / 2;  // the first other's ID from one, the second's from the rest
    const std::size_t other = (which + 1 + i * half + random.below(half)) % ids.size();
    registry.markers.push_back({.id = ids[other], .position_m = Vec3(0.0, 0.0, ceiling_m) + center + offset});
  }
  return registry;
}

/// A camera 1.5 to 2.6 m below the ceiling, at any yaw and tilted by up to 6 degrees about each axis, that
/// looks at the marker.
Eigen::Isometry3d some_view(const MarkerRegistry& registry, Random& random) {
  constexpr double most_tilt = radians(6.0);
  const double distance = random.uniform(1.5, ceiling_m);
  Eigen::Isometry3d view =
      camera_at(Vec3::Zero(), random.uniform(-std::numbers::pi, std::numbers::pi),
                random.uniform(-most_tilt, most_tilt), random.uniform(-most_tilt, most_tilt));
  const Vec3 axis = view.linear().col(2);
  const Vec3 looked_at =
      registry.markers.front().position_m + Vec3(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 0.0);
  view.translation() = looked_at - axis * (distance / axis.z());
  return view;
}

/// What one frame of the stand gives.
struct Measured {
  Eigen::Isometry3d map_from_camera;
  double confidence = 0.0;
};

/// A camera on its stand: nearly upright, at a place and heading, below the one marker.
class Stand {
 public:
  explicit Stand(const BenchPaperOptions& options)
      : random_(Random(options.seed).stream(2)),
        tilt_sigma_rad_(options.tilt_sigma_rad),
        method_(options.method),
        former_(registry_, bench_camera(), SimulatedCameraOptions{}, random_.bits()) {
    PosePrior upright;
    upright.tilt_sigma_rad = options.tilt_sigma_rad;
    fix_options_.prior = options.prior.value_or(upright);
  }

  std::optional<Measured> measure(const Vec3& position, double yaw_rad) {
    const Eigen::Isometry3d view =
        camera_at(position, yaw_rad, tilt_sigma_rad_ * random_.normal(), tilt_sigma_rad_ * random_.normal());
    const cv::Mat gray = former_.expose(view, view, frame_++);
    return method_ == MeasuredBy::paper ? by_the_paper(gray) : by_us(gray);
  }

  /// In the frame of Tables 2 and 3, the marker's.
  [[nodiscard]] Eigen::Isometry3d map_from_table() const {
    return map_from_marker(registry_, registry_.markers.front());
  }

 private:
  std::optional<Measured> by_us(const cv::Mat& gray) {
    const auto fix = fix_pose(Stamp{}, detect_markers(gray), registry_, camera_, fix_options_);
    return fix ? std::optional(Measured{fix->map_from_camera, fix->confidence}) : std::nullopt;
  }

  std::optional<Measured> by_the_paper(const cv::Mat& gray) {
    const std::vector<DetectedMarker> markers = detect_markers(gray, paper_detection());
    const auto fix = fix_pose_as_in_paper(Stamp{}, markers, registry_, camera_);
    return fix ? std::optional(Measured{fix->map_from_camera, fix->confidence}) : std::nullopt;
  }

  MarkerRegistry registry_ = single_marker(1782);
  CameraModel camera_ = bench_camera();
  Random random_;
  double tilt_sigma_rad_;
  MeasuredBy method_;
  ImageFormer former_;
  PoseFixOptions fix_options_;
  std::uint64_t frame_ = 0;
};

std::vector<AngleTrial> turn(Stand& stand) {
  std::vector<AngleTrial> trials;
  for (int heading_deg = 0; heading_deg <= 360; heading_deg += 30) {
    AngleTrial trial{.real_deg = static_cast<double>(heading_deg)};
    const Vec3 below_the_marker(1.5 * marker_pitch_m, -1.5 * marker_pitch_m, 0.0);
    if (const auto fix = stand.measure(below_the_marker, radians(trial.real_deg))) {
      const double output_deg = degrees(angles_of(fix->map_from_camera.linear()).yaw_rad);
      trial.output_deg = trial.real_deg - degrees(wrap_angle(radians(trial.real_deg - output_deg)));
      trial.confidence = fix->confidence;
      trial.fixed = true;
    }
    trials.push_back(trial);
  }
  return trials;
}

std::vector<PositionTrial> move(Stand& stand) {
  std::vector<PositionTrial> trials;
  for (int y_cm = -50; y_cm <= 50; y_cm += 10) {
    PositionTrial trial{.real_m = {-0.5, 0.01 * y_cm, ceiling_m}};
    const Vec3 position = stand.map_from_table() * trial.real_m;
    if (const auto fix = stand.measure(position, 0.0)) {
      trial.output_m = stand.map_from_table().inverse() * fix->map_from_camera.translation();
      trial.confidence = fix->confidence;
      trial.fixed = true;
    }
    trials.push_back(trial);
  }
  return trials;
}

}  // namespace

IdentificationResult bench_identification(const BenchPaperOptions& options) {
  const std::vector<int> ids = different_ids();
  MarkerDetector detector(options.method == MeasuredBy::paper ? paper_detection()
                                                              : DetectorOptions{.registered_ids = ids});
  Random random = Random(options.seed).stream(1);
  IdentificationResult result;
  double elapsed_us = 0.0;
  for (std::size_t ceiling = 0; result.trials < options.identification_trials; ++ceiling) {
    const std::size_t which = ceiling % ids.size();
    const MarkerRegistry registry = some_markers(ids, which, random);
    ImageFormer former(registry, bench_camera(), varied_light(random), random.bits());
    const int last = std::min(result.trials + frames_of_a_ceiling, options.identification_trials);
    for (; result.trials < last; ++result.trials) {
      const Eigen::Isometry3d view = some_view(registry, random);
      const cv::Mat gray = former.expose(view, view, static_cast<std::uint64_t>(result.trials));
      const Stopwatch watch;
      const std::span<const DetectedMarker> markers = detector.detect(gray);
      elapsed_us += watch.microseconds();
      const auto hangs = [&](const DetectedMarker& marker) { return registry.find(marker.id) != nullptr; };
      result.correct += !markers.empty() && markers.front().id == ids[which] ? 1 : 0;
      result.wrong += std::ranges::all_of(markers, hangs) ? 0 : 1;
    }
  }
  result.mean_ms = 1e-3 * elapsed_us / options.identification_trials;
  return result;
}

double AngleTrial::deviation_deg() const {
  return fixed ? real_deg - output_deg : inf;
}

double PositionTrial::distance_m() const {
  return fixed ? (real_m - output_m).norm() : inf;
}

std::size_t PoseBenchResult::poses() const {
  return static_cast<std::size_t>(std::ranges::count(angles, true, &AngleTrial::fixed) +
                                  std::ranges::count(positions, true, &PositionTrial::fixed));
}

double PoseBenchResult::mean_angle_deviation_deg() const {
  double sum = 0.0;
  for (const AngleTrial& trial : angles) sum += std::abs(trial.deviation_deg());
  return sum / static_cast<double>(angles.size());
}

double PoseBenchResult::mean_position_deviation_m() const {
  double sum = 0.0;
  for (const PositionTrial& trial : positions) sum += trial.distance_m();
  return sum / static_cast<double>(positions.size());
}

PoseBenchResult bench_poses(const BenchPaperOptions& options) {
  Stand stand(options);
  PoseBenchResult result;
  result.angles = turn(stand);
  result.positions = move(stand);
  return result;
}

}  // namespace lodestar

#include "app/bench/consistency.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "app/bench/scene.hpp"
#include "app/common/parallel.hpp"
#include "localization/detection/marker_detector.hpp"
#include "localization/pose/pose_fixer.hpp"
#include "maps/chi_square.hpp"

namespace lodestar {
namespace {

constexpr int frames_at_once = 500;
constexpr int frames_to_learn = 1000;  ///< run-in: image noise and variance factor are estimated
constexpr std::uint64_t frames_for_consistency = 71;

enum class TiltKnown { exactly, about, not_at_all };
constexpr double tilt_sigma_rad = radians(0.3);

struct Conditions {
  std::string name;
  BenchScene scene;
  TiltKnown tilt = TiltKnown::exactly;
};

/// All on a ceiling without texture: the covariance models image noise only.
const std::vector<Conditions>& conditions() {
  static const std::vector<Conditions> all{
      {"above the camera, tilt known", {.texture_gray = 0.0}},
      {"0.7 m aside, tilt known", {.off_axis_m = 0.7, .texture_gray = 0.0}},
      {"1.5 m above, tilt known", {.height_m = 1.5, .texture_gray = 0.0}},
      {"4 m above, tilt known", {.height_m = 4.0, .texture_gray = 0.0}},
      {"tilted by 15 degrees, tilt known", {.tilt_rad = radians(15.0), .texture_gray = 0.0}},
      {"blurred by 1 px, noise of 8 gray, tilt known",
       {.noise_gray = 8.0, .blur_sigma_px = 1.0, .texture_gray = 0.0}},
      {"three markers, tilt known", {.texture_gray = 0.0, .markers = 3}},
      {"tilt known to 0.3 degrees", {.texture_gray = 0.0}, TiltKnown::about},
      {"three markers, tilt known to 0.3 degrees", {.texture_gray = 0.0, .markers = 3}, TiltKnown::about},
      {"three markers, tilt unknown", {.texture_gray = 0.0, .markers = 3}, TiltKnown::not_at_all},
  };
  return all;
}

/// Perturbed as by the prior: rotated by a random small angle about the map's horizontal axes.
Eigen::Matrix3d perturbed(const Eigen::Matrix3d& map_from_camera, Random& random) {
  const Vec3 turn(tilt_sigma_rad * random.normal(), tilt_sigma_rad * random.normal(), 0.0);
  return Eigen::AngleAxisd(turn.norm(), turn.normalized()) * map_from_camera;
}

PosePrior prior_for(TiltKnown known, const Eigen::Matrix3d& tilt) {
  PosePrior prior{.tilt = tilt};
  if (known == TiltKnown::exactly) prior.tilt_sigma_rad = 0.0;
  if (known == TiltKnown::about) prior.tilt_sigma_rad = tilt_sigma_rad;
  return prior;
}

double nees_of(const PoseFix& fix, const Eigen::Isometry3d& truth, TiltKnown known) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(fix.map_from_camera.linear() * truth.linear().transpose()));
  Eigen::Matrix<double, 6, 1> error;
  error << fix.map_from_camera.translation() - truth.translation(), turn.angle() * turn.axis();
  if (known != TiltKnown::exactly) return error.dot(fix.covariance.ldlt().solve(error));
  const std::array free_axes{0, 1, 2, 5};
  const Eigen::Vector4d free_error = error(free_axes);
  const Eigen::Matrix4d covariance = fix.covariance(free_axes, free_axes);
  return free_error.dot(covariance.ldlt().solve(free_error));
}

struct NeesSum {
  int poses = 0;
  double nees = 0.0;
};

NeesSum sum_of_frames(const Conditions& conditions, int frames, Random random) {
  const CameraModel camera = bench_camera();
  const MarkerRegistry registry = bench_registry(conditions.scene, random.stream(0));
  ImageFormer former(registry, camera, light_of(conditions.scene), random.bits());
  MarkerDetector detector(expecting(registry));
  PoseFixer fixer(registry, camera);
  NeesSum sum;
  for (int i = -frames_to_learn; i < frames; ++i) {
    BenchView view = some_view(conditions.scene, registry, random);
    if (conditions.tilt == TiltKnown::about)
      view.map_from_camera.linear() = perturbed(view.map_from_camera.linear(), random);
    const cv::Mat gray =
        former.expose(view.map_from_camera, view.map_from_camera, static_cast<std::uint64_t>(i));
    const std::span<const DetectedMarker> markers = detector.detect(gray);
    PoseFixOptions options;
    options.prior = prior_for(conditions.tilt, view.tilt);
    const PoseFix* const fix = fixer.fix(Stamp{}, markers, options);
    if (fix == nullptr || i < 0) continue;
    ++sum.poses;
    sum.nees += nees_of(*fix, view.map_from_camera, conditions.tilt);
  }
  return sum;
}

Consistency measure(const Conditions& conditions, int frames, const Random& random,
                    const std::function<void(int frames)>& done) {
  const int parts = (frames + frames_at_once - 1) / frames_at_once;
  std::vector<NeesSum> sums(static_cast<std::size_t>(parts));
  in_parallel(parts, [&](int i) {
    const int count = std::min(frames_at_once, frames - i * frames_at_once);
    sums[static_cast<std::size_t>(i)] =
        sum_of_frames(conditions, count, random.stream(static_cast<std::uint64_t>(i)));
    done(count);
  });
  Consistency result{.conditions = conditions.name,
                     .frames = frames,
                     .degrees_of_freedom = conditions.tilt == TiltKnown::exactly ? 4 : 6};
  for (const NeesSum& sum : sums) {
    result.poses += sum.poses;
    result.mean_nees += sum.nees;
  }
  result.mean_nees /= std::max(result.poses, 1);
  return result;
}

}  // namespace

double Consistency::half_band_per_degree() const {
  const double degrees = static_cast<double>(degrees_of_freedom) * std::max(poses, 1);
  return 0.5 * (chi_square_quantile(0.975, degrees) - chi_square_quantile(0.025, degrees)) / degrees;
}

std::size_t consistency_conditions() {
  return conditions().size();
}

std::vector<Consistency> measure_consistency(int frames, std::uint64_t seed,
                                             const std::function<void(int frames)>& done) {
  const Random random = Random(seed).stream(frames_for_consistency);
  std::vector<Consistency> results;
  for (const Conditions& one : conditions())
    results.push_back(measure(one, frames, random.stream(results.size()), done));
  return results;
}

}  // namespace lodestar

#include "app/bench/method.hpp"

#include "app/bench/square_tags.hpp"
#include "app/common/stopwatch.hpp"
#include "localization/detection/marker_detector.hpp"
#include "localization/pose/pose_fixer.hpp"

namespace lodestar {
namespace {

std::vector<ReadMarker> readings_of(std::span<const DetectedMarker> markers) {
  std::vector<ReadMarker> readings;
  readings.reserve(markers.size());
  for (const DetectedMarker& marker : markers)
    readings.push_back({marker.id, marker.center_px, marker.probability});
  return readings;
}

class Lodestar final : public BenchMethod {
 public:
  void install(const MarkerRegistry& registry, const CameraModel& camera, ImageFormer& /*former*/) override {
    detector_ = MarkerDetector(expecting(registry));
    fixer_.emplace(registry, camera);
  }

  [[nodiscard]] int id_at(const MarkerRegistry& registry, std::size_t i) const override {
    return registry.markers[i].id;
  }

  [[nodiscard]] bool is_quick() const override { return true; }
  std::vector<ReadMarker> read(const cv::Mat& gray) override { return readings_of(detector_.detect(gray)); }

  MethodResult run(const cv::Mat& gray, const MarkerRegistry& /*registry*/, const CameraModel& /*camera*/,
                   const Eigen::Matrix3d& tilt) override {
    PoseFixOptions upright;
    upright.prior.tilt = tilt;
    upright.prior.tilt_sigma_rad = 0.0;
    const Stopwatch watch;
    const std::span<const DetectedMarker> markers = detector_.detect(gray);
    const PoseFix* const fix = fixer_->fix(Stamp{}, markers, upright);
    MethodResult result{.microseconds = watch.microseconds()};
    if (fix != nullptr) result.upright = fix->map_from_camera;
    if (const PoseFix* const free = fixer_->fix(Stamp{}, markers, {})) result.free = free->map_from_camera;
    result.markers = readings_of(markers);
    return result;
  }

 private:
  MarkerDetector detector_;
  std::optional<PoseFixer> fixer_;
};

}  // namespace

MethodChoice lodestar_method() {
  return {"lodestar", "dots, all of them, tilt known", [] { return std::make_unique<Lodestar>(); }};
}

std::vector<MethodChoice> peer_methods([[maybe_unused]] const std::string& peer) {
#ifdef LODESTAR_WITH_APRILTAG
  if (peer == "apriltag") return apriltag_choices();
#endif
#ifdef LODESTAR_WITH_ARUCO
  if (peer == "aruco") return aruco_choices();
#endif
  return {};
}

}  // namespace lodestar

#include "app/commands/localize_methods.hpp"

#include <cmath>

#include "localization/pose/expected_view.hpp"
#include "localization/pose/marker_tracker.hpp"
#include "localization/pose/mount.hpp"
#include "localization/pose/paper_pose.hpp"
#include "localization/pose/pose_fixer.hpp"

namespace lodestar {
namespace {

LocalizeRow row_of(const SourceFrame& frame, const PoseFix& fix, const std::optional<Robot>& robot) {
  LocalizeRow row{.file = frame.name, .stamp = frame.stamp, .ids = fix.ids};
  Eigen::Matrix3d covariance = fix.covariance({0, 1, 5}, {0, 1, 5});
  row.pose = fix.map_from_camera;
  if (robot) {
    row.pose = fix.map_from_camera * robot->base_from_camera.inverse();
    covariance = compensate_mount(fix, robot->base_from_camera).covariance;
  }
  row.sigmas = {std::sqrt(covariance(0, 0)), std::sqrt(covariance(1, 1)),
                degrees(std::sqrt(covariance(2, 2)))};
  row.confidence = fix.confidence;
  row.dots = fix.dots;
  return row;
}

LocalizeRow row_of(const SourceFrame& frame, const PaperFix& fix, const std::optional<Robot>& robot) {
  LocalizeRow row{.file = frame.name, .stamp = frame.stamp, .ids = {fix.id}};
  row.pose = fix.map_from_camera;
  if (robot) row.pose = lifted(compensate_mount_as_in_paper(fix.map_from_camera, robot->base_from_camera));
  row.confidence = fix.confidence;
  row.dots = 3;
  return row;
}

std::optional<ExpectedView> view_expected(const SourceFrame& frame, const std::optional<PoseFix>& last) {
  return last ? std::optional(expected_view(*last, frame.stamp - last->stamp)) : std::nullopt;
}

class DefaultLocalizer final : public FrameLocalizer {
 public:
  DefaultLocalizer(const MarkerRegistry& registry, const CameraModel& camera,
                   const std::optional<Robot>& robot, const PoseFixOptions& options, bool track)
      : tracker_(registry, camera, {}),
        fixer_(registry, camera),
        robot_(robot),
        options_(options),
        track_(track) {}

  LocatedFrame locate(const SourceFrame& frame) override {
    LocatedFrame located{.markers = tracker_.detect(frame.gray, view_expected(frame, last_)), .row = {}};
    const PoseFix* const fix = fixer_.fix(frame.stamp, located.markers, options_);
    if (fix == nullptr) return located;
    if (track_) last_ = *fix;
    located.row = row_of(frame, *fix, robot_);
    return located;
  }

  [[nodiscard]] std::string why_not_used() const override { return "contradicts the others"; }

 private:
  MarkerTracker tracker_;
  PoseFixer fixer_;
  std::optional<Robot> robot_;
  PoseFixOptions options_;
  bool track_;
  std::optional<PoseFix> last_;
};

class PaperLocalizer final : public FrameLocalizer {
 public:
  PaperLocalizer(const MarkerRegistry& registry, const CameraModel& camera, const std::optional<Robot>& robot)
      : detector_(paper_detection()), registry_(registry), camera_(camera), robot_(robot) {}

  LocatedFrame locate(const SourceFrame& frame) override {
    LocatedFrame located{.markers = detector_.detect(frame.gray), .row = {}};
    const auto fix = fix_pose_as_in_paper(frame.stamp, located.markers, registry_, camera_);
    if (fix) located.row = row_of(frame, *fix, robot_);
    return located;
  }

  [[nodiscard]] std::string why_not_used() const override { return "not the nearest to the centre"; }

 private:
  MarkerDetector detector_;
  MarkerRegistry registry_;
  CameraModel camera_;
  std::optional<Robot> robot_;
};

}  // namespace

std::unique_ptr<FrameLocalizer> default_localizer(const MarkerRegistry& registry, const CameraModel& camera,
                                                  const std::optional<Robot>& robot,
                                                  const PoseFixOptions& options, bool track) {
  return std::make_unique<DefaultLocalizer>(registry, camera, robot, options, track);
}

std::unique_ptr<FrameLocalizer> paper_localizer(const MarkerRegistry& registry, const CameraModel& camera,
                                                const std::optional<Robot>& robot) {
  return std::make_unique<PaperLocalizer>(registry, camera, robot);
}

}  // namespace lodestar

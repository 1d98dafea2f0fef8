#include "app/bench/square_tags.hpp"

#include <algorithm>

#include "app/bench/scene.hpp"
#include "app/common/stopwatch.hpp"
#include "localization/pose/pose_guess.hpp"

namespace lodestar {
namespace {

// Exposure is set for the paper: white well below saturation, black ink limited by the lens' stray light. The
// contrast is four fifths of that of our dots.
constexpr double paper_gray = 200.0;
constexpr double ink_gray = 30.0;

Eigen::Isometry3d map_from_tag(const MarkerRegistry& registry, std::size_t i) {
  return map_from_marker(registry, registry.markers[i]) * Eigen::Translation3d(marker_middle);
}

Vec2 center_of(const TagSighting& tag) {
  Vec2 sum = Vec2::Zero();
  for (const Vec2& corner : tag.corners_px) sum += 0.25 * corner;
  return sum;
}

std::vector<ReadMarker> readings_of(const std::vector<TagSighting>& tags) {
  std::vector<ReadMarker> readings;
  readings.reserve(tags.size());
  for (const TagSighting& tag : tags) readings.push_back({tag.id, center_of(tag), std::nullopt});
  return readings;
}

/// Least-squares pose from all corners, starting at a guess.
std::optional<Eigen::Isometry3d> fitted(const std::optional<Eigen::Isometry3d>& guess,
                                        const std::vector<SurveyedDot>& corners, const CameraModel& camera,
                                        PoseFixOptions options) {
  if (!guess) return std::nullopt;
  options.dot_sigma_px = 0.1;
  options.robust_scale = 1e9;  // plain squares
  const std::optional<MapEstimate> estimate = maximize_posterior(*guess, corners, camera, options);
  return estimate ? std::optional(estimate->map_from_camera) : std::nullopt;
}

}  // namespace

std::array<Vec3, 4> tag_corners() {
  constexpr double h = 0.5 * tag_side_m;
  return {Vec3(-h, h, 0.0), Vec3(h, h, 0.0), Vec3(h, -h, 0.0), Vec3(-h, -h, 0.0)};
}

void SquareTags::install(const MarkerRegistry& registry, const CameraModel& /*camera*/, ImageFormer& former) {
  former.take_markers_down();
  for (std::size_t i = 0; i < registry.markers.size(); ++i) {
    const TagPattern tag = pattern(id_at(registry, i));
    PrintedSquare paper{.map_from_square = map_from_tag(registry, i), .modules = tag.modules};
    paper.side_m = tag_side_m * tag.modules / (tag.modules - 2);
    for (const bool white : tag.white) paper.gray.push_back(white ? paper_gray : ink_gray);
    former.add(paper);
  }
}

std::vector<ReadMarker> SquareTags::read(const cv::Mat& gray) {
  return readings_of(find(gray));
}

MethodResult SquareTags::run(const cv::Mat& gray, const MarkerRegistry& registry, const CameraModel& camera,
                             const Eigen::Matrix3d& tilt) {
  const Stopwatch watch;
  std::vector<TagSighting> tags = find(gray);
  const auto known = std::ranges::partition(tags, [&](const TagSighting& tag) {
    return tag.id >= 0 && static_cast<std::size_t>(tag.id) < registry.markers.size();
  });
  const std::size_t known_tags = tags.size() - known.size();
  std::optional<Eigen::Isometry3d> own;
  if (known_tags > 0) {
    if (const auto camera_from_tag = own_pose(tags.front(), camera))
      own = map_from_tag(registry, static_cast<std::size_t>(tags.front().id)) * camera_from_tag->inverse();
  }
  MethodResult result{.free = own, .microseconds = watch.microseconds()};
  result.markers = readings_of(tags);
  if (known_tags == 0) return result;
  std::vector<SurveyedDot> corners;
  for (const TagSighting& tag : std::span(tags).first(known_tags)) {
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3 place = map_from_tag(registry, static_cast<std::size_t>(tag.id)) * tag_corners()[k];
      corners.push_back({place, tag.corners_px[k]});
    }
  }
  // Several tags in view: the library's pose from one tag initializes the fit of all.
  if (known_tags > 1) result.free = fitted(own, corners, camera, {});
  PoseFixOptions upright;
  upright.prior.tilt = tilt;
  upright.prior.tilt_sigma_rad = 0.0;
  result.upright = fitted(level_guess(corners, camera, upright.prior), corners, camera, upright);
  return result;
}

}  // namespace lodestar

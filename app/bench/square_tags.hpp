#pragma once

#include <array>

#include "app/bench/method.hpp"

// Common base of the peers: square black-and-white tags, detected by their corners.
namespace lodestar {

/// A tag that was read. Corners as printed: top left, top right, bottom right, bottom left; pixel centres
/// have integer coordinates.
struct TagSighting {
  int id = 0;
  std::array<Vec2, 4> corners_px{Vec2(0.0, 0.0), Vec2(0.0, 0.0), Vec2(0.0, 0.0), Vec2(0.0, 0.0)};
  std::size_t index = 0;  ///< among all tags found
};

/// A tag's modules row by row from the top: true is white. Includes its black frame and one white module
/// around it.
struct TagPattern {
  int modules = 0;  ///< along a side
  std::vector<bool> white;
};

/// Side of a tag's black square: as large as our marker from edge to edge of its dots.
inline constexpr double tag_side_m = 0.14;

/// The four corners of the black square in the tag's frame (origin in the middle, x to the right and y
/// upwards on the printed face, z out of it), in the order of TagSighting.
std::array<Vec3, 4> tag_corners();

class SquareTags : public BenchMethod {
 public:
  void install(const MarkerRegistry& registry, const CameraModel& camera, ImageFormer& former) override;
  [[nodiscard]] int id_at(const MarkerRegistry& /*registry*/, std::size_t i) const override {
    return static_cast<int>(i);
  }
  std::vector<ReadMarker> read(const cv::Mat& gray) final;
  MethodResult run(const cv::Mat& gray, const MarkerRegistry& registry, const CameraModel& camera,
                   const Eigen::Matrix3d& tilt) override;

 protected:
  [[nodiscard]] virtual TagPattern pattern(int id) const = 0;
  virtual std::vector<TagSighting> find(const cv::Mat& gray) = 0;

  /// camera_from_tag by the library's own estimate, of a tag of the last find().
  [[nodiscard]] virtual std::optional<Eigen::Isometry3d> own_pose(const TagSighting& tag,
                                                                  const CameraModel& camera) const = 0;
};

std::vector<MethodChoice> apriltag_choices();
std::vector<MethodChoice> aruco_choices();

}  // namespace lodestar

#pragma once

#include <memory>
#include <octomap/OcTree.h>
#include <optional>
#include <unordered_map>
#include <vector>

#include "localization/scan/own_outline.hpp"
#include "maps/depth_image.hpp"
#include "maps/scan_rays.hpp"

namespace lodestar {

struct HeightSlabOptions {
  double low_m = 0.08;  ///< above the floor, its unevenness and the camera's noise
  double high_m = 1.2;  ///< the robot's height: what hangs higher does not touch it
  double voxel_m = 0.05;
  double kept_m = 5.0;  ///< around the robot; what is farther away is forgotten
  /// The image is read in blocks of so many columns and rows, the nearest point of each: thin things are not
  /// lost between samples.
  int block_columns = 64;
  int block_rows = 48;
  // Of the OctoMap: one image puts a thing there, two rays through a voxel take it away.
  double hit = 0.85;
  double miss = 0.3;
  double surest = 0.8;
  /// What has not been hit for so long is not there any more, although nothing was seen behind it: in a hall
  /// that is deeper than the camera sees no ray would take it away.
  Duration longest_unseen = std::chrono::seconds(30);
};

/// What a depth camera sees of things as high as the robot, as rays like a scanner's: an OctoMap in the
/// odometry frame (Hornung et al. 2013), of which the voxels between floor and the robot's height count.
/// Tables and forks above the scan plane are seen so. What is too near or too high for the image now, but was
/// seen before, is still there.
class HeightSlab {
 public:
  HeightSlab(const DepthMount& mount, const OwnOutline& own, const HeightSlabOptions& options = {});

  /// Adds an image, and gives the rays over the camera's view in the odometry frame: to the nearest thing in
  /// the slab, else to the end of the range; none in directions in which the image knows nothing.
  DeskewedScan add(const DepthImage& image, const Pose2& odom_from_base);

 private:
  struct View;
  [[nodiscard]] octomap::Pointcloud points_of(const DepthImage& image,
                                              const Eigen::Isometry3d& odom_from_camera,
                                              const Pose2& base_from_odom, View& view) const;
  [[nodiscard]] Vec3 within_slab(const Vec3& point_m, const Vec3& from_m) const;
  void forget_far(const Vec2& middle_m);
  void look_at_slab(Stamp now, View& view) const;

  DepthMount mount_;
  OwnOutline own_;
  HeightSlabOptions options_;
  std::unique_ptr<octomap::OcTree> tree_;
  std::optional<Vec2> tidied_at_m_;
  std::unordered_map<octomap::OcTreeKey, Stamp, octomap::OcTreeKey::KeyHash> last_hits_;  ///< of voxels
};

}  // namespace lodestar

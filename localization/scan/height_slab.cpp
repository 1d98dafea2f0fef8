#include "localization/scan/height_slab.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace lodestar {
namespace {

constexpr double bin_rad = radians(1.0);

/// The nearest depth of a block; nothing where the image knows none.
std::optional<double> nearest_depth_m(const cv::Mat& block, Eigen::Vector2i& at) {
  std::uint16_t least = std::numeric_limits<std::uint16_t>::max();
  for (int y = 0; y < block.rows; ++y) {
    const auto* row = block.ptr<std::uint16_t>(y);
    for (int x = 0; x < block.cols; ++x) {
      if (row[x] == 0 || row[x] >= least) continue;
      least = row[x];
      at = {x, y};
    }
  }
  if (least == std::numeric_limits<std::uint16_t>::max()) return std::nullopt;
  return least / mm_per_m;
}

octomap::point3d octo(const Vec3& point) {
  return {static_cast<float>(point.x()), static_cast<float>(point.y()), static_cast<float>(point.z())};
}

std::unique_ptr<octomap::OcTree> empty_tree(const HeightSlabOptions& options) {
  auto tree = std::make_unique<octomap::OcTree>(options.voxel_m);
  tree->setProbHit(options.hit);
  tree->setProbMiss(options.miss);
  tree->setClampingThresMax(options.surest);
  tree->setClampingThresMin(1.0 - options.surest);
  return tree;
}

}  // namespace

/// The horizontal directions that the camera looks in, each a bin.
struct HeightSlab::View {
  struct Bin {
    bool is_seen = false;  ///< the image knows a depth there
    double nearest_m = std::numeric_limits<double>::infinity();
  };

  View(const DepthMount& mount, const Eigen::Isometry3d& odom_from_camera)
      : from_m(odom_from_camera.translation().head<2>()) {
    const Vec3 ahead = odom_from_camera.linear().col(2);
    ahead_rad = std::atan2(ahead.y(), ahead.x());
    // Of an image that looks down the edge reaches farther aside below; there it is near, and not needed.
    const double half_rad = std::atan(0.5 * mount.camera.width_px / mount.camera.fx_px);
    bins.resize(static_cast<std::size_t>(2.0 * half_rad / bin_rad) + 1);
  }

  [[nodiscard]] double middle_of(std::size_t bin) const {
    return ahead_rad + bin_rad * (static_cast<double>(bin) - 0.5 * static_cast<double>(bins.size() - 1));
  }
  /// Where a point lies among the bins, as a fraction; some are beside all of them.
  [[nodiscard]] double place_of(const Vec2& point_m) const {
    const Vec2 way = point_m - from_m;
    return wrap_angle(std::atan2(way.y(), way.x()) - ahead_rad) / bin_rad +
           0.5 * static_cast<double>(bins.size() - 1);
  }
  /// Around all that it looks at.
  [[nodiscard]] std::pair<Vec2, Vec2> box(double range_m) const {
    Vec2 low = from_m;
    Vec2 high = from_m;
    for (std::size_t i = 0; i < bins.size(); ++i) {
      const Vec2 end_m = from_m + range_m * Vec2(std::cos(middle_of(i)), std::sin(middle_of(i)));
      low = low.cwiseMin(end_m);
      high = high.cwiseMax(end_m);
    }
    return {low, high};
  }
  template <typename Change>
  void at(double first, double last, const Change& change) {
    const auto most = static_cast<double>(bins.size()) - 1.0;
    if (last < -0.5 || first > most + 0.5) return;
    const auto low = static_cast<std::size_t>(std::clamp(std::round(first), 0.0, most));
    const auto high = static_cast<std::size_t>(std::clamp(std::round(last), 0.0, most));
    for (std::size_t i = low; i <= high; ++i) change(bins[i]);
  }

  Vec2 from_m;
  double ahead_rad = 0.0;
  std::vector<Bin> bins;
};

HeightSlab::HeightSlab(const DepthMount& mount, const OwnOutline& own, const HeightSlabOptions& options)
    : mount_(mount), own_(own), options_(options), tree_(empty_tree(options)) {}

DeskewedScan HeightSlab::add(const DepthImage& image, const Pose2& odom_from_base) {
  const Eigen::Isometry3d odom_from_camera = lifted(odom_from_base) * mount_.base_from_camera;
  View view(mount_, odom_from_camera);
  const octomap::Pointcloud points = points_of(image, odom_from_camera, inverse(odom_from_base), view);
  constexpr bool lazily = true;
  constexpr bool once_a_voxel = true;
  tree_->insertPointCloud(points, octo(odom_from_camera.translation()), mount_.range_m, lazily, once_a_voxel);
  for (const octomap::point3d& point : points)
    if (octomap::OcTreeKey key; tree_->coordToKeyChecked(point, key)) last_hits_[key] = image.stamp;
  forget_far(odom_from_base.position_m);
  look_at_slab(image.stamp, view);

  DeskewedScan scan{.newest = image.stamp, .rays = {}};
  for (std::size_t i = 0; i < view.bins.size(); ++i) {
    const View::Bin& bin = view.bins[i];
    const bool is_hit = bin.nearest_m < mount_.range_m;
    if (!is_hit && !bin.is_seen) continue;
    const double angle_rad = view.middle_of(i);
    const double range_m = std::min(bin.nearest_m, mount_.range_m);
    scan.rays.push_back({.stamp = image.stamp,
                         .origin_m = view.from_m,
                         .end_m = view.from_m + range_m * Vec2(std::cos(angle_rad), std::sin(angle_rad)),
                         .echo = is_hit ? Echo::hit : Echo::nothing});
  }
  return scan;
}

/// Of each block the nearest point, in the odometry frame; without the robot's own parts.
octomap::Pointcloud HeightSlab::points_of(const DepthImage& image, const Eigen::Isometry3d& odom_from_camera,
                                          const Pose2& base_from_odom, View& view) const {
  octomap::Pointcloud points;
  const cv::Mat& depth = image.depth_mm;
  const CameraModel& camera = mount_.camera;
  const int block_px = std::max(1, depth.cols / options_.block_columns);
  const int block_py = std::max(1, depth.rows / options_.block_rows);
  // Each image by other rays than the one before: a robot that stands would see between the same voxels for
  // ever.
  const auto shift =
      static_cast<unsigned>(image.stamp.time_since_epoch() / std::chrono::milliseconds(1)) * 2654435761U;
  const int first_x = -static_cast<int>((shift >> 16U) % static_cast<unsigned>(block_px));
  const int first_y = -static_cast<int>((shift >> 24U) % static_cast<unsigned>(block_py));
  for (int y = first_y; y < depth.rows; y += block_py) {
    for (int x = first_x; x < depth.cols; x += block_px) {
      const cv::Range ys(std::max(y, 0), std::min(y + block_py, depth.rows));
      const cv::Range xs(std::max(x, 0), std::min(x + block_px, depth.cols));
      Eigen::Vector2i at = Eigen::Vector2i::Zero();
      const std::optional<double> depth_m = nearest_depth_m(depth(ys, xs), at);
      if (!depth_m) continue;
      const Vec3 ray((xs.start + at.x() - camera.cx_px) / camera.fx_px,
                     (ys.start + at.y() - camera.cy_px) / camera.fy_px, 1.0);
      const Vec3 point_m = odom_from_camera * (*depth_m * ray);
      if (point_m.z() < options_.high_m && own_.holds(base_from_odom * point_m.head<2>().eval())) continue;
      points.push_back(octo(within_slab(point_m, odom_from_camera.translation())));
      const double place = view.place_of(point_m.head<2>());
      view.at(place - 1.0, place + 1.0, [](View::Bin& bin) { bin.is_seen = true; });
    }
  }
  return points;
}

/// What is below or above the slab ends just outside of it: the rest of the ray changes nothing that counts.
Vec3 HeightSlab::within_slab(const Vec3& point_m, const Vec3& from_m) const {
  const double ends_m =
      std::clamp(point_m.z(), options_.low_m - options_.voxel_m, options_.high_m + options_.voxel_m);
  const double share = (ends_m - from_m.z()) / (point_m.z() - from_m.z());
  return share > 0.0 && share < 1.0 ? from_m + share * (point_m - from_m) : point_m;
}

/// Now and then: the tree grows with the way.
void HeightSlab::forget_far(const Vec2& middle_m) {
  constexpr double between_m = 1.0;
  if (tidied_at_m_ && (middle_m - *tidied_at_m_).norm() < between_m) return;
  tidied_at_m_ = middle_m;
  constexpr bool lazily = true;
  std::unique_ptr<octomap::OcTree> near = empty_tree(options_);
  for (auto leaf = tree_->begin_leafs(); leaf != tree_->end_leafs(); ++leaf)
    if ((Vec2(leaf.getX(), leaf.getY()) - middle_m).lpNorm<Eigen::Infinity>() <= options_.kept_m)
      near->setNodeValue(leaf.getKey(), leaf->getLogOdds(), lazily);
  tree_ = std::move(near);  // OctoMap 1.9 asserts where the last child of a node is deleted
  std::erase_if(last_hits_, [this](const auto& hit) { return tree_->search(hit.first) == nullptr; });
}

/// What a voxel holds may be at its near side.
void HeightSlab::look_at_slab(Stamp now, View& view) const {
  const double half_m = 0.5 * options_.voxel_m;
  const double aside_m = std::numbers::sqrt2 * half_m;
  const auto [low, high] = view.box(mount_.range_m);
  const auto begin = tree_->begin_leafs_bbx(octo({low.x(), low.y(), options_.low_m + half_m}),
                                            octo({high.x(), high.y(), options_.high_m - half_m}));
  for (auto leaf = begin; leaf != tree_->end_leafs_bbx(); ++leaf) {
    if (!tree_->isNodeOccupied(*leaf)) continue;
    const auto hit = last_hits_.find(leaf.getKey());
    if (hit == last_hits_.end() || now - hit->second > options_.longest_unseen) continue;
    const Vec2 middle_m(leaf.getX(), leaf.getY());
    const double range_m = (middle_m - view.from_m).norm();
    if (range_m > mount_.range_m) continue;
    const double place = view.place_of(middle_m);
    const double half_bins = std::atan2(aside_m, range_m) / bin_rad;
    view.at(place - half_bins, place + half_bins, [&](View::Bin& bin) {
      bin.nearest_m = std::min(bin.nearest_m, std::max(range_m - aside_m, 0.0));
    });
  }
}

}  // namespace lodestar

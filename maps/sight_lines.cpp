#include "maps/sight_lines.hpp"

#include "maps/octree_file.hpp"

namespace lodestar {
namespace {

octomap::point3d octomap_point(const Vec3& point) {
  return {static_cast<float>(point.x()), static_cast<float>(point.y()), static_cast<float>(point.z())};
}

}  // namespace

SightLines::SightLines(const std::filesystem::path& octomap_file) : tree_(read_octree(octomap_file)) {}
SightLines::~SightLines() = default;
SightLines::SightLines(SightLines&&) noexcept = default;
SightLines& SightLines::operator=(SightLines&&) noexcept = default;

bool SightLines::is_clear(const Vec3& from_m, const Vec3& to_m) const {
  octomap::KeyRay voxels;
  if (!tree_->computeRayKeys(octomap_point(from_m), octomap_point(to_m), voxels)) return false;
  const double touch_m = 1.8 * tree_->getResolution();  // a voxel's diagonal, and its surface's roughness
  for (const octomap::OcTreeKey& voxel : voxels) {
    const octomap::OcTreeNode* node = tree_->search(voxel);
    if (node == nullptr || !tree_->isNodeOccupied(*node)) continue;
    const octomap::point3d center = tree_->keyToCoord(voxel);
    const Vec3 at(center.x(), center.y(), center.z());
    if ((at - from_m).norm() > touch_m && (at - to_m).norm() > touch_m) return false;
  }
  return true;
}

}  // namespace lodestar

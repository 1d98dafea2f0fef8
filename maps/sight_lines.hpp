#pragma once

#include <filesystem>
#include <memory>

#include "maps/geometry.hpp"

namespace octomap {
class OcTree;
}

namespace lodestar {

/// Line-of-sight checks between two points of the map frame, in an OctoMap.
class SightLines {
 public:
  /// Throws InputError.
  explicit SightLines(const std::filesystem::path& octomap_file);
  ~SightLines();
  SightLines(SightLines&&) noexcept;
  SightLines& operator=(SightLines&&) noexcept;

  /// True when no voxel between the points is known to be occupied. Voxels that touch either end, as the
  /// ceiling touches a marker, do not count; unknown space does not block.
  [[nodiscard]] bool is_clear(const Vec3& from_m, const Vec3& to_m) const;

 private:
  std::unique_ptr<octomap::OcTree> tree_;
};

}  // namespace lodestar

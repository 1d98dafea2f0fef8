#pragma once

#include <filesystem>
#include <memory>

#include "maps/geometry.hpp"

namespace octomap {
class OcTree;
}

namespace lodestar {

/// What stands between two points of the map frame, by an OctoMap.
class SightLines {
 public:
  /// Throws InputError.
  explicit SightLines(const std::filesystem::path& octomap_file);
  ~SightLines();
  SightLines(SightLines&&) noexcept;
  SightLines& operator=(SightLines&&) noexcept;

  /// Is no voxel between the points known to be occupied? What touches either of them, as the ceiling does a
  /// marker, is not in between; what is unknown hides nothing.
  [[nodiscard]] bool is_clear(const Vec3& from_m, const Vec3& to_m) const;

 private:
  std::unique_ptr<octomap::OcTree> tree_;
};

}  // namespace lodestar

#pragma once

#include <set>
#include <string>
#include <vector>

#include "app/drive/finding.hpp"
#include "app/drive/seen_stamps.hpp"
#include "app/site/site.hpp"

namespace lodestar {

/// What a camera has delivered while the doctor looked.
struct SeenImages : SeenStamps {
  std::string no_camera;    ///< why it could not be opened
  std::string description;  ///< what its driver claims
  std::set<int> markers;
};

/// Whether there are images, how many a second, what the driver claims, and whether a known marker is in
/// view.
std::vector<Finding> look_at_images(const Site& site, const SeenImages& seen);

}  // namespace lodestar

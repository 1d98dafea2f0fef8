#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/drive/finding.hpp"
#include "app/site/site.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// What a camera has delivered while the doctor looked.
struct SeenImages {
  void take(Stamp stamp, Stamp arrival);
  /// By the stamps; nothing before the second image.
  [[nodiscard]] std::optional<double> rate_hz() const;

  std::string no_camera;    ///< why it could not be opened
  std::string description;  ///< what its driver claims
  int count = 0;
  std::optional<Stamp> first;  ///< stamps of the exposures
  Stamp last;
  Duration ages{};  ///< at arrival, in sum
  std::set<int> markers;
};

/// Whether there are images, how many a second, what the driver claims, and whether a known marker is in
/// view.
std::vector<Finding> look_at_images(const Site& site, const SeenImages& seen);

}  // namespace lodestar

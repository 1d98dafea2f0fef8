#pragma once

#include <string>
#include <vector>

#include "app/drive/finding.hpp"
#include "app/drive/seen_stamps.hpp"
#include "app/site/site.hpp"
#include "maps/depth_image.hpp"
#include "maps/scan.hpp"

namespace lodestar {

/// What scanner and depth camera have delivered while the doctor looked.
struct SeenRanges {
  void take(const Scan& scan, Stamp arrival);
  void take(const DepthImage& image);

  std::string no_scanner;  ///< why it could not be opened
  std::string description;
  SeenStamps scans;         ///< of their newest beams
  std::size_t beams = 0;    ///< of the last scan
  std::size_t invalid = 0;  ///< of them
  ScanPackets packets;

  std::string no_depth_camera;
  std::string depth_description;
  int depth_images = 0;
  double known_share = 0.0;  ///< of the pixels of the last
};

/// Of a robot that has them: whether scans and depth images come, how many a second, how old, and how much of
/// them is known.
std::vector<Finding> look_at_ranges(const Robot& robot, const SeenRanges& seen);

}  // namespace lodestar

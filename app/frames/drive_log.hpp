#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "maps/camera_model.hpp"
#include "maps/motion.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

struct LoggedImage {
  Stamp stamp;  ///< the middle of the exposure
  std::filesystem::path file;
};

/// A drive as a folder: images named by their stamp in seconds (12.350.png) and wheels.csv with the header
/// `stamp_s,left_m,right_m`, the travel of each wheel since power-up. Both on the same clock, both in time
/// order.
struct DriveLog {
  std::vector<LoggedImage> images;
  std::vector<WheelTravel> wheels;
};

/// Throws InputError with file and line: no images, an image whose name is not a number of seconds, an
/// unknown header, a row that is not three finite numbers or whose stamp does not increase.
DriveLog load_drive_log(const std::filesystem::path& folder);

/// Only its wheels.csv; throws as load_drive_log().
std::vector<WheelTravel> load_wheels(const std::filesystem::path& file);

/// The image as 8-bit gray. Throws InputError when it cannot be decoded, or is not of the camera's size.
cv::Mat read_logged_image(const std::filesystem::path& file, const CameraModel& camera);

}  // namespace lodestar

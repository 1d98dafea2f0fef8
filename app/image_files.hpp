#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "maps/camera_model.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

struct ImageFile {
  std::string file;  ///< as it is to be named in results
  Stamp stamp;   ///< the file name when that is a number of seconds, else its place in the list, in seconds
  cv::Mat gray;  ///< CV_8UC1
};

/// Images named on the command line, one at a time, so that any number of them fits in memory.
class ImageFiles {
 public:
  /// Each argument is an image or a folder of images (taken in the order of their names). Throws InputError
  /// for a path that does not exist, a folder without images, or no argument at all.
  explicit ImageFiles(const std::vector<std::string>& arguments);

  /// The next image, as 8-bit gray; nothing after the last. Throws InputError when it cannot be read, or when
  /// its size is not the camera's.
  std::optional<ImageFile> next(const std::optional<CameraModel>& camera);

 private:
  std::vector<std::filesystem::path> files_;
  std::size_t next_ = 0;
};

}  // namespace lodestar

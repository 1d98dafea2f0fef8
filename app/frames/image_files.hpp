#pragma once

#include <filesystem>
#include <vector>

#include "app/frames/frame_source.hpp"

namespace lodestar {

/// Is the file an image, by its ending or by its first bytes? Only such files are read as images.
bool is_image(const std::filesystem::path& file);

/// Puts files in the order in which they were taken: by time when each name is a number of seconds, else by
/// name with numbers in it compared as numbers (frame2 before frame10).
void sort_as_taken(std::vector<std::filesystem::path>& files);

/// The images of a folder, in the order taken. Throws InputError for a folder that cannot be read or holds no
/// image.
std::vector<std::filesystem::path> images_in(const std::filesystem::path& folder);

/// The image as 8-bit gray. Colour becomes luma, an alpha channel is dropped, 16 bits are scaled to 8 (65535
/// to 255). Throws InputError for a file that is empty, truncated or not an image, and for floating-point
/// pixels.
cv::Mat read_gray(const std::filesystem::path& file);

/// Image files in the order given. Stamp: the file name when that is a number of seconds, else the file's
/// place in the list, in seconds.
class ImageFiles final : public FrameSource {
 public:
  explicit ImageFiles(std::vector<std::filesystem::path> files, std::size_t first_place = 0)
      : files_(std::move(files)), first_place_(first_place) {}

  std::optional<SourceFrame> next() override;

 private:
  std::vector<std::filesystem::path> files_;
  std::size_t first_place_;
  std::size_t next_ = 0;
};

}  // namespace lodestar

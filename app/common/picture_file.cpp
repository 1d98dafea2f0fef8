#include "app/common/picture_file.hpp"

#include "maps/atomic_file.hpp"
#include "maps/picture.hpp"

namespace lodestar {

void write_png(const std::filesystem::path& file, const cv::Mat& picture) {
  write_file_atomically(file, png_bytes(picture));
}

}  // namespace lodestar

#include <memory>
#include <opencv2/core.hpp>
#include <sstream>
#include <string>
#include <tiffio.h>
#include <tiffio.hxx>
#include <vector>

#include "maps/picture_formats.hpp"

namespace lodestar {
namespace {

/// What libtiff would print; said once for the process.
void keep_libtiff_silent() {
  static const bool done = [] {
    TIFFSetErrorHandler(nullptr);
    TIFFSetWarningHandler(nullptr);
    return true;
  }();
  static_cast<void>(done);
}

/// libtiff packs a pixel into 32 bits with red the lowest.
cv::Mat blue_first(const std::vector<std::uint32_t>& pixels, int width_px, int height_px) {
  cv::Mat picture(height_px, width_px, CV_8UC3);
  std::size_t at = 0;
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      const std::uint32_t pixel = pixels[at++];
      picture.at<cv::Vec3b>(y, x) = {static_cast<std::uint8_t>(TIFFGetB(pixel)),
                                     static_cast<std::uint8_t>(TIFFGetG(pixel)),
                                     static_cast<std::uint8_t>(TIFFGetR(pixel))};
    }
  }
  return picture;
}

}  // namespace

cv::Mat decode_tiff(PictureBytes bytes) {
  keep_libtiff_silent();
  std::istringstream stream(std::string(bytes.begin(), bytes.end()));
  const std::unique_ptr<TIFF, decltype(&TIFFClose)> file(TIFFStreamOpen("picture", &stream), TIFFClose);
  if (!file) throw PictureError("no image that can be decoded");
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  std::uint16_t sample_format = SAMPLEFORMAT_UINT;
  TIFFGetField(file.get(), TIFFTAG_IMAGEWIDTH, &width_px);
  TIFFGetField(file.get(), TIFFTAG_IMAGELENGTH, &height_px);
  TIFFGetFieldDefaulted(file.get(), TIFFTAG_SAMPLEFORMAT, &sample_format);
  if (sample_format == SAMPLEFORMAT_IEEEFP) throw PictureError("floating-point pixels");
  expect_picture_size(width_px, height_px);
  std::vector<std::uint32_t> pixels(std::size_t{width_px} * height_px);
  if (TIFFReadRGBAImageOriented(file.get(), width_px, height_px, pixels.data(), ORIENTATION_TOPLEFT, 1) == 0)
    throw PictureError("no image that can be decoded");
  return blue_first(pixels, static_cast<int>(width_px), static_cast<int>(height_px));
}

}  // namespace lodestar

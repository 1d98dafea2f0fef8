#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>

#include "maps/picture.hpp"

// One reader for each format, for maps/picture.cpp. Each throws PictureError.
namespace lodestar {

using PictureBytes = std::span<const std::uint8_t>;

cv::Mat decode_png(PictureBytes bytes);
cv::Mat decode_jpeg(PictureBytes bytes, bool gray);
cv::Mat decode_tiff(PictureBytes bytes);
cv::Mat decode_webp(PictureBytes bytes);
cv::Mat decode_bmp(PictureBytes bytes);
cv::Mat decode_pnm(PictureBytes bytes);  ///< P2, P5 and P6

/// Throws PictureError for more pixels than a picture may have.
void expect_picture_size(std::int64_t width_px, std::int64_t height_px);

}  // namespace lodestar

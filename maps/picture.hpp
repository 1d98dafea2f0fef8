#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace lodestar {

/// Why bytes are no picture: what was found, as for the "found" of a message.
struct PictureError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A side, and all pixels: a small file may promise a large picture.
inline constexpr int max_picture_side_px = 32768;
inline constexpr std::size_t max_picture_px = std::size_t{1} << 28U;

/// A PNG, JPEG, TIFF, WebP, BMP, PGM or PPM picture as it is stored, its rows from the top: 1 channel, 3
/// (blue, green, red) or 4 (with alpha); 16 bits a channel for a PNG that has so many, else 8. A JPEG is
/// turned as its EXIF orientation says. Throws PictureError.
cv::Mat decode_picture(std::span<const std::uint8_t> bytes);

/// The same as 8-bit gray: colour becomes luma, alpha is dropped, 16 bits are scaled (65535 to 255).
cv::Mat decode_gray(std::span<const std::uint8_t> bytes);

/// The same of a file. Throws PictureError also for one that is empty or cannot be read.
cv::Mat gray_picture_in(const std::filesystem::path& file);

/// All bytes of a file. Throws PictureError when it is empty or cannot be read.
std::vector<std::uint8_t> picture_bytes_in(const std::filesystem::path& file);

/// Do these first bytes of a file begin a picture of one of those formats?
bool begins_picture(std::span<const std::uint8_t> bytes);

/// Of 8-bit pictures with 1, 3 or 4 channels, as above.
std::string png_bytes(const cv::Mat& picture);

/// Of 8-bit pictures with 1 or 3 channels, with quality 75 of 100.
std::string jpeg_bytes(const cv::Mat& picture);

}  // namespace lodestar

#include <bit>
#include <csetjmp>
#include <cstring>
#include <new>
#include <opencv2/core.hpp>
#include <png.h>
#include <vector>
#include <zlib.h>

#include "maps/picture_formats.hpp"

// libpng leaves a function by longjmp at an error. So each function that calls setjmp has nothing to destroy:
// what owns memory stands in its callers.
namespace lodestar {
namespace {

// NOLINTBEGIN(cert-err52-cpp)

[[noreturn]] void leave(png_structp png, png_const_charp /*why*/) {
  png_longjmp(png, 1);
}

void say_nothing(png_structp /*png*/, png_const_charp /*what*/) {}

struct PngReader {
  png_structp png = nullptr;
  png_infop info = nullptr;
  PictureBytes left;

  explicit PngReader(PictureBytes bytes) : left(bytes) {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, leave, say_nothing);
    if (png != nullptr) info = png_create_info_struct(png);
    if (info == nullptr) {
      png_destroy_read_struct(&png, &info, nullptr);
      throw std::bad_alloc();
    }
  }
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
};

void take_bytes(png_structp png, png_bytep to, std::size_t count) {
  PictureBytes& left = static_cast<PngReader*>(png_get_io_ptr(png))->left;
  if (left.size() < count) png_error(png, "cut short");
  std::memcpy(to, left.data(), count);
  left = left.subspan(count);
}

/// Palettes and fewer than 8 bits are expanded, gray with alpha becomes colour with alpha.
void ask_for_whole_channels(png_structp png, png_infop info) {
  png_set_expand(png);
  if (png_get_color_type(png, info) == PNG_COLOR_TYPE_GRAY_ALPHA ||
      (png_get_color_type(png, info) == PNG_COLOR_TYPE_GRAY && png_get_valid(png, info, PNG_INFO_tRNS) != 0))
    png_set_gray_to_rgb(png);
  if constexpr (std::endian::native == std::endian::little) png_set_swap(png);
  png_set_bgr(png);
  png_set_interlace_handling(png);
}

bool read_header(PngReader& reader) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_set_user_limits(reader.png, max_picture_side_px, max_picture_side_px);
  png_set_read_fn(reader.png, &reader, take_bytes);
  png_read_info(reader.png, reader.info);
  ask_for_whole_channels(reader.png, reader.info);
  png_read_update_info(reader.png, reader.info);
  return true;
}

bool read_rows(PngReader& reader, png_bytepp rows) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_read_image(reader.png, rows);
  png_read_end(reader.png, nullptr);
  return true;
}

struct PngWriter {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::string bytes;

  PngWriter() {
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, leave, say_nothing);
    if (png != nullptr) info = png_create_info_struct(png);
    if (info == nullptr) {
      png_destroy_write_struct(&png, &info);
      throw std::bad_alloc();
    }
  }
  ~PngWriter() { png_destroy_write_struct(&png, &info); }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;
};

void put_bytes(png_structp png, png_bytep from, std::size_t count) {
  static_cast<PngWriter*>(png_get_io_ptr(png))->bytes.append(reinterpret_cast<const char*>(from), count);
}

/// The quickest of zlib's levels and one filter: a third larger than the smallest, ten times as fast.
bool write_rows(PngWriter& writer, const cv::Mat& picture, png_bytepp rows) {
  if (setjmp(png_jmpbuf(writer.png)) != 0) return false;
  const int type = picture.channels() == 1   ? PNG_COLOR_TYPE_GRAY
                   : picture.channels() == 3 ? PNG_COLOR_TYPE_RGB
                                             : PNG_COLOR_TYPE_RGB_ALPHA;
  constexpr int bits = 8;
  png_set_write_fn(writer.png, &writer, put_bytes, nullptr);
  png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(picture.cols),
               static_cast<png_uint_32>(picture.rows), bits, type, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_filter(writer.png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_compression_level(writer.png, Z_BEST_SPEED);
  png_write_info(writer.png, writer.info);
  png_set_bgr(writer.png);
  png_write_image(writer.png, rows);
  png_write_end(writer.png, nullptr);
  return true;
}

// NOLINTEND(cert-err52-cpp)

std::vector<png_bytep> rows_of(const cv::Mat& picture) {
  std::vector<png_bytep> rows;
  for (int y = 0; y < picture.rows; ++y) rows.push_back(const_cast<png_bytep>(picture.ptr(y)));
  return rows;
}

}  // namespace

cv::Mat decode_png(PictureBytes bytes) {
  PngReader reader(bytes);
  if (!read_header(reader)) throw PictureError("no image that can be decoded");
  const auto width_px = static_cast<int>(png_get_image_width(reader.png, reader.info));
  const auto height_px = static_cast<int>(png_get_image_height(reader.png, reader.info));
  expect_picture_size(width_px, height_px);
  const int depth = png_get_bit_depth(reader.png, reader.info) == 16 ? CV_16U : CV_8U;
  cv::Mat picture(height_px, width_px, CV_MAKETYPE(depth, png_get_channels(reader.png, reader.info)));
  std::vector<png_bytep> rows = rows_of(picture);
  if (!read_rows(reader, rows.data())) throw PictureError("no image that can be decoded");
  return picture;
}

std::string png_bytes(const cv::Mat& picture) {
  PngWriter writer;
  std::vector<png_bytep> rows = rows_of(picture);
  if (!write_rows(writer, picture, rows.data()))
    throw std::runtime_error("a picture that libpng cannot write");
  return std::move(writer.bytes);
}

}  // namespace lodestar

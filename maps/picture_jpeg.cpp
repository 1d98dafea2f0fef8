#include <array>
#include <libexif/exif-data.h>
#include <memory>
#include <new>
#include <opencv2/core.hpp>
#include <optional>
#include <turbojpeg.h>

#include "maps/picture_formats.hpp"

namespace lodestar {
namespace {

struct Destroy {
  void operator()(void* codec) const { tjDestroy(codec); }
};
using Codec = std::unique_ptr<void, Destroy>;

Codec made(tjhandle handle) {
  if (handle == nullptr) throw std::bad_alloc();
  return Codec(handle);
}

/// 1 to 8 as EXIF numbers them; 1, upright, where nothing is said.
int orientation_of(PictureBytes bytes) {
  constexpr int upright = 1;
  const std::unique_ptr<ExifData, decltype(&exif_data_unref)> exif(
      exif_data_new_from_data(bytes.data(), static_cast<unsigned>(bytes.size())), exif_data_unref);
  if (!exif) return upright;
  const ExifEntry* entry = exif_content_get_entry(exif->ifd[EXIF_IFD_0], EXIF_TAG_ORIENTATION);
  if (entry == nullptr || entry->format != EXIF_FORMAT_SHORT || entry->size < sizeof(ExifShort))
    return upright;
  return exif_get_short(entry->data, exif_data_get_byte_order(exif.get()));
}

/// As it is looked at: 2 to 8 are the seven other ways to lay a picture down.
cv::Mat upright(const cv::Mat& picture, int orientation) {
  struct Step {
    bool transposes;
    std::optional<int> flips;  ///< cv::flip's code: 0 top to bottom, 1 left to right, -1 both
  };
  constexpr int horizontally = 1;
  constexpr std::array<Step, 9> steps{{{},
                                       {},
                                       {false, horizontally},
                                       {false, -1},
                                       {false, 0},
                                       {true, std::nullopt},
                                       {true, horizontally},
                                       {true, -1},
                                       {true, 0}}};
  if (orientation < 0 || orientation >= static_cast<int>(steps.size())) return picture;
  const Step& step = steps.at(static_cast<std::size_t>(orientation));
  cv::Mat turned = picture;
  if (step.transposes) cv::transpose(picture, turned);
  if (step.flips) cv::flip(turned, turned, *step.flips);
  return turned;
}

}  // namespace

cv::Mat decode_jpeg(PictureBytes bytes, bool gray) {
  const Codec codec = made(tjInitDecompress());
  int width_px = 0;
  int height_px = 0;
  int subsampling = 0;
  int colours = 0;
  const auto size = static_cast<unsigned long>(bytes.size());
  if (tjDecompressHeader3(codec.get(), bytes.data(), size, &width_px, &height_px, &subsampling, &colours) !=
      0)
    throw PictureError("no image that can be decoded");
  expect_picture_size(width_px, height_px);
  const bool one_channel = gray || colours == TJCS_GRAY;
  cv::Mat picture(height_px, width_px, one_channel ? CV_8UC1 : CV_8UC3);
  const int failed =
      tjDecompress2(codec.get(), bytes.data(), size, picture.data, width_px, static_cast<int>(picture.step),
                    height_px, one_channel ? TJPF_GRAY : TJPF_BGR, TJFLAG_ACCURATEDCT);
  // A warning is of bytes that are wrong or missing in a picture that can still be looked at.
  if (failed != 0 && tjGetErrorCode(codec.get()) != TJERR_WARNING)
    throw PictureError("no image that can be decoded");
  return upright(picture, orientation_of(bytes));
}

std::string jpeg_bytes(const cv::Mat& picture) {
  constexpr int quality = 75;
  const Codec codec = made(tjInitCompress());
  const bool gray = picture.channels() == 1;
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const int failed =
      tjCompress2(codec.get(), picture.data, picture.cols, static_cast<int>(picture.step), picture.rows,
                  gray ? TJPF_GRAY : TJPF_BGR, &bytes, &size, gray ? TJSAMP_GRAY : TJSAMP_420, quality, 0);
  const std::unique_ptr<unsigned char, decltype(&tjFree)> owned(bytes, tjFree);
  if (failed != 0) throw std::runtime_error("a picture that libjpeg-turbo cannot write");
  return {reinterpret_cast<const char*>(bytes), size};
}

}  // namespace lodestar

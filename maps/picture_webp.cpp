#include <opencv2/core.hpp>
#include <webp/decode.h>

#include "maps/picture_formats.hpp"

namespace lodestar {

cv::Mat decode_webp(PictureBytes bytes) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(bytes.data(), bytes.size(), &features) != VP8_STATUS_OK)
    throw PictureError("no image that can be decoded");
  expect_picture_size(features.width, features.height);
  cv::Mat picture(features.height, features.width, features.has_alpha != 0 ? CV_8UC4 : CV_8UC3);
  const std::size_t room = picture.step * static_cast<std::size_t>(picture.rows);
  const auto decode = features.has_alpha != 0 ? WebPDecodeBGRAInto : WebPDecodeBGRInto;
  if (decode(bytes.data(), bytes.size(), picture.data, room, static_cast<int>(picture.step)) == nullptr)
    throw PictureError("no image that can be decoded");
  return picture;
}

}  // namespace lodestar

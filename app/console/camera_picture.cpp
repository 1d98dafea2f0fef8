#include "app/console/camera_picture.hpp"

#include <cstdint>
#include <nlohmann/json.hpp>

#include "app/common/json_text.hpp"
#include "app/common/rounding.hpp"
#include "maps/picture.hpp"

namespace lodestar {
namespace {

using nlohmann::ordered_json;

ordered_json point_json(const Vec2& px) {
  return {rounded(px.x(), 10.0), rounded(px.y(), 10.0)};
}

ordered_json marker_json(const DetectedMarker& marker) {
  ordered_json dots = ordered_json::array();
  for (const MarkerDot& dot : marker.dots) dots.push_back(point_json(dot.center_px));
  return {{"id", marker.id},
          {"confidence", marker.confidence},
          {"o_px", point_json(marker.o_px)},
          {"x_px", point_json(marker.x_px)},
          {"y_px", point_json(marker.y_px)},
          {"dots_px", dots}};
}

}  // namespace

std::optional<std::string> CameraPicture::message(const Frame& frame) {
  if (frame.gray.empty() || frame.gray.type() != CV_8UC1) return std::nullopt;
  ordered_json head{{"time_s", seconds(frame.stamp)},
                    {"width_px", frame.gray.cols},
                    {"height_px", frame.gray.rows},
                    {"markers", ordered_json::array()}};
  for (const DetectedMarker& marker : detector_.detect(frame.gray))
    head["markers"].push_back(marker_json(marker));
  const std::string jpeg = jpeg_bytes(frame.gray);
  if (jpeg.empty()) return std::nullopt;

  const std::string text = json_text(head);
  std::string message;
  for (unsigned shift = 0; shift < 32; shift += 8) {
    message += static_cast<char>((static_cast<std::uint32_t>(text.size()) >> shift) & 0xFFU);
  }
  return message + text + jpeg;
}

}  // namespace lodestar

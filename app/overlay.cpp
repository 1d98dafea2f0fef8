#include "app/overlay.hpp"

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

constexpr int scale =
    2;  ///< the picture is enlarged, so that a person can tell where in a dot its centre lies
constexpr int fraction_bits = 4;

const cv::Scalar x_color(60, 60, 255);
const cv::Scalar y_color(80, 220, 80);
const cv::Scalar dot_color(255, 180, 0);
const cv::Scalar text_color(0, 215, 255);

/// Where a point of the frame lies in the enlarged picture, in OpenCV's fixed-point drawing coordinates.
cv::Point enlarged(const Vec2& pixel) {
  const Vec2 point = ((pixel.array() + 0.5) * scale - 0.5) * (1 << fraction_bits);
  return {static_cast<int>(std::lround(point.x())), static_cast<int>(std::lround(point.y()))};
}

void draw_marker(cv::Mat& picture, const DetectedMarker& marker) {
  cv::line(picture, enlarged(marker.o_px), enlarged(marker.x_px), x_color, 1, cv::LINE_AA, fraction_bits);
  cv::line(picture, enlarged(marker.o_px), enlarged(marker.y_px), y_color, 1, cv::LINE_AA, fraction_bits);
  for (const MarkerDot& dot : marker.dots) {
    cv::circle(picture, enlarged(dot.center_px), 5 << fraction_bits, dot_color, 1, cv::LINE_AA,
               fraction_bits);
  }
  const cv::Point at = enlarged(marker.o_px) / (1 << fraction_bits) + cv::Point(10, 24);
  cv::putText(picture, fmt::format("{} ({:.2f})", marker.id, marker.confidence), at, cv::FONT_HERSHEY_SIMPLEX,
              0.6, text_color, 1, cv::LINE_AA);
}

}  // namespace

cv::Mat draw_markers(const cv::Mat& gray, const std::vector<DetectedMarker>& markers) {
  cv::Mat picture;
  cv::resize(gray, picture, {}, scale, scale, cv::INTER_NEAREST);
  cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
  for (const DetectedMarker& marker : markers) draw_marker(picture, marker);
  return picture;
}

void write_overlay(const std::filesystem::path& folder, const std::string& image_file,
                   const cv::Mat& picture) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const std::filesystem::path file = folder / (std::filesystem::path(image_file).stem().string() + ".png");
  bool written = false;
  try {
    written = !error && cv::imwrite(file.string(), picture);
  } catch (const cv::Exception&) {
    written = false;
  }
  if (!written)
    throw InputError(file, 0, "a picture that could not be written", "a folder that can be written");
}

}  // namespace lodestar

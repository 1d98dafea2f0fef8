#include "app/frames/overlay.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <opencv2/imgproc.hpp>

#include "maps/input_error.hpp"
#include "maps/picture.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

/// Approximate width, enough for a person to see where in a dot its centre lies.
constexpr int picture_width_px = 1280;
constexpr int fraction_bits = 4;  ///< of OpenCV's fixed-point drawing coordinates
constexpr int font = cv::FONT_HERSHEY_SIMPLEX;
constexpr double label_size = 0.8;
constexpr double words_size = 0.85;

const cv::Scalar x_color(70, 70, 255);
const cv::Scalar y_color(80, 230, 80);
const cv::Scalar dot_color(255, 190, 30);
const cv::Scalar label_color(0, 225, 255);
const cv::Scalar objection_color(60, 130, 255);
const cv::Scalar words_color(240, 240, 240);
const cv::Scalar accepted_color(90, 200, 90);
const cv::Scalar refused_color(70, 70, 240);
const cv::Scalar panel_color(40, 34, 30);

/// From frame coordinates to fixed-point coordinates of the enlarged picture.
class Enlarged {
 public:
  explicit Enlarged(int scale) : scale_(scale) {}

  [[nodiscard]] cv::Point operator()(const Vec2& pixel) const {
    const Vec2 point = ((pixel.array() + 0.5) * scale_ - 0.5) * (1 << fraction_bits);
    return {static_cast<int>(std::lround(point.x())), static_cast<int>(std::lround(point.y()))};
  }
  [[nodiscard]] int length(double px) const {
    return static_cast<int>(std::lround(px * scale_ * (1 << fraction_bits)));
  }

 private:
  int scale_;
};

void write_text(cv::Mat& picture, const std::string& text, const cv::Point& at, double size,
                const cv::Scalar& color) {
  cv::putText(picture, text, at, font, size, cv::Scalar::all(0), 5,
              cv::LINE_AA);  // outline, legible on any gray
  cv::putText(picture, text, at, font, size, color, 2, cv::LINE_AA);
}

/// Half a pitch in the image, as far as a circle about a dot may reach without touching its neighbour's.
double half_pitch_px(const DetectedMarker& marker) {
  const double side_px = std::min((marker.x_px - marker.o_px).norm(), (marker.y_px - marker.o_px).norm());
  return 0.5 * side_px / (marker_grid_size - 1);
}

void draw_dots(cv::Mat& picture, const DetectedMarker& marker, const Enlarged& enlarged) {
  const int radius = enlarged.length(std::max(0.8 * half_pitch_px(marker), 2.0));
  const int arm = std::max(radius / 5, 2 << fraction_bits);
  for (const MarkerDot& dot : marker.dots) {
    const cv::Point center = enlarged(dot.center_px);
    cv::circle(picture, center, radius, dot_color, 2, cv::LINE_AA, fraction_bits);
    for (const cv::Point& along : {cv::Point(arm, 0), cv::Point(0, arm)})
      cv::line(picture, center - along, center + along, dot_color, 1, cv::LINE_AA, fraction_bits);
  }
}

/// Tip of the arrow from O through a direction dot, 0.8 pitches beyond it, and the position of the axis name.
struct ArrowEnd {
  Vec2 tip_px;
  Vec2 name_px;
};

ArrowEnd arrow_end(const Vec2& from, const Vec2& to) {
  const Vec2 tip = to + (to - from) * (0.8 / (marker_grid_size - 1));
  return {tip, tip + (to - from).normalized() * 6.0};
}

void draw_axis(cv::Mat& picture, const Vec2& from, const Vec2& to, const char* name, const cv::Scalar& color,
               const Enlarged& enlarged) {
  const ArrowEnd end = arrow_end(from, to);
  cv::arrowedLine(picture, enlarged(from), enlarged(end.tip_px), color, 2, cv::LINE_AA, fraction_bits, 0.08);
  write_text(picture, name, enlarged(end.name_px) / (1 << fraction_bits) + cv::Point(-7, 7), 0.6, color);
}

/// Bounding box of the marker with the circles about its dots and the names of its axes.
cv::Rect surroundings_of(const DetectedMarker& marker, const Enlarged& enlarged) {
  std::vector<cv::Point> points;
  for (const MarkerDot& dot : marker.dots) points.push_back(enlarged(dot.center_px) / (1 << fraction_bits));
  for (const Vec2& to : {marker.x_px, marker.y_px})
    points.push_back(enlarged(arrow_end(marker.o_px, to).name_px) / (1 << fraction_bits));
  const cv::Rect box = cv::boundingRect(points);
  const int margin = std::max(enlarged.length(half_pitch_px(marker)) / (1 << fraction_bits), 10) + 8;
  return {box.x - margin, box.y - margin, box.width + 2 * margin, box.height + 2 * margin};
}

/// Below the marker, or above it where the picture ends or something else is shown there; never beyond the
/// picture's sides. `taken` gains the label's place.
void draw_label(cv::Mat& picture, const OverlayMarker& shown, const Enlarged& enlarged,
                std::vector<cv::Rect>& taken) {
  const DetectedMarker& marker = shown.marker;
  std::string label = fmt::format("ID {}  confidence {:.2f}", marker.id, marker.confidence);
  if (!shown.objection.empty()) label += "  " + shown.objection;
  const cv::Rect around = surroundings_of(marker, enlarged);
  const cv::Size size = cv::getTextSize(label, font, label_size, 2, nullptr) + cv::Size(0, 8);
  const int left =
      std::clamp(around.x + (around.width - size.width) / 2, 6, std::max(picture.cols - size.width - 6, 6));
  const int lowest = picture.rows - size.height;
  cv::Rect place({left, std::clamp(around.br().y, 0, lowest)}, size);
  for (const int top : {around.br().y, around.y - size.height}) {
    const cv::Rect candidate({left, top}, size);
    const bool is_free =
        std::ranges::none_of(taken, [&](const cv::Rect& other) { return (candidate & other).area() > 0; });
    if (top < 0 || top > lowest || !is_free) continue;
    place = candidate;
    break;
  }
  taken.push_back(place);
  write_text(picture, label, {place.x, place.br().y - 8}, label_size,
             shown.objection.empty() ? label_color : objection_color);
}

/// The largest size, up to the usual one, at which all lines fit the width.
double size_that_fits(const std::vector<std::string>& lines, int width_px) {
  double size = words_size;
  for (const std::string& line : lines) {
    const int needed = cv::getTextSize(line, font, words_size, 2, nullptr).width;
    if (needed > width_px) size = std::min(size, words_size * width_px / needed);
  }
  return size;
}

cv::Mat panel_of(const Overlay& overlay, int width_px) {
  constexpr int line_px = 36;
  constexpr int bar_px = 14;
  constexpr int margin_px = 28;
  const int height_px = line_px * static_cast<int>(overlay.words.size()) + 18;
  cv::Mat panel(height_px, width_px, CV_8UC3, panel_color);
  panel.colRange(0, std::min(bar_px, width_px)).setTo(overlay.accepted ? accepted_color : refused_color);
  const double size = size_that_fits(overlay.words, width_px - margin_px - bar_px);
  for (std::size_t i = 0; i < overlay.words.size(); ++i) {
    const bool result = i == 0;
    const cv::Scalar& color = !result ? words_color : overlay.accepted ? accepted_color : refused_color;
    cv::putText(panel, overlay.words[i], {margin_px, line_px * (static_cast<int>(i) + 1)}, font, size, color,
                result ? 2 : 1, cv::LINE_AA);
  }
  return panel;
}

}  // namespace

cv::Mat draw_overlay(const Overlay& overlay) {
  const int scale = std::max(1, picture_width_px / std::max(overlay.gray.cols, 1));
  const Enlarged enlarged(scale);
  cv::Mat picture;
  cv::resize(overlay.gray, picture, {}, scale, scale, cv::INTER_NEAREST);
  cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
  for (const OverlayMarker& shown : overlay.markers) {
    const DetectedMarker& marker = shown.marker;
    draw_axis(picture, marker.o_px, marker.x_px, "X", x_color, enlarged);
    draw_axis(picture, marker.o_px, marker.y_px, "Y", y_color, enlarged);
    draw_dots(picture, marker, enlarged);
  }
  std::vector<cv::Rect> taken;
  for (const OverlayMarker& shown : overlay.markers) taken.push_back(surroundings_of(shown.marker, enlarged));
  for (const OverlayMarker& shown : overlay.markers) draw_label(picture, shown, enlarged, taken);
  if (!overlay.words.empty()) picture.push_back(panel_of(overlay, picture.cols));
  return picture;
}

OverlayFolder::OverlayFolder(fs::path folder, const std::vector<fs::path>& image_folders)
    : folder_(std::move(folder)) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error || !fs::is_directory(folder_))
    throw InputError(folder_, 0, "a folder that cannot be made", "a folder for drawings");
  for (const fs::path& images : image_folders) {
    if (fs::equivalent(folder_, images, error))
      throw InputError(folder_, 0, "the folder of the images themselves", "another one for drawings");
  }
}

void OverlayFolder::write(const SourceFrame& frame, const cv::Mat& picture) {
  std::string name = frame.picture;
  for (int again = 2; !written_.insert(name).second; ++again)
    name = fmt::format("{}-{}", frame.picture, again);
  const fs::path file = folder_ / (name + ".png");
  std::ofstream stream(file, std::ios::binary);
  if (!(stream << png_bytes(picture) << std::flush))
    throw InputError(file, 0, "a picture that could not be written", "a folder that can be written");
}

}  // namespace lodestar

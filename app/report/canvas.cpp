#include "app/report/canvas.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace lodestar {
namespace {

constexpr int scale = 2;
constexpr int fraction_bits = 4;  ///< of OpenCV's drawing coordinates

const cv::Scalar paper_white(255, 255, 255);
const cv::Vec3b free_color(255, 255, 255);
const cv::Vec3b occupied_color(58, 50, 46);
const cv::Vec3b unknown_color(214, 214, 214);
const cv::Scalar frame_color(110, 110, 110);

constexpr int font = cv::FONT_HERSHEY_DUPLEX;

double font_size(double height_px) {
  constexpr double capital_height = 22.0;  // of the font at size 1
  return height_px * scale / capital_height;
}

int whole(double value) {
  return static_cast<int>(std::lround(value));
}

cv::Point fine(const Vec2& pixel) {
  constexpr int one = scale << fraction_bits;
  return {whole(pixel.x() * one), whole(pixel.y() * one)};
}

int thickness(double width_px) {
  return std::max(1, whole(width_px * scale));
}

cv::Vec3b color_of(std::int8_t value) {
  if (value == OccupancyMap::unknown) return unknown_color;
  const double share = static_cast<double>(value) / OccupancyMap::occupied;
  cv::Vec3b color;
  for (int i = 0; i < 3; ++i)
    color[i] = static_cast<std::uint8_t>(std::lerp(free_color[i], occupied_color[i], share));
  return color;
}

}  // namespace

Canvas::Canvas(const Vec2& low_m, const Vec2& high_m, double width_px, const Margins& margins)
    : low_m_(low_m), high_m_(high_m), margins_(margins), pixels_per_m_(width_px / (high_m.x() - low_m.x())) {
  const double height_px = (high_m.y() - low_m.y()) * pixels_per_m_;
  large_ = cv::Mat(scale * whole(height_px + margins.top_px + margins.bottom_px),
                   scale * whole(width_px + margins.left_px + margins.right_px), CV_8UC3, paper_white);
}

Vec2 Canvas::pixel(const Vec2& point_m) const {
  return {margins_.left_px + (point_m.x() - low_m_.x()) * pixels_per_m_,
          margins_.top_px + (high_m_.y() - point_m.y()) * pixels_per_m_};
}

Vec2 Canvas::point_m(const Vec2& pixel) const {
  return {low_m_.x() + (pixel.x() - margins_.left_px) / pixels_per_m_,
          high_m_.y() - (pixel.y() - margins_.top_px) / pixels_per_m_};
}

/// Pixel by pixel, so that a map rotated in its frame is drawn rotated.
void Canvas::draw_map(const OccupancyMap& map) {
  const cv::Point top_left = fine(pixel({low_m_.x(), high_m_.y()})) / (1 << fraction_bits);
  const cv::Point bottom_right = fine(pixel({high_m_.x(), low_m_.y()})) / (1 << fraction_bits);
  const double m_per_pixel = 1.0 / (pixels_per_m_ * scale);
  for (int y = std::max(top_left.y, 0); y < std::min(bottom_right.y, large_.rows); ++y) {
    auto* row = large_.ptr<cv::Vec3b>(y);
    for (int x = std::max(top_left.x, 0); x < std::min(bottom_right.x, large_.cols); ++x) {
      const Vec2 point(low_m_.x() + (x + 0.5 - top_left.x) * m_per_pixel,
                       high_m_.y() - (y + 0.5 - top_left.y) * m_per_pixel);
      const Cell cell = map.cell_at(point);
      row[x] = map.contains(cell) ? color_of(map.at(cell)) : unknown_color;
    }
  }
}

void Canvas::draw_frame() {
  const Vec2 a = pixel(low_m_);
  const Vec2 b = pixel(high_m_);
  cv::rectangle(large_, fine(a), fine(b), frame_color, thickness(1.0), cv::LINE_AA, fraction_bits);
}

void Canvas::draw_line(const std::vector<Vec2>& points_m, const cv::Scalar& color, double width_px) {
  for (std::size_t i = 1; i < points_m.size(); ++i)
    draw_line_px(pixel(points_m[i - 1]), pixel(points_m[i]), color, width_px);
}

void Canvas::draw_disc(const Vec2& center_m, double radius_px, const cv::Scalar& color) {
  draw_disc_px(pixel(center_m), radius_px, color);
}

void Canvas::draw_ring(const Vec2& center_m, double radius_px, const cv::Scalar& color, double width_px) {
  draw_ring_px(pixel(center_m), radius_px, color, width_px);
}

void Canvas::draw_text(const Vec2& at_m, const std::string& text, double height_px, const cv::Scalar& color) {
  draw_text_px(pixel(at_m), text, height_px, color, 0.5);
}

void Canvas::draw_line_px(const Vec2& from_px, const Vec2& to_px, const cv::Scalar& color, double width_px) {
  cv::line(large_, fine(from_px), fine(to_px), color, thickness(width_px), cv::LINE_AA, fraction_bits);
}

void Canvas::draw_disc_px(const Vec2& center_px, double radius_px, const cv::Scalar& color) {
  cv::circle(large_, fine(center_px), whole(radius_px * (scale << fraction_bits)), color, cv::FILLED,
             cv::LINE_AA, fraction_bits);
}

void Canvas::draw_ring_px(const Vec2& center_px, double radius_px, const cv::Scalar& color, double width_px) {
  cv::circle(large_, fine(center_px), whole(radius_px * (scale << fraction_bits)), color, thickness(width_px),
             cv::LINE_AA, fraction_bits);
}

void Canvas::draw_box_px(const Vec2& low_px, const Vec2& high_px, const cv::Scalar& fill) {
  cv::rectangle(large_, fine(low_px), fine(high_px), fill, cv::FILLED, cv::LINE_AA, fraction_bits);
}

void Canvas::draw_text_px(const Vec2& at_px, const std::string& text, double height_px,
                          const cv::Scalar& color, double align) {
  write(at_px, text, height_px, color, align, 0.0);
}

void Canvas::draw_label_px(const Vec2& at_px, const std::string& text, double height_px,
                           const cv::Scalar& color, double align) {
  constexpr double edge_px = 2.0;
  write(at_px, text, height_px, paper_white, align, edge_px);
  write(at_px, text, height_px, color, align, 0.0);
}

void Canvas::write(const Vec2& at_px, const std::string& text, double height_px, const cv::Scalar& color,
                   double align, double edge_px) {
  const double size = font_size(height_px);
  const int stroke = std::max(1, whole(height_px * scale / 16.0));
  const cv::Point at(whole((at_px.x() - align * text_width_px(text, height_px)) * scale),
                     whole((at_px.y() + 0.5 * height_px) * scale));
  cv::putText(large_, text, at, font, size, color, stroke + whole(2.0 * edge_px * scale), cv::LINE_AA);
}

double Canvas::text_width_px(const std::string& text, double height_px) {
  int baseline = 0;
  return static_cast<double>(cv::getTextSize(text, font, font_size(height_px), 1, &baseline).width) / scale;
}

cv::Mat Canvas::picture() const {
  cv::Mat small;
  cv::resize(large_, small, {}, 1.0 / scale, 1.0 / scale, cv::INTER_AREA);
  return small;
}

Canvas canvas_for(const OccupancyMap& map, double width_px, const Canvas::Margins& margins) {
  Vec2 low = map.map_from_grid.position_m;
  Vec2 high = low;
  for (const int column : {0, map.columns}) {
    for (const int row : {0, map.rows}) {
      const Vec2 corner = map.map_from_grid * Vec2(column * map.resolution_m, row * map.resolution_m);
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  }
  return {low, high, width_px, margins};
}

}  // namespace lodestar

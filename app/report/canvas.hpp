#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "maps/occupancy_map.hpp"

namespace lodestar {

/// A drawing of the plane in the map frame, y up. It is drawn at twice its size and averaged down at the end,
/// so that thin lines come out smooth. Sizes are in pixels of the finished picture.
class Canvas {
 public:
  struct Margins {
    double left_px = 90.0;
    double right_px = 40.0;
    double top_px = 70.0;
    double bottom_px = 150.0;
  };

  /// Shows the rectangle from low_m to high_m, `width_px` wide without its margins.
  Canvas(const Vec2& low_m, const Vec2& high_m, double width_px, const Margins& margins);

  void draw_map(const OccupancyMap& map);
  void draw_frame();
  void draw_line(const std::vector<Vec2>& points_m, const cv::Scalar& color, double width_px);
  void draw_disc(const Vec2& center_m, double radius_px, const cv::Scalar& color);
  void draw_ring(const Vec2& center_m, double radius_px, const cv::Scalar& color, double width_px);
  void draw_text(const Vec2& at_m, const std::string& text, double height_px, const cv::Scalar& color);

  // The same in pixels of the finished picture, for text and marks in the margins.
  void draw_line_px(const Vec2& from_px, const Vec2& to_px, const cv::Scalar& color, double width_px);
  void draw_disc_px(const Vec2& center_px, double radius_px, const cv::Scalar& color);
  void draw_ring_px(const Vec2& center_px, double radius_px, const cv::Scalar& color, double width_px);
  void draw_box_px(const Vec2& low_px, const Vec2& high_px, const cv::Scalar& fill);
  /// `align` 0 begins at the point, 0.5 centres on it, 1 ends there; vertically the text is centred on it.
  void draw_text_px(const Vec2& at_px, const std::string& text, double height_px, const cv::Scalar& color,
                    double align = 0.0);

  /// The same on a white edge, so that it can be read over anything.
  void draw_label_px(const Vec2& at_px, const std::string& text, double height_px, const cv::Scalar& color,
                     double align);

  static double text_width_px(const std::string& text, double height_px);

  [[nodiscard]] Vec2 pixel(const Vec2& point_m) const;
  [[nodiscard]] Vec2 point_m(const Vec2& pixel) const;
  [[nodiscard]] double pixels_per_m() const { return pixels_per_m_; }
  [[nodiscard]] const Vec2& low_m() const { return low_m_; }
  [[nodiscard]] const Vec2& high_m() const { return high_m_; }

  /// The finished picture, BGR.
  [[nodiscard]] cv::Mat picture() const;

 private:
  void write(const Vec2& at_px, const std::string& text, double height_px, const cv::Scalar& color,
             double align, double edge_px);

  Vec2 low_m_;
  Vec2 high_m_;
  Margins margins_;
  double pixels_per_m_ = 1.0;
  cv::Mat large_;
};

/// Shows the smallest upright rectangle around a map, which may lie turned in its frame.
Canvas canvas_for(const OccupancyMap& map, double width_px, const Canvas::Margins& margins = {});

}  // namespace lodestar

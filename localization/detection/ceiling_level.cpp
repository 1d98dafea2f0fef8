#include "localization/detection/ceiling_level.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <cstdint>

namespace lodestar {

CeilingLevel::CeilingLevel(std::span<const Dot> dots) {
  constexpr std::size_t least_dots = 5;  // fewer may lie in one line
  constexpr double least_width = 0.01;   // of their spread across against along: variance ratio
  if (dots.empty()) return;
  const double share = 1.0 / static_cast<double>(dots.size());
  double level = 0.0;
  for (const Dot& dot : dots) {
    middle_px_ += share * dot.center_px;
    level += share * dot.background_gray;
  }
  double extent_px2 = 0.0;
  for (const Dot& dot : dots) extent_px2 += share * (dot.center_px - middle_px_).squaredNorm();
  if (extent_px2 > 0.0) per_px_ = 1.0 / std::sqrt(extent_px2);
  plane_ = {level, 0.0, 0.0};
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Vec3 right = Vec3::Zero();
  for (const Dot& dot : dots) {
    const Vec3 row = row_at(dot.center_px);
    sum += share * row * row.transpose();
    right += share * dot.background_gray * row;
  }
  if (dots.size() >= least_dots && sum.bottomRightCorner<2, 2>().determinant() > least_width)
    plane_ = sum.ldlt().solve(right);
  for (const Dot& dot : dots) spread_gray_ += share * square(dot.background_gray - at(dot.center_px));
  spread_gray_ = std::sqrt(spread_gray_);
}

double CeilingLevel::at(const Vec2& place_px) const {
  return plane_.dot(row_at(place_px));
}

Vec3 CeilingLevel::row_at(const Vec2& place_px) const {
  const Vec2 off = per_px_ * (place_px - middle_px_);
  return {1.0, off.x(), off.y()};
}

double share_at_level(const cv::Mat& gray, const Vec2& center_px, double radius_px, double level_gray,
                      double tolerance_gray) {
  const cv::Rect frame(0, 0, gray.cols, gray.rows);
  const Vec2 corner = center_px - Vec2::Constant(radius_px);
  const int side = static_cast<int>(std::ceil(2.0 * radius_px)) + 1;
  const cv::Rect about(static_cast<int>(std::ceil(corner.x())), static_cast<int>(std::ceil(corner.y())), side,
                       side);
  const cv::Rect seen = about & frame;
  int inside = 0;
  int at_level = 0;
  for (int v = seen.y; v < seen.br().y; ++v) {
    for (int u = seen.x; u < seen.br().x; ++u) {
      if ((Vec2(u, v) - center_px).squaredNorm() > radius_px * radius_px) continue;
      ++inside;
      at_level += std::abs(gray.ptr<std::uint8_t>(v)[u] - level_gray) < tolerance_gray ? 1 : 0;
    }
  }
  return inside > 0 ? static_cast<double>(at_level) / inside : 0.0;
}

}  // namespace lodestar

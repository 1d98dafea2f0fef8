#include "localization/ceiling/ceiling_view.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace lodestar {

cv::Mat1f contrasts(const cv::Mat& gray, const CeilingViewOptions& options) {
  cv::Mat reduced = gray;
  for (int i = 0; i < options.halvings; ++i) {
    const cv::Size half(reduced.cols / 2, reduced.rows / 2);
    cv::Mat halved;
    cv::resize(reduced({0, 0, 2 * half.width, 2 * half.height}), halved, half, 0.0, 0.0, cv::INTER_AREA);
    reduced = halved;
  }
  cv::Mat1f fine;
  reduced.convertTo(fine, CV_32F);
  cv::GaussianBlur(fine, fine, {3, 3}, 0.8);
  const int reach = 2 * static_cast<int>(options.contrast_reach_px) + 1;
  cv::Mat1f slow;
  cv::blur(fine, slow, {reach, reach});
  cv::subtract(fine, slow, fine);
  return fine;
}

bool is_within(const cv::Mat1f& picture, const Vec2& pixel) {
  return pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() < picture.cols - 1 && pixel.y() < picture.rows - 1;
}

double gray_at(const cv::Mat1f& picture, const Vec2& pixel) {
  const auto u = static_cast<int>(pixel.x());
  const auto v = static_cast<int>(pixel.y());
  const float* above = picture[v] + u;
  const float* below = above + picture.cols;
  const double across = pixel.x() - u;
  const double down = pixel.y() - v;
  return std::lerp(std::lerp(above[0], above[1], across), std::lerp(below[0], below[1], across), down);
}

CeilingView::CeilingView(const CameraModel& camera, const Eigen::Isometry3d& base_from_camera,
                         double ceiling_height_m, const CeilingViewOptions& options)
    : camera_(camera),
      base_from_camera_(base_from_camera),
      camera_from_base_(base_from_camera.inverse()),
      height_m_(ceiling_height_m),
      reduction_(std::exp2(options.halvings)),
      farthest_m_(options.farthest_m) {}

std::optional<Vec2> CeilingView::pixel_of(const Vec2& on_ceiling_m) const {
  const std::optional<Vec2> pixel =
      camera_.project(camera_from_base_ * Vec3(on_ceiling_m.x(), on_ceiling_m.y(), height_m_));
  if (!pixel) return std::nullopt;
  const double middle = 0.5 * (reduction_ - 1.0);  // centre of the pixels that became one
  return Vec2((pixel->x() - middle) / reduction_, (pixel->y() - middle) / reduction_);
}

std::optional<Vec2> CeilingView::ceiling_at(const Vec2& pixel) const {
  const double middle = 0.5 * (reduction_ - 1.0);
  const std::optional<Vec2> ray = camera_.normalized(reduction_ * pixel + Vec2(middle, middle));
  if (!ray) return std::nullopt;
  const Vec3 direction = base_from_camera_.linear() * ray->homogeneous();
  const Vec3 from = base_from_camera_.translation();
  const double distance = (height_m_ - from.z()) / direction.z();
  if (!(distance > 0.0)) return std::nullopt;
  const Vec2 aside = distance * direction.head<2>();
  if (aside.norm() > farthest_m_) return std::nullopt;
  return from.head<2>() + aside;
}

Eigen::Matrix2d CeilingView::shift_by_lean(const Vec2& on_ceiling_m) const {
  const Vec3 camera = base_from_camera_.translation();
  const Vec2 aside = on_ceiling_m - camera.head<2>();
  return aside * aside.transpose() / (height_m_ - camera.z());
}

}  // namespace lodestar

#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core/mat.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "maps/camera_model.hpp"
#include "maps/marker.hpp"
#include "maps/paper_camera.hpp"
#include "maps/random.hpp"

// Synthetic frames: their truth is chosen before they are drawn.
namespace lodestar {

/// Field of view of 90 degrees.
inline CameraModel wide_camera() {
  return {.width_px = 640, .height_px = 480, .fx_px = 320.0, .fy_px = 320.0, .cx_px = 319.5, .cy_px = 239.5};
}

/// A marker seen from below: at turn 0, X is to the right of O in the image and Y above it. The tilt is about
/// an axis in the image plane; `middle_px` is the image of the grid's centre.
struct MarkerView {
  Vec2 middle_px = Vec2(320.0, 240.0);
  double depth_m = 1.5;
  double turn_rad = 0.0;
  double tilt_rad = 0.0;
  double tilt_axis_rad = 0.0;
};

inline Eigen::Isometry3d camera_from_marker(const CameraModel& camera, const MarkerView& view) {
  const Vec3 tilt_axis(std::cos(view.tilt_axis_rad), std::sin(view.tilt_axis_rad), 0.0);
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() =
      (Eigen::AngleAxisd(view.tilt_rad, tilt_axis) * Eigen::AngleAxisd(view.turn_rad, Vec3::UnitZ()) *
       Eigen::AngleAxisd(radians(180.0), Vec3::UnitX()))
          .toRotationMatrix();
  const Vec3 middle_in_marker(1.5 * marker_pitch_m, 1.5 * marker_pitch_m, 0.0);
  const Vec2 ray = camera.normalized(view.middle_px).value();
  result.translation() = view.depth_m * ray.homogeneous() - result.linear() * middle_in_marker;
  return result;
}

inline Vec2 dot_in_image(const CameraModel& camera, const MarkerView& view, GridCell cell) {
  const Vec2 place = cell_in_marker(cell);
  return camera.project(camera_from_marker(camera, view) * Vec3(place.x(), place.y(), 0.0)).value();
}

/// A small renderer: edges by 8 x 8 samples per pixel, then blur, noise and rounding.
class PaintedFrame {
 public:
  explicit PaintedFrame(cv::Size size, double background_gray = 35.0)
      : image_(size, CV_32FC1, cv::Scalar(background_gray)) {}

  void dot(const CameraModel& camera, const MarkerView& view, GridCell cell, double gray) {
    const Eigen::Isometry3d marker_from_camera = camera_from_marker(camera, view).inverse();
    const Vec2 place = cell_in_marker(cell);
    const double reach = 1.5 * marker_dot_radius_m * camera.fx_px / view.depth_m + 1.0;
    fill(dot_in_image(camera, view, cell), reach, gray, [&](const Vec2& pixel) {
      const Vec3 ray = marker_from_camera.linear() * camera.normalized(pixel).value().homogeneous();
      const Vec3 start = marker_from_camera.translation();
      const Vec2 hit = (start - ray * (start.z() / ray.z())).head<2>();
      return (hit - place).norm() < marker_dot_radius_m;
    });
  }

  void marker(const CameraModel& camera, const MarkerView& view, int id, double gray = 246.0) {
    for (const GridCell cell : dots_of(id)) dot(camera, view, cell, gray);
  }

  void disc(const Vec2& center, double radius_px, double gray = 250.0) {
    fill(center, radius_px + 1.0, gray, [&](const Vec2& p) { return (p - center).norm() < radius_px; });
  }

  void tube(const Vec2& from, const Vec2& to, double width_px, double gray = 255.0) {
    const Vec2 along = to - from;
    fill(0.5 * (from + to), 0.5 * along.norm() + width_px, gray, [&](const Vec2& p) {
      const double t = std::clamp((p - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
      return (p - from - t * along).norm() < 0.5 * width_px;
    });
  }

  /// Motion blur: the mean over positions along `motion_px`.
  void move(const Vec2& motion_px) {
    constexpr int steps = 9;
    cv::Mat sum = cv::Mat::zeros(image_.size(), CV_32FC1);
    for (int i = 0; i < steps; ++i) {
      const Vec2 shift = (static_cast<double>(i) / (steps - 1) - 0.5) * motion_px;
      const cv::Matx23d warp(1.0, 0.0, shift.x(), 0.0, 1.0, shift.y());
      cv::Mat moved;
      cv::warpAffine(image_, moved, warp, image_.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
      sum += moved;
    }
    image_ = sum / steps;
  }

  [[nodiscard]] cv::Mat finished(Random& random, double noise_gray = 4.0, double blur_sigma_px = 0.6) const {
    cv::Mat blurred;
    cv::GaussianBlur(image_, blurred, cv::Size(0, 0), blur_sigma_px);
    cv::Mat gray(image_.size(), CV_8UC1);
    for (int v = 0; v < gray.rows; ++v) {
      for (int u = 0; u < gray.cols; ++u) {
        const double noise = noise_gray > 0.0 ? noise_gray * random.normal() : 0.0;
        gray.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(blurred.at<float>(v, u) + noise);
      }
    }
    return gray;
  }

 private:
  template <typename Inside>
  void fill(const Vec2& center, double reach, double gray, const Inside& inside) {
    const int left = std::max(static_cast<int>(std::floor(center.x() - reach)), 0);
    const int right = std::min(static_cast<int>(std::ceil(center.x() + reach)), image_.cols - 1);
    const int top = std::max(static_cast<int>(std::floor(center.y() - reach)), 0);
    const int bottom = std::min(static_cast<int>(std::ceil(center.y() + reach)), image_.rows - 1);
    for (int v = top; v <= bottom; ++v) {
      for (int u = left; u <= right; ++u) {
        const auto share =
            static_cast<float>(covered({static_cast<double>(u), static_cast<double>(v)}, inside));
        float& pixel = image_.at<float>(v, u);
        pixel += share * (static_cast<float>(gray) - pixel);
      }
    }
  }

  template <typename Inside>
  static double covered(const Vec2& pixel, const Inside& inside) {
    constexpr int side = 8;
    const bool here = inside(pixel);
    const bool edge_far = std::ranges::all_of(pixel_corners, [&](const std::array<double, 2>& corner) {
      return inside(pixel + Vec2(corner[0], corner[1])) == here;
    });
    if (edge_far) return here ? 1.0 : 0.0;
    int hits = 0;
    for (int j = 0; j < side; ++j) {
      for (int i = 0; i < side; ++i) {
        const Vec2 offset((i + 0.5) / side - 0.5, (j + 0.5) / side - 0.5);
        hits += inside(pixel + offset) ? 1 : 0;
      }
    }
    return hits / static_cast<double>(side * side);
  }

  static constexpr std::array<std::array<double, 2>, 4> pixel_corners{
      {{-0.5, -0.5}, {0.5, -0.5}, {-0.5, 0.5}, {0.5, 0.5}}};

  cv::Mat image_;
};

}  // namespace lodestar

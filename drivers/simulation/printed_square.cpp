#include "drivers/simulation/printed_square.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace lodestar {
namespace {

constexpr double reach_sigmas = 4.0;

/// The pixels [left, right] x [top, bottom] affected by the square and its blur.
struct Window {
  int left = 0;
  int top = 0;
  int right = -1;
  int bottom = -1;
  [[nodiscard]] int width() const { return right - left + 1; }
  [[nodiscard]] int height() const { return bottom - top + 1; }
};

std::optional<Window> window_of(const PrintedSquare& square, const Eigen::Isometry3d& camera_from_square,
                                const CameraModel& camera, double margin_px) {
  constexpr int steps = 8;  // per edge, which lens distortion may bend
  Vec2 low = Vec2::Constant(1e9);
  Vec2 high = Vec2::Constant(-1e9);
  for (int i = 0; i <= steps; ++i) {
    const double along = square.side_m * (static_cast<double>(i) / steps - 0.5);
    const double rim = 0.5 * square.side_m;
    for (const Vec2& point : {Vec2(along, rim), Vec2(along, -rim), Vec2(rim, along), Vec2(-rim, along)}) {
      const std::optional<Vec2> pixel = camera.project(camera_from_square * Vec3(point.x(), point.y(), 0.0));
      if (!pixel) return std::nullopt;
      low = low.cwiseMin(*pixel);
      high = high.cwiseMax(*pixel);
    }
  }
  const auto between = [](double value, int last) {
    return static_cast<int>(std::clamp(value, -1.0, last + 1.0));
  };
  return Window{
      std::max(between(std::floor(low.x() - margin_px), camera.width_px - 1), 0),
      std::max(between(std::floor(low.y() - margin_px), camera.height_px - 1), 0),
      std::min(between(std::ceil(high.x() + margin_px), camera.width_px - 1), camera.width_px - 1),
      std::min(between(std::ceil(high.y() + margin_px), camera.height_px - 1), camera.height_px - 1)};
}

/// The one or two modules that a sample of the given width covers along one axis, and the second one's share.
struct Covered {
  int first = 0;
  int second = 0;
  double share_of_second = 0.0;
};

Covered covered_by(double place, double width) {
  const double low = std::floor(place - 0.5 * width);
  const double high = std::floor(place + 0.5 * width);
  const double share = low < high ? (place + 0.5 * width - high) / width : 0.0;
  return {static_cast<int>(low), static_cast<int>(high), share};
}

/// (Opacity, light) of the pattern at a point, in modules from the top-left corner. Averaging over the
/// sample's width keeps edges at their subsample position instead of snapping them to samples.
cv::Vec2f sample(const PrintedSquare& square, const Vec2& place, double width) {
  const Covered column = covered_by(place.x(), width);
  const Covered row = covered_by(place.y(), width);
  cv::Vec2f sum(0.0F, 0.0F);
  const auto add = [&](int i, int j, double share) {
    if (share <= 0.0 || i < 0 || j < 0 || i >= square.modules || j >= square.modules) return;
    const double gray = square.gray[static_cast<std::size_t>(i * square.modules + j)];
    sum += cv::Vec2f(static_cast<float>(share), static_cast<float>(share * gray));
  };
  add(row.first, column.first, (1.0 - row.share_of_second) * (1.0 - column.share_of_second));
  add(row.first, column.second, (1.0 - row.share_of_second) * column.share_of_second);
  add(row.second, column.first, row.share_of_second * (1.0 - column.share_of_second));
  add(row.second, column.second, row.share_of_second * column.share_of_second);
  return sum;
}

/// Intersection of a pixel's ray with the square, in modules from its top-left corner; far outside when there
/// is none.
class Sight {
 public:
  Sight(const PrintedSquare& square, const Eigen::Isometry3d& camera_from_square, const CameraModel& camera)
      : camera_(camera),
        square_from_camera_(camera_from_square.inverse()),
        modules_per_m_(square.modules / square.side_m),
        middle_(0.5 * square.modules) {}

  [[nodiscard]] Vec2 place(const Vec2& pixel) const {
    const Vec2 nowhere(-1e6, -1e6);
    const std::optional<Vec2> ray = camera_.normalized(pixel);
    if (!ray) return nowhere;
    const Vec3 direction = square_from_camera_.linear() * ray->homogeneous();
    if (!(direction.z() < -1e-6)) return nowhere;
    const Vec3 from = square_from_camera_.translation();
    const Vec3 met = from - (from.z() / direction.z()) * direction;
    const Vec2 place(middle_ + modules_per_m_ * met.x(), middle_ - modules_per_m_ * met.y());
    return place.cwiseAbs().maxCoeff() < 1e6 ? place : nowhere;
  }

 private:
  const CameraModel& camera_;
  Eigen::Isometry3d square_from_camera_;
  double modules_per_m_;
  double middle_;
};

/// Blends light over a pixel; `gray` is premultiplied by `opacity`.
void cover_with(std::int16_t& pixel, double opacity, double gray) {
  const double units = LightImage::units_per_gray * std::clamp(gray, 0.0, LightImage::brightest_gray);
  pixel = static_cast<std::int16_t>(pixel * (1.0 - std::clamp(opacity, 0.0, 1.0)) + units + 0.5);
}

/// Share of a blurred stripe of this width at a given distance from its first edge, all in sigmas.
double share_of_stripe(double from_edge, double width) {
  const auto beyond = [](double x) {
    if (std::abs(x) > reach_sigmas) return x > 0.0 ? 1.0 : 0.0;
    return 0.5 * std::erfc(-x / std::numbers::sqrt2);
  };
  return beyond(from_edge) - beyond(from_edge - width);
}

/// A square without a pattern: the product of two stripes in closed form. The image scale at its centre is
/// used throughout, which affects only the blur of its edges.
void paint_plain(const PrintedSquare& square, const Sight& sight, const Window& window,
                 const Vignetting& vignetting, double sigma_px, LightImage& image) {
  const Vec2 middle(0.5 * (window.left + window.right), 0.5 * (window.top + window.bottom));
  const Vec2 by_u = sight.place(middle + Vec2(0.5, 0.0)) - sight.place(middle - Vec2(0.5, 0.0));
  const Vec2 by_v = sight.place(middle + Vec2(0.0, 0.5)) - sight.place(middle - Vec2(0.0, 0.5));
  const double width = 1.0 / (sigma_px * std::hypot(by_u.x(), by_v.x()));
  const double height = 1.0 / (sigma_px * std::hypot(by_u.y(), by_v.y()));
  for (int v = window.top; v <= window.bottom; ++v) {
    for (int u = window.left; u <= window.right; ++u) {
      const Vec2 place = sight.place(Vec2(u, v));
      const double share =
          share_of_stripe(place.x() * width, width) * share_of_stripe(place.y() * height, height);
      if (share > 0.0)
        cover_with(image.row(v)[u], share, share * square.gray.front() * vignetting.at(Vec2(u, v)));
    }
  }
}

/// A square with a pattern, supersampled.
void paint_pattern(const PrintedSquare& square, const Sight& sight, const Window& window,
                   const Vignetting& vignetting, double sigma_px, LightImage& image) {
  constexpr int fine = 5;  // samples per pixel and axis: odd, so that one lies on the pixel's centre
  const Vec2 middle(0.5 * (window.left + window.right), 0.5 * (window.top + window.bottom));
  const double width = (sight.place(middle + Vec2(1.0 / fine, 0.0)) - sight.place(middle)).norm();
  // A margin around the window, so that content just outside the image blurs into it.
  const int margin = static_cast<int>(std::ceil(reach_sigmas * sigma_px)) * fine;
  cv::Mat2f samples(window.height() * fine + 2 * margin, window.width() * fine + 2 * margin);
  for (int j = 0; j < samples.rows; ++j) {
    for (int i = 0; i < samples.cols; ++i) {
      const Vec2 pixel(window.left - 0.5 + (i - margin + 0.5) / fine,
                       window.top - 0.5 + (j - margin + 0.5) / fine);
      samples(j, i) = sample(square, sight.place(pixel), width);
    }
  }
  cv::GaussianBlur(samples, samples, {}, fine * sigma_px);
  for (int v = window.top; v <= window.bottom; ++v) {
    for (int u = window.left; u <= window.right; ++u) {
      const cv::Vec2f& seen =
          samples(margin + (v - window.top) * fine + fine / 2, margin + (u - window.left) * fine + fine / 2);
      cover_with(image.row(v)[u], seen[0], seen[1] * vignetting.at(Vec2(u, v)));
    }
  }
}

}  // namespace

void paint_square(const PrintedSquare& square, const Eigen::Isometry3d& camera_from_map,
                  const CameraModel& camera, const Vignetting& vignetting, double sigma_px,
                  LightImage& image) {
  const Eigen::Isometry3d camera_from_square = camera_from_map * square.map_from_square;
  if (!(camera_from_square.inverse().translation().z() > 0.0)) return;
  const std::optional<Window> window = window_of(square, camera_from_square, camera, reach_sigmas * sigma_px);
  if (!window || window->width() <= 0 || window->height() <= 0) return;

  const Sight sight(square, camera_from_square, camera);
  const auto paint = square.modules == 1 ? paint_plain : paint_pattern;
  paint(square, sight, *window, vignetting, sigma_px, image);
}

}  // namespace lodestar

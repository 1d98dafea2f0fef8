#pragma once

#include <cmath>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "localization/calibration/calibration_board.hpp"
#include "maps/camera_model.hpp"
#include "maps/random.hpp"

// Images of calibration boards, taken by a known camera.
namespace lodestar::testing {

/// The print: gray value at a point of the board, blurred by `blur_m`; nothing outside the board.
using Print = std::function<std::optional<double>(const Vec2& point_m, double blur_m)>;

/// A square wave: +1 and -1 in turn between whole numbers, with blurred edges.
inline double blurred_squares(double at, double blur) {
  const double edge = std::round(at);
  const double sign = static_cast<int>(edge) % 2 == 0 ? 1.0 : -1.0;
  return sign * std::erf((at - edge) / (std::numbers::sqrt2 * blur));
}

/// `columns` x `rows` inner corners, the first at the origin, with a white border half a square wide.
inline Print chessboard(int columns, int rows, double square_m) {
  return [=](const Vec2& point, double blur_m) -> std::optional<double> {
    const Vec2 at = point / square_m + Vec2::Ones();  // in squares, from the outermost corner
    constexpr double border = 0.5;
    if (at.minCoeff() < -border || at.x() > columns + 1 + border || at.y() > rows + 1 + border) return {};
    if (at.minCoeff() < 0.0 || at.x() > columns + 1 || at.y() > rows + 1) return 230.0;
    const double blur = blur_m / square_m;
    return 127.5 - 102.5 * blurred_squares(at.x(), blur) * blurred_squares(at.y(), blur);
  };
}

/// Renders by following each pixel's ray to the board, whose print is blurred by the pixel's area and the
/// lens; then adds noise and rounds to 8 bits.
class BoardCamera {
 public:
  explicit BoardCamera(const CameraModel& camera) : camera_(camera) {
    for (int v = 0; v < camera.height_px; ++v) {
      for (int u = 0; u < camera.width_px; ++u) rays_.push_back(camera.normalized(Vec2(u, v)));
    }
  }

  [[nodiscard]] cv::Mat picture(const Print& print, const Eigen::Isometry3d& camera_from_board,
                                Random& random) const {
    const Eigen::Isometry3d board_from_camera = camera_from_board.inverse();
    cv::Mat gray(camera_.height_px, camera_.width_px, CV_8U);
    auto ray = rays_.begin();
    for (int v = 0; v < gray.rows; ++v) {
      for (int u = 0; u < gray.cols; ++u, ++ray) {
        const double light = *ray ? light_of(print, **ray, board_from_camera) : 0.0;
        gray.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(light + 2.0 * random.normal());
      }
    }
    return gray;
  }

 private:
  [[nodiscard]] double light_of(const Print& print, const Vec2& ray,
                                const Eigen::Isometry3d& board_from_camera) const {
    constexpr double wall = 110.0;
    constexpr double blur_px = 0.7;
    const Vec3 from = board_from_camera.translation();
    const Vec3 along = board_from_camera.linear() * ray.homogeneous();
    const double distance = -from.z() / along.z();
    if (!(distance > 0.0)) return wall;
    const Vec2 point = (from + distance * along).head<2>();
    const double m_per_px = distance / std::sqrt(camera_.distorted_jacobian(ray).determinant());
    return print(point, blur_px * m_per_px).value_or(wall);
  }

  CameraModel camera_;
  std::vector<std::optional<Vec2>> rays_;
};

/// How the boards of a set are held.
struct Holding {
  double most_tilt_rad = radians(35.0);
  double distance_m = 0.5;
  double reach = 0.95;  ///< share of the way from the image's centre to its border
};

/// Poses at which a board of this size is wholly in view: spread over the image, each turned and tilted
/// differently.
inline std::vector<Eigen::Isometry3d> board_places(const CameraModel& camera, const Vec2& first_m,
                                                   const Vec2& last_m, std::size_t count,
                                                   const Holding& holding, Random& random) {
  std::vector<Eigen::Isometry3d> places;
  while (places.size() < count) {
    const Vec2 half(0.5 * camera.width_px, 0.5 * camera.height_px);
    const Vec2 pixel =
        half + holding.reach * Vec2(half.x() * random.uniform(-1, 1), half.y() * random.uniform(-1, 1));
    const std::optional<Vec2> ray = camera.normalized(pixel);
    if (!ray) continue;
    const double direction = random.uniform(-std::numbers::pi, std::numbers::pi);
    const double tilt = holding.most_tilt_rad * std::sqrt(random.uniform());
    const Vec3 axis(std::cos(direction), std::sin(direction), 0.0);
    Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
    place.linear() =
        (Eigen::AngleAxisd(tilt, axis) * Eigen::AngleAxisd(random.uniform(-0.4, 0.4), Vec3::UnitZ()))
            .toRotationMatrix();
    const Vec2 middle = 0.5 * (first_m + last_m);
    const double distance_m = holding.distance_m * random.uniform(0.9, 1.3);
    place.translation() =
        distance_m * ray->homogeneous().normalized() - place.linear() * Vec3(middle.x(), middle.y(), 0.0);
    const auto in_view = [&](double x, double y) {
      const auto seen = camera.project(place * Vec3(x, y, 0.0));
      return seen && camera.contains(*seen, 3.0);
    };
    if (in_view(first_m.x(), first_m.y()) && in_view(last_m.x(), first_m.y()) &&
        in_view(first_m.x(), last_m.y()) && in_view(last_m.x(), last_m.y())) {
      places.push_back(place);
    }
  }
  return places;
}

/// The corners of a perfect detector, with noise added.
inline BoardView ideal_view(const CameraModel& camera, int columns, int rows, double square_m,
                            const Eigen::Isometry3d& camera_from_board, double sigma_px, Random& random) {
  BoardView view;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Vec3 point(column * square_m, row * square_m, 0.0);
      const Vec2 pixel =
          *camera.project(camera_from_board * point) + sigma_px * Vec2(random.normal(), random.normal());
      view.points_m.emplace_back(static_cast<float>(point.x()), static_cast<float>(point.y()), 0.0F);
      view.pixels.emplace_back(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
    }
  }
  return view;
}

/// Difference of two cameras: the RMS, in px, of where they see the same ray, over the inner part of the
/// image that boards wholly in view reach.
inline double difference_px(const CameraModel& truth, const CameraModel& camera) {
  double squared = 0.0;
  int rays = 0;
  for (int v = truth.height_px / 12; v < truth.height_px * 11 / 12; v += 20) {
    for (int u = truth.width_px / 12; u < truth.width_px * 11 / 12; u += 20) {
      const auto ray = truth.normalized(Vec2(u, v));
      if (!ray) continue;
      squared += (camera.distorted(*ray) - Vec2(u, v)).squaredNorm();
      ++rays;
    }
  }
  return std::sqrt(squared / rays);
}

}  // namespace lodestar::testing

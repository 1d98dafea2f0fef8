#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include "maps/camera_file.hpp"
#include "maps/camera_model.hpp"
#include "maps/input_error.hpp"
#include "maps/random.hpp"

#include "tests/maps/spoilt_file.hpp"
#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

using ::testing::HasSubstr;

CameraModel camera_with(Distortion distortion, std::array<double, 8> coefficients) {
  CameraModel camera;
  camera.width_px = 640;
  camera.height_px = 480;
  camera.fx_px = 321.0;
  camera.fy_px = 319.0;
  camera.cx_px = 318.5;
  camera.cy_px = 241.0;
  camera.distortion = distortion;
  camera.coefficients = coefficients;
  return camera;
}

const std::vector<CameraModel> cameras{
    camera_with(Distortion::none, {}),
    camera_with(Distortion::plumb_bob, {-0.2, 0.05, 0.001, -0.002, -0.003}),
    camera_with(Distortion::rational_polynomial, {0.3, -0.1, 0.0005, 0.001, 0.01, 0.5, -0.05, 0.01}),
    camera_with(Distortion::equidistant, {0.02, -0.01, 0.003, -0.001})};

TEST(CameraModel, goes_to_the_image_and_back) {
  Random random(1);
  for (const CameraModel& camera : cameras) {
    for (int i = 0; i < 500; ++i) {
      const Vec2 ray(random.uniform(-0.9, 0.9), random.uniform(-0.7, 0.7));
      const auto back = camera.normalized(camera.distorted(ray));
      ASSERT_TRUE(back.has_value());
      EXPECT_LT((*back - ray).norm(), 1e-9);
    }
  }
}

TEST(CameraModel, derivative_agrees_with_finite_differences) {
  Random random(2);
  constexpr double step = 1e-6;
  for (const CameraModel& camera : cameras) {
    for (int i = 0; i < 100; ++i) {
      const Vec2 ray(random.uniform(-0.9, 0.9), random.uniform(-0.7, 0.7));
      const Eigen::Matrix2d j = camera.distorted_jacobian(ray);
      for (int axis = 0; axis < 2; ++axis) {
        const Vec2 d = step * Vec2::Unit(axis);
        const Vec2 numeric = (camera.distorted(ray + d) - camera.distorted(ray - d)) / (2.0 * step);
        EXPECT_LT((numeric - j.col(axis)).norm(), 1e-4);
      }
    }
  }
}

TEST(CameraModel, agrees_with_opencv) {
  Random random(3);
  for (const CameraModel& camera : cameras) {
    const cv::Matx33d k(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
    const std::vector<double> d(
        camera.coefficients.begin(),
        camera.coefficients.begin() + (camera.distortion == Distortion::equidistant ? 4 : 8));
    for (int i = 0; i < 100; ++i) {
      const Vec3 point(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(1.2, 3.0));
      const std::vector<cv::Point3d> points{{point.x(), point.y(), point.z()}};
      std::vector<cv::Point2d> pixels;
      if (camera.distortion == Distortion::equidistant) {
        cv::fisheye::projectPoints(points, pixels, cv::Vec3d(), cv::Vec3d(), k, d);
      } else {
        cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), k, d, pixels);
      }
      const Vec2 ours = *camera.project(point);
      EXPECT_NEAR(ours.x(), pixels[0].x, 1e-6);
      EXPECT_NEAR(ours.y(), pixels[0].y, 1e-6);
    }
  }
}

TEST(CameraModel, sees_nothing_behind_itself) {
  EXPECT_FALSE(cameras[0].project({0.1, 0.1, -1.0}));
  EXPECT_FALSE(cameras[0].project({0.1, 0.1, 0.0}));
}

/// The distance from the principal point at which the camera shows the ray at this angle to its axis.
double shown_px(const CameraModel& camera, double angle_rad, double side_rad) {
  const Vec3 ray(std::tan(angle_rad) * std::cos(side_rad), std::tan(angle_rad) * std::sin(side_rad), 1.0);
  const std::optional<Vec2> pixel = camera.project(ray);
  return pixel ? (*pixel - Vec2(camera.cx_px, camera.cy_px)).norm() : -1.0;
}

/// Each folds back within 89 degrees: the distance from the image's middle shrinks with the angle from there.
const std::vector<CameraModel> folding_cameras{
    camera_with(Distortion::plumb_bob, {-0.33, 0.13, 0.0, 0.0, -0.02}),
    camera_with(Distortion::plumb_bob, {-0.33, 0.13, 0.004, -0.003, -0.02}),
    camera_with(Distortion::plumb_bob, {-0.5, 0.0, 0.0, 0.0, 0.02}),  // grows again from 60 degrees on
    camera_with(Distortion::rational_polynomial, {0.1, -0.05, 0.0, 0.0, 0.0, 0.5, 0.05, 0.01}),
    camera_with(Distortion::equidistant, {-0.05, -0.1, 0.0, 0.0})};

TEST(CameraModel, shows_no_ray_beyond_the_fold_of_its_distortion) {
  for (CameraModel camera : folding_cameras) {
    SCOPED_TRACE(camera.coefficients[0]);
    camera.limit_rays();
    for (const double side_rad : {0.0, 1.0, 2.5, 4.0, 5.5}) {
      double last_px = -1.0;
      bool is_hidden = false;
      for (double angle_rad = 0.001; angle_rad < radians(89.0); angle_rad += 0.001) {
        const double px = shown_px(camera, angle_rad, side_rad);
        if (px < 0.0) is_hidden = true;
        if (is_hidden) {
          ASSERT_LT(px, 0.0) << "shown again at " << degrees(angle_rad) << " degrees";
        } else {
          ASSERT_GT(px, last_px) << "folds back at " << degrees(angle_rad) << " degrees";
        }
        last_px = px;
      }
      EXPECT_TRUE(is_hidden);
    }
  }
}

TEST(CameraModel, shows_all_rays_up_to_the_fold) {
  CameraModel camera = folding_cameras.front();
  camera.limit_rays();
  // 1 - 0.99 u + 0.65 u^2 - 0.14 u^3, the derivative of the image radius by u = r^2, has its root at 3.1068.
  EXPECT_NEAR(camera.widest_ray_squared, 3.1068, 1e-3);
  for (CameraModel unfolded : cameras) {
    unfolded.limit_rays();
    EXPECT_GT(shown_px(unfolded, radians(45.0), 1.0), 0.0);
  }
}

TEST(CameraModel, has_no_ray_beyond_the_fold_for_a_pixel) {
  Random random(5);
  for (CameraModel camera : folding_cameras) {
    camera.limit_rays();
    for (int i = 0; i < 2000; ++i) {
      const Vec2 pixel(random.uniform(-500.0, 1140.0), random.uniform(-500.0, 980.0));
      const std::optional<Vec2> ray = camera.normalized(pixel);
      EXPECT_LE(ray.value_or(Vec2::Zero()).squaredNorm(), camera.widest_ray_squared);
    }
  }
}

const std::string good =
    "image_width: 640\nimage_height: 480\ncamera_name: c\n"
    "camera_matrix: {rows: 3, cols: 3, data: [321, 0, 318.5, 0, 319, 241, 0, 0, 1]}\n"
    "distortion_model: plumb_bob\ndistortion_coefficients: {rows: 1, cols: 5, data: [-0.2, 0.05, 0.001, "
    "-0.002, 0]}\n";

std::string error_of(const std::string& text) {
  return error_of("camera.yaml", text, load_camera);
}

std::string with(const std::string& piece, const std::string& by) {
  return lodestar::with(good, piece, by);
}

TEST(CameraFile, reads_camera_info) {
  const TemporaryFolder folder;
  const CameraModel camera = load_camera(folder.write("c.yaml", good));
  EXPECT_EQ(camera.width_px, 640);
  EXPECT_EQ(camera.fy_px, 319.0);
  EXPECT_EQ(camera.distortion, Distortion::plumb_bob);
  EXPECT_EQ(camera.coefficients[1], 0.05);
}

TEST(CameraFile, comes_with_the_limit_of_its_rays) {
  const TemporaryFolder folder;
  const CameraModel camera =
      load_camera(folder.write("c.yaml", with("-0.2, 0.05, 0.001, -0.002, 0", "-0.33, 0.13, 0, 0, -0.02")));
  EXPECT_TRUE(camera.project({1.6, 0.0, 1.0}));
  EXPECT_FALSE(camera.project({2.2, 0.0, 1.0}));
}

TEST(CameraFile, reads_opencv_file_storage) {
  const TemporaryFolder folder;
  const CameraModel camera = load_camera(
      folder.write("c.yaml",
                   "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\navg_reprojection_error: 0.2\n"
                   "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 321., 0., "
                   "318.5, 0., 319., 241., 0., 0., 1. ]\n"
                   "distortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n   data: [ "
                   "-0.2, 0.05, 0.001, -0.002, 0. ]\n"));
  EXPECT_EQ(camera.fx_px, 321.0);
  EXPECT_EQ(camera.coefficients[0], -0.2);
}

TEST(CameraFile, refuses_broken_opencv_file_storage_with_its_line) {
  const std::string head = "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\n";
  const std::string distortion =
      "distortion_coefficients: !!opencv-matrix\n   rows: 1\n   cols: 4\n   dt: d\n   data: [ 0., 0., 0., 0. "
      "]\n";
  const std::string vector =
      "camera_matrix: !!opencv-matrix\n   rows: 9\n   cols: 1\n   dt: d\n   data: [ 1., 2. ]\n";
  EXPECT_THAT(error_of(head + vector + distortion),
              HasSubstr("camera.yaml:6: found 9 x 1 numbers, wanted 3 x 3"));
  EXPECT_THAT(error_of(head + distortion), HasSubstr("camera_matrix"));
  EXPECT_THAT(error_of("%YAML:1.0"), HasSubstr("camera.yaml:1"));
}

TEST(CameraFile, is_read_back_as_it_was_written) {
  Random random(4);
  const TemporaryFolder folder;
  for (CameraModel camera : cameras) {
    camera.fx_px *= random.uniform(0.9, 1.1);  // random in all digits
    camera.cy_px += random.uniform();
    const bool has_distortion = camera.distortion != Distortion::none;
    for (double& k : camera.coefficients) k *= has_distortion ? random.uniform(0.9, 1.1) : 0.0;
    save_camera(camera, "ceiling: #1", folder / "camera.yaml");
    const CameraModel back = load_camera(folder / "camera.yaml");
    EXPECT_EQ(back.width_px, camera.width_px);
    EXPECT_EQ(back.height_px, camera.height_px);
    EXPECT_EQ(back.fx_px, camera.fx_px);
    EXPECT_EQ(back.fy_px, camera.fy_px);
    EXPECT_EQ(back.cx_px, camera.cx_px);
    EXPECT_EQ(back.cy_px, camera.cy_px);
    EXPECT_EQ(back.distortion, camera.distortion);
    EXPECT_EQ(back.coefficients, camera.coefficients);
  }
}

TEST(CameraFile, keeps_the_keys_of_other_programs_and_warns_of_them) {
  const TemporaryFolder folder;
  const CameraFile read =
      read_camera_file(folder.write("camera.yaml", good + "iso: 100\nlens: {f_mm: 4.5}\n"));
  ASSERT_EQ(read.warnings.size(), 2U);
  EXPECT_THAT(read.warnings[0], HasSubstr("camera.yaml:7: the key 'iso' is not known here"));
  EXPECT_THAT(read.warnings[1], HasSubstr("camera.yaml:8: the key 'lens'"));

  save_camera(read.camera, "ceiling", folder / "saved.yaml", read.other_keys);
  const CameraFile back = read_camera_file(folder / "saved.yaml");
  EXPECT_EQ(back.other_keys, "iso: 100\nlens: {f_mm: 4.5}\n");
  EXPECT_EQ(back.camera.fx_px, read.camera.fx_px);
  EXPECT_TRUE(read_camera_file(folder.write("plain.yaml", good)).warnings.empty());
}

TEST(CameraFile, refuses_what_is_wrong_with_its_line) {
  EXPECT_EQ(error_of(good), "no error");
  EXPECT_THAT(error_of(with("image_width: 640", "image_width: 0")), HasSubstr("camera.yaml:1: found '0'"));
  EXPECT_THAT(error_of(with("[321,", "[-321,")), HasSubstr("camera.yaml:4: found focal lengths"));
  EXPECT_THAT(error_of(with("[321, 0,", "[321, 2,")), HasSubstr("camera.yaml:4: found a skew"));
  EXPECT_THAT(error_of(with("318.5", "1318.5")), HasSubstr("camera.yaml:4: found a principal point"));
  EXPECT_THAT(error_of(with("318.5", ".nan")), HasSubstr("camera.yaml:4: found '.nan'"));
  EXPECT_THAT(error_of(with("cols: 5", "cols: 4")), HasSubstr("camera.yaml:6: found 5 values"));
  EXPECT_THAT(error_of(with("plumb_bob", "equidistant")), HasSubstr("camera.yaml:6: found 5 values"));
  EXPECT_THAT(error_of(with("plumb_bob", "magic")), HasSubstr("camera.yaml:5: found 'magic'"));
  EXPECT_THAT(error_of("%YAML:1.0\n---\nimage_width: 640\n"),
              HasSubstr("camera.yaml:3: found no key 'image_height'"));
  EXPECT_THAT(error_of("%YAML:1.0\n---\n:[}"), HasSubstr("camera.yaml"));
}

}  // namespace
}  // namespace lodestar

#include "localization/pose/p3p.hpp"

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include "maps/marker.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

using Points = std::array<Vec3, 3>;

Points rays_to(const Eigen::Isometry3d& camera_from_points, const Points& points) {
  Points rays;
  for (std::size_t i = 0; i < 3; ++i) rays[i] = (camera_from_points * points[i]).normalized();
  return rays;
}

Vec3 random_vector(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

Eigen::Isometry3d random_view(Random& random, double tilt_rad, double distance_m, double aside_m) {
  Eigen::Isometry3d view = Eigen::Isometry3d::Identity();
  view.linear() = rotation_from({std::numbers::pi + random.uniform(-tilt_rad, tilt_rad),
                                 random.uniform(-tilt_rad, tilt_rad), random.uniform(-3.1, 3.1)});
  view.translation() = Vec3(random.uniform(-aside_m, aside_m), random.uniform(-aside_m, aside_m), distance_m);
  return view;
}

double distance(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

double nearest(const P3pSolutions& solutions, const Eigen::Isometry3d& truth) {
  double best = 1e9;
  for (const Eigen::Isometry3d& solution : solutions) best = std::min(best, distance(solution, truth));
  return best;
}

const Points marker{Vec3(0.0, 0.0, 0.0), Vec3(0.12, 0.0, 0.0), Vec3(0.0, 0.12, 0.0)};

bool shows_points_at(const Eigen::Isometry3d& camera_from_points, const Points& rays) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (((camera_from_points * marker[k]).normalized() - rays[k]).norm() > 1e-6) return false;
  }
  return true;
}

TEST(P3p, finds_the_truth_for_any_triangle) {
  Random random(1);
  int misses = 0;
  constexpr int trials = 5000;
  for (int i = 0; i < trials; ++i) {
    const Points points{random_vector(random, 1.0), random_vector(random, 1.0), random_vector(random, 1.0)};
    const Eigen::Isometry3d view = random_view(random, 3.0, random.uniform(2.0, 6.0), 1.0);
    misses += nearest(solve_p3p(rays_to(view, points), points), view) > 1e-4 ? 1 : 0;
  }
  EXPECT_LE(misses, trials / 1000);
}

TEST(P3p, finds_the_truth_below_a_ceiling_marker) {
  // A right-angled triangle of 12 cm seen nearly from below: two of the roots nearly coincide.
  Random random(2);
  int misses = 0;
  constexpr int trials = 5000;
  for (int i = 0; i < trials; ++i) {
    const Eigen::Isometry3d view = random_view(random, radians(5.0), random.uniform(1.5, 3.0), 0.7);
    misses += nearest(solve_p3p(rays_to(view, marker), marker), view) > 1e-3 ? 1 : 0;
  }
  EXPECT_LE(misses, trials / 500);
}

TEST(P3p, agrees_with_opencvs_ap3p) {
  Random random(3);
  int compared = 0;
  int missing = 0;
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Isometry3d view = random_view(random, radians(30.0), random.uniform(0.5, 3.0), 0.4);
    std::vector<cv::Point3d> object;
    std::vector<cv::Point2d> image;
    for (const Vec3& point : marker) {
      const Vec3 p = view * point;
      object.emplace_back(point.x(), point.y(), point.z());
      image.emplace_back(p.x() / p.z(), p.y() / p.z());
    }
    std::vector<cv::Mat> rotations;
    std::vector<cv::Mat> translations;
    cv::solveP3P(object, image, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), rotations, translations,
                 cv::SOLVEPNP_AP3P);
    const P3pSolutions ours = solve_p3p(rays_to(view, marker), marker);
    for (std::size_t k = 0; k < rotations.size(); ++k) {
      cv::Mat rotation;
      cv::Rodrigues(rotations[k], rotation);
      Eigen::Isometry3d theirs = Eigen::Isometry3d::Identity();
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
          theirs.linear()(row, column) = rotation.at<double>(row, column);
        theirs.translation()[row] = translations[k].at<double>(row);
      }
      if (!shows_points_at(theirs, rays_to(view, marker)))
        continue;  // some of their roots do not solve the problem
      ++compared;
      missing += nearest(ours, theirs) > 1e-2 ? 1 : 0;
    }
  }
  EXPECT_GT(compared, 1000);
  EXPECT_LE(missing, compared / 100);
}

TEST(P3p, gives_only_poses_that_show_the_points_where_they_are_seen) {
  Random random(4);
  int solutions = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Isometry3d view = random_view(random, radians(40.0), random.uniform(0.5, 3.0), 0.5);
    const Points rays = rays_to(view, marker);
    for (const Eigen::Isometry3d& solution : solve_p3p(rays, marker)) {
      ++solutions;
      EXPECT_TRUE(solution.matrix().allFinite());
      EXPECT_NEAR(solution.linear().determinant(), 1.0, 1e-9);
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_LT(((solution * marker[k]).normalized() - rays[k]).norm(), 1e-3);
    }
  }
  EXPECT_GT(solutions, 2000);
}

TEST(P3p, has_no_answer_for_points_on_a_line_or_equal_rays) {
  const Points line{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)};
  EXPECT_EQ(
      solve_p3p({Vec3(0, 0, 1), Vec3(0.1, 0, 1).normalized(), Vec3(0.2, 0, 1).normalized()}, line).count, 0U);
  for (const Eigen::Isometry3d& solution : solve_p3p({Vec3(0, 0, 1), Vec3(0, 0, 1), Vec3(0, 0, 1)}, marker)) {
    EXPECT_TRUE(solution.matrix().allFinite());
  }
}

}  // namespace
}  // namespace lodestar

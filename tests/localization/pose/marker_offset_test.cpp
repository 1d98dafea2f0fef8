#include "localization/pose/marker_offset.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "localization/pose/pose_fixer.hpp"
#include "maps/paper_camera.hpp"

#include "tests/localization/seen_markers.hpp"

// Markers that are not quite where the registry says.
namespace lodestar {
namespace {

constexpr double noise_px = 0.02;

PoseFixOptions exact_tilt() {
  PoseFixOptions options;
  options.prior.tilt_sigma_rad = 0.0;
  options.dot_sigma_px = noise_px;
  return options;
}

MarkerRegistry known_to(const MarkerSigma& sigma) {
  MarkerRegistry registry = ceiling();
  for (RegisteredMarker& marker : registry.markers) marker.sigma = sigma;
  return registry;
}

/// What hangs where this registry has been surveyed.
MarkerRegistry hung(const MarkerRegistry& surveyed, Random& random) {
  MarkerRegistry truth = surveyed;
  for (RegisteredMarker& marker : truth.markers) {
    const MarkerSigma sigma = marker.sigma.value_or(MarkerSigma{});
    marker.position_m += sigma.position_m * Vec3(random.normal(), random.normal(), 0.0);
    marker.yaw_rad += sigma.yaw_rad * random.normal();
  }
  return truth;
}

Eigen::Isometry3d some_view(Random& random) {
  return view_from({random.uniform(0.9, 1.5), random.uniform(1.7, 2.1), random.uniform(0.0, 0.5)},
                   random.uniform(-3.1, 3.1));
}

struct Errors {
  int fixes = 0;
  double nees = 0.0;  ///< sum, of four degrees of freedom
  /// Of x, y and yaw in frames without noise, by the shared covariance: three degrees of freedom. The height
  /// hardly depends on the offsets.
  double shared_nees = 0.0;
};

/// Normalized squared errors of fixes in many worlds.
Errors errors_in_worlds(const MarkerRegistry& surveyed, int worlds) {
  constexpr std::array free_axes{0, 1, 2, 5};
  constexpr std::array planar_axes{0, 1, 5};
  const auto nees = [&](const Vec6& error, const Eigen::Matrix<double, 6, 6>& covariance, const auto& axes) {
    const Eigen::VectorXd some = error(axes);
    const Eigen::MatrixXd of_some = covariance(axes, axes);
    return some.dot(of_some.ldlt().solve(some));
  };
  Random random(5);
  Errors errors;
  for (int i = 0; i < worlds; ++i) {
    const MarkerRegistry truth = hung(surveyed, random);
    const Eigen::Isometry3d view = some_view(random);
    const auto noisy = fix_pose({}, seen(view, truth, paper_camera(), noise_px, random), surveyed,
                                paper_camera(), exact_tilt());
    const auto quiet =
        fix_pose({}, seen(view, truth, paper_camera(), 0.0, random), surveyed, paper_camera(), exact_tilt());
    if (!noisy || !quiet) continue;
    ++errors.fixes;
    errors.nees += nees(error_of(*noisy, view), noisy->covariance, free_axes);
    errors.shared_nees += nees(error_of(*quiet, view), quiet->shared_covariance, planar_axes);
  }
  return errors;
}

class MarkerOffsets : public testing::TestWithParam<MarkerSigma> {};

TEST_P(MarkerOffsets, are_in_the_covariance_and_shared_by_all_frames) {
  constexpr int worlds = 1500;
  const Errors errors = errors_in_worlds(known_to(GetParam()), worlds);
  EXPECT_EQ(errors.fixes, worlds) << "markers that are where their sigmas allow were refused";
  // Four degrees of freedom: the mean of 1500 has a standard deviation of 0.07.
  EXPECT_NEAR(errors.nees / errors.fixes, 4.0, 0.3);
  EXPECT_NEAR(errors.shared_nees / errors.fixes, 3.0, 0.3);
}

INSTANTIATE_TEST_SUITE_P(, MarkerOffsets,
                         testing::Values(MarkerSigma{0.0005, radians(0.02)},  // a survey by driving
                                         MarkerSigma{0.003, radians(0.2)},    // by laser
                                         MarkerSigma{0.010, radians(1.0)},    // by tape
                                         MarkerSigma{0.0005, radians(0.02), radians(0.3)},
                                         MarkerSigma{0.003, radians(0.2), radians(0.3)}),
                         [](const auto& info) {
                           return "of_" + std::to_string(static_cast<int>(1e4 * info.param.position_m)) +
                                  "_tenths_of_a_millimetre_and_" +
                                  std::to_string(static_cast<int>(10.0 * degrees(info.param.tilt_rad))) +
                                  "_tenths_of_a_degree";
                         });

/// From 1.5 m below, of a marker that is tilted by a degree, by a camera known to be upright to 0.12 degrees;
/// root mean square of x and y over places up to 0.7 m aside.
double error_below_tilted_marker_m(double marker_tilt_sigma_rad) {
  constexpr int views = 200;
  MarkerRegistry exact = ceiling();
  exact.markers.resize(1);
  MarkerRegistry tilted = exact;
  tilted.markers.front().sigma = MarkerSigma{.tilt_rad = radians(1.0)};
  PoseFixOptions options;
  options.prior.tilt_sigma_rad = radians(0.12);
  options.prior.height_m = 1.1;
  options.dot_sigma_px = noise_px;
  options.marker_tilt_sigma_rad = marker_tilt_sigma_rad;
  Random random(3);
  double squared_m2 = 0.0;
  int fixes = 0;
  for (int i = 0; i < views; ++i) {
    const Eigen::Isometry3d view =
        view_from({random.uniform(0.5, 1.5), random.uniform(1.5, 2.5), 1.1}, random.uniform(-3.1, 3.1));
    const auto fix =
        fix_pose({}, seen(view, tilted, paper_camera(), noise_px, random), exact, paper_camera(), options);
    if (!fix) continue;
    ++fixes;
    squared_m2 += error_of(*fix, view).head<2>().squaredNorm();
  }
  return fixes > views / 2 ? std::sqrt(squared_m2 / fixes) : std::numeric_limits<double>::infinity();
}

TEST(MarkerOffset, of_a_tilt_is_not_taken_for_a_tilt_of_the_camera) {
  EXPECT_GT(error_below_tilted_marker_m(0.0), 0.008);
  EXPECT_LT(error_below_tilted_marker_m(radians(1.0)), 0.002);
}

/// Share of the markers in view that a fix uses, under a ceiling measured by tape.
double used_by_tape(const MarkerRegistry& registry) {
  constexpr int frames = 200;
  Random random(7);
  std::size_t used = 0;
  for (int i = 0; i < frames; ++i) {
    const MarkerRegistry truth = hung(known_to({0.010, radians(1.0)}), random);
    const auto markers = seen(some_view(random), truth, paper_camera(), noise_px, random);
    const auto fix = fix_pose({}, markers, registry, paper_camera(), exact_tilt());
    used += fix ? fix->ids.size() : 0U;
  }
  return static_cast<double>(used) / static_cast<double>(frames * registry.markers.size());
}

TEST(MarkerOffset, that_is_known_lets_markers_measured_by_tape_agree) {
  EXPECT_LT(used_by_tape(ceiling()), 0.8) << "places that count as exact contradict each other";
  EXPECT_EQ(used_by_tape(known_to({0.010, radians(1.0)})), 1.0);
}

TEST(MarkerOffset, beyond_its_sigma_is_a_displaced_marker) {
  Random random(9);
  MarkerRegistry surveyed = known_to({0.001, radians(0.05)});
  MarkerRegistry truth = surveyed;
  truth.markers[1].position_m.x() += 0.07;
  const Eigen::Isometry3d view = some_view(random);
  const auto fix = fix_pose({}, seen(view, truth, paper_camera(), noise_px, random), surveyed, paper_camera(),
                            exact_tilt());
  ASSERT_TRUE(fix);
  EXPECT_EQ(fix->ids.size(), 2u) << "the third contradicts the two others";
  EXPECT_EQ(std::ranges::count(fix->ids, truth.markers[1].id), 0);
  surveyed.markers.pop_back();
  truth.markers.pop_back();
  EXPECT_FALSE(fix_pose({}, seen(view, truth, paper_camera(), noise_px, random), surveyed, paper_camera(),
                        exact_tilt()))
      << "of two that contradict each other nobody knows which";
}

TEST(MarkerOffset, of_one_marker_alone_goes_into_its_fix) {
  Random random(11);
  MarkerRegistry surveyed = known_to({0.010, radians(1.0)});
  surveyed.markers.resize(1);
  MarkerRegistry exact = ceiling();
  exact.markers.resize(1);
  const Eigen::Isometry3d view = view_from({1.0, 2.0, 0.5}, 0.3);
  const auto markers = seen(view, exact, paper_camera(), 0.0, random);
  const auto fix = fix_pose({}, markers, surveyed, paper_camera(), exact_tilt());
  const auto sure = fix_pose({}, markers, exact, paper_camera(), exact_tilt());
  ASSERT_TRUE(fix && sure);
  EXPECT_LT((fix->map_from_camera.translation() - sure->map_from_camera.translation()).norm(), 1e-6);
  EXPECT_NEAR(std::sqrt(fix->covariance(0, 0)), 0.010, 0.001);
  EXPECT_NEAR(std::sqrt(fix->covariance(5, 5)), radians(1.0), radians(0.01));
}

}  // namespace
}  // namespace lodestar

#include "localization/pose/pose_fixer.hpp"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <stdexcept>

#include "tests/localization/painted_frame.hpp"
#include "tests/localization/seen_markers.hpp"

// What a fixer learns over frames: by how much the dots' true variance exceeds the stated one.
namespace lodestar {
namespace {

constexpr double said_px = 0.02;

class PoseFixerTest : public testing::Test {
 protected:
  /// Expected to be 4: the tilt is exact.
  double nees_of_fix(const Eigen::Isometry3d& view, double noise_px) {
    PoseFixOptions options;
    options.prior.tilt_sigma_rad = 0.0;
    options.dot_sigma_px = said_px;
    const PoseFix* const fix =
        fixer.fix(Stamp{}, seen(view, registry, paper_camera(), noise_px, random), options);
    if (fix == nullptr) throw std::runtime_error("no fix");
    sigma_m = std::sqrt(fix->covariance(0, 0));
    const std::array free_axes{0, 1, 2, 5};
    const Eigen::Vector4d error = error_of(*fix, view)(free_axes);
    const Eigen::Matrix4d covariance = fix->covariance(free_axes, free_axes);
    return error.dot(covariance.ldlt().solve(error));
  }

  Eigen::Isometry3d some_view() {
    return view_from({random.uniform(0.9, 1.5), random.uniform(1.7, 2.1), random.uniform(0.0, 0.5)},
                     random.uniform(-3.1, 3.1));
  }

  double mean_nees(int frames, double noise_px) {
    double sum = 0.0;
    for (int i = 0; i < frames; ++i) sum += nees_of_fix(some_view(), noise_px);
    return sum / frames;
  }

  Random random{1};
  MarkerRegistry registry = ceiling();
  PoseFixer fixer{registry, paper_camera()};
  double sigma_m = 0.0;  ///< of the last fix, along x
};

TEST_F(PoseFixerTest, learns_that_dots_are_farther_off_than_they_say) {
  EXPECT_GT(mean_nees(3, 2.0 * said_px), 1.5 * 4.0) << "nothing learned yet";
  mean_nees(500, 2.0 * said_px);
  EXPECT_NEAR(mean_nees(1000, 2.0 * said_px), 4.0, 0.4);
}

TEST_F(PoseFixerTest, is_no_surer_for_dots_that_fit_better_than_they_say) {
  const Eigen::Isometry3d view = some_view();
  nees_of_fix(view, 0.0);
  const double before_m = sigma_m;
  mean_nees(500, 0.5 * said_px);
  nees_of_fix(view, 0.0);
  EXPECT_NEAR(sigma_m, before_m, 1e-3 * before_m);
}

TEST_F(PoseFixerTest, learns_nothing_while_it_stands) {
  const Eigen::Isometry3d view = some_view();
  nees_of_fix(view, 0.0);
  const double before_m = sigma_m;
  const Random still = random;  // the same errors in all frames
  for (int i = 0; i < 500; ++i) {
    random = still;
    nees_of_fix(view, 3.0 * said_px);
  }
  random = still;
  nees_of_fix(view, 0.0);
  EXPECT_NEAR(sigma_m, before_m, 0.05 * before_m);
}

TEST_F(PoseFixerTest, learns_nothing_while_it_stands_and_evaluates_markers_in_turn) {
  // As the navigator does when a marker was displaced: the others together, then that marker alone.
  const Eigen::Isometry3d view = some_view();
  nees_of_fix(view, 0.0);
  const double before_m = sigma_m;
  PoseFixOptions options;
  options.prior.tilt_sigma_rad = 0.0;
  options.dot_sigma_px = said_px;
  const std::vector<DetectedMarker> noisy = seen(view, registry, paper_camera(), 3.0 * said_px, random);
  ASSERT_GE(noisy.size(), 3U);
  for (int i = 0; i < 500; ++i) {
    ASSERT_NE(fixer.fix(Stamp{}, std::span(noisy).first(noisy.size() - 1), options), nullptr);
    ASSERT_NE(fixer.fix(Stamp{}, std::span(noisy).last(1), options), nullptr);
  }
  nees_of_fix(view, 0.0);
  EXPECT_NEAR(sigma_m, before_m, 0.1 * before_m);
}

TEST_F(PoseFixerTest, unlearns_what_is_over) {
  mean_nees(500, 2.0 * said_px);
  const Eigen::Isometry3d view = some_view();
  nees_of_fix(view, 0.0);
  const double then_m = sigma_m;
  mean_nees(2000, said_px);
  nees_of_fix(view, 0.0);
  EXPECT_LT(sigma_m, 0.8 * then_m);
}

TEST_F(PoseFixerTest, one_wild_frame_teaches_little) {
  const Eigen::Isometry3d view = some_view();
  nees_of_fix(view, 0.0);
  const double before_m = sigma_m;
  nees_of_fix(some_view(), 40.0 * said_px);
  nees_of_fix(view, 0.0);
  EXPECT_LT(sigma_m, 1.3 * before_m);
}

}  // namespace
}  // namespace lodestar

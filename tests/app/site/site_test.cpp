#include "app/site/site.hpp"

#include <filesystem>
#include <gtest/gtest.h>

#include "app/navigation/navigation_setup.hpp"

namespace lodestar {
namespace {

Site lab() {
  return load_site(std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab");
}

TEST(Site, of_the_lab_is_the_papers) {
  const Site site = lab();
  EXPECT_EQ(site.map.map.columns, 306);
  EXPECT_EQ(site.map.map.rows, 150);
  EXPECT_DOUBLE_EQ(site.map.map.resolution_m, 0.05);
  EXPECT_TRUE(site.map.warnings.empty());
  EXPECT_NEAR(site.cameras.at("paper").fx_px, 755.139, 1e-9);
  EXPECT_GE(site.registry.markers.size(), 10U);
  for (const RegisteredMarker& marker : site.registry.markers) {
    EXPECT_NEAR(marker.position_m.z() - site.robot.base_from_camera.translation().z(), 1.5, 0.05)
        << marker.id;
  }
}

TEST(Site, mount_becomes_the_prior_of_the_pose_estimate) {
  const Site site = lab();
  const PosePrior prior = navigation_options(site.robot).fix.prior;
  const Eigen::Matrix3d untilted =
      prior.tilt *
      rotation_from({site.robot.camera_mount.roll_rad, site.robot.camera_mount.pitch_rad, 0.0}).transpose();
  EXPECT_TRUE(untilted.isIdentity(1e-12));
  EXPECT_NEAR(*prior.height_m, 1.1, 0.05);
}

TEST(Site, names_its_camera_and_its_base) {
  const Site site = lab();
  EXPECT_EQ(site.camera, "simulated");
  ASSERT_TRUE(site.base);
  EXPECT_EQ(site.base->interface, "vcan0");
  EXPECT_EQ(site.base->protocol, "agilex");
}

}  // namespace
}  // namespace lodestar

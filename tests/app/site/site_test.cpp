#include "app/site/site.hpp"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <iterator>
#include <sstream>

#include "app/navigation/navigation_setup.hpp"
#include "maps/input_error.hpp"
#include "maps/paper_camera.hpp"

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

Site lab() {
  return load_site(std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab");
}

TEST(Site, names_its_cameras_as_it_likes_and_warns_of_keys_of_other_programs) {
  const TemporaryFolder folder;
  const fs::path site = folder / "site";
  fs::copy(fs::path(LODESTAR_SOURCE_DIR) / "sites/lab", site, fs::copy_options::recursive);
  const auto replace = [&](const char* file, const std::string& piece, const std::string& by) {
    std::ostringstream text;
    text << std::ifstream(site / file).rdbuf();
    std::string content = text.str();
    const std::size_t at = content.find(piece);
    ASSERT_NE(at, std::string::npos) << piece;
    std::ofstream(site / file) << content.replace(at, piece.size(), by);
  };
  replace("site.yaml", "wide:", "ceiling-2:");
  replace("site.yaml", "default_camera: wide", "default_camera: ceiling-2");
  replace("camera.yaml", "image_width:", "lens_serial: A7\nimage_width:");

  const Site read = load_site(site);
  EXPECT_TRUE(read.cameras.contains("ceiling-2"));
  ASSERT_EQ(read.map.warnings.size(), 1U);
  EXPECT_THAT(read.map.warnings.front(), ::testing::HasSubstr("the key 'lens_serial' is not known here"));

  replace("site.yaml", "ceiling-2:", "'../wide':");
  EXPECT_THROW((void)load_site(site), InputError);
}

TEST(Site, charges_at_a_place_with_a_heading_at_a_speed_that_its_motors_can_drive) {
  const TemporaryFolder folder;
  const fs::path site = folder / "site";
  fs::copy(fs::path(LODESTAR_SOURCE_DIR) / "sites/lab", site, fs::copy_options::recursive);
  std::ofstream(site / places_file_name)
      << "format: lodestar-places\nversion: 1\nplaces:\n"
         "  - {name: dock, x_m: 1, y_m: 5.6, yaw_deg: 180}\n  - {name: desk, x_m: 2, y_m: 5.6}\n";
  std::ostringstream usual;
  usual << std::ifstream(site / "site.yaml").rdbuf();
  const auto read = [&](const std::string& charging) {
    std::ofstream(site / "site.yaml") << usual.str() << "charging: " << charging << "\n";
    return load_site(site).charging;
  };
  const std::optional<ChargingSettings> charging =
      read("{place: dock, full_v: 29, low_v: 24, approach_m: 0.4}");
  ASSERT_TRUE(charging);
  EXPECT_NEAR(approach_pose(*charging).position_m.x(), 1.4, 1e-12);
  EXPECT_EQ(charging->low_v, 24.0);
  for (const auto& [wrong, words] : std::vector<std::pair<std::string, std::string>>{
           {"{place: desk, full_v: 29}", "site.yaml:15: found 'desk'"},
           {"{place: nowhere, full_v: 29}", "found 'nowhere'"},
           {"{place: dock}", "found no key 'full_v' in charging"},
           {"{place: dock, full_v: 29, low_v: 29.5}", "found 29.5 V, wanted less than full_v"},
           {"{place: dock, full_v: 29, speed: 1}", "speed"}}) {
    try {
      (void)read(wrong);
      ADD_FAILURE() << wrong;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr(words));
    }
  }
}

TEST(Site, has_the_places_beside_it_and_no_zone_that_its_motors_cannot_obey) {
  const TemporaryFolder folder;
  fs::copy(fs::path(LODESTAR_SOURCE_DIR) / "sites/lab", folder / "site", fs::copy_options::recursive);
  Places places{.places = {{"desk", {2.5, 5.0}, std::nullopt}},
                .keep_out = {{"", {{9.0, 2.0}, {10.0, 2.0}, {10.0, 3.0}}}},
                .speed_zones = {{"ward", {{5.0, 0.0}, {8.0, 0.0}, {8.0, 7.5}}, 0.03}}};
  save_places(places, folder / "site");
  const Site site = load_site(folder / "site");
  EXPECT_EQ(places_text(site.places), places_text(places));
  EXPECT_EQ(site.map.map.at(site.map.map.cell_at({9.8, 2.2})), OccupancyMap::free);
  const OccupancyMap drivable = drivable_map(site);
  EXPECT_EQ(drivable.at(drivable.cell_at({9.8, 2.2})), OccupancyMap::occupied);

  std::string robot = folder.read("site/robot.yaml");
  const std::string piece = "dead_band_mps: 0.02";
  folder.write("site/robot.yaml", robot.replace(robot.find(piece), piece.size(), "dead_band_mps: 0.05"));
  try {
    (void)load_site(folder / "site");
    FAIL() << "slower than the motors can";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("found max_mps 0.03 of speed zone 'ward'"));
  }
}

TEST(Site, of_a_folder_with_a_map_alone_is_not_there_and_what_makes_one_is_named) {
  const TemporaryFolder folder;
  std::ofstream(folder / "map.yaml") << "image: map.pgm\n";
  try {
    load_site(folder.path());
    ADD_FAILURE() << "took it for a site";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                testing::HasSubstr(": found no site.yaml, wanted a site folder; `lodestar site new"));
  }
}

TEST(Site, of_the_lab_is_the_papers) {
  const Site site = lab();
  EXPECT_EQ(site.map.map.columns, 306);
  EXPECT_EQ(site.map.map.rows, 150);
  EXPECT_DOUBLE_EQ(site.map.map.resolution_m, 0.05);
  EXPECT_TRUE(site.map.warnings.empty());
  const CameraModel paper = site.cameras.at("paper");
  EXPECT_EQ(paper.width_px, paper_camera().width_px);
  EXPECT_EQ(paper.height_px, paper_camera().height_px);
  EXPECT_EQ(paper.fx_px, paper_camera().fx_px);
  EXPECT_EQ(paper.fy_px, paper_camera().fy_px);
  EXPECT_EQ(paper.cx_px, paper_camera().cx_px);
  EXPECT_EQ(paper.cy_px, paper_camera().cy_px);
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

/// The lab's robot file with other last lines, which describe the base.
Robot robot_with(const std::string& base) {
  const std::filesystem::path lab = std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab";
  std::ifstream stream(lab / "robot.yaml");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const TemporaryFolder folder;
  return load_robot(folder.write("robot.yaml", text.substr(0, text.find("motors:")) + base));
}

TEST(Site, robot_of_another_base_drives_and_rolls_by_its_file) {
  const NavigationOptions options =
      navigation_options(robot_with("motors: {response_s: 0.3, dead_band_mps: 0.05, dead_band_radps: 0.1}\n"
                                    "wheels: {encoder_step_m: 0.0004, noise_m_per_sqrt_m: 0.006}\n"));
  EXPECT_EQ(options.drive.response_s, 0.3);
  EXPECT_EQ(options.drive.min_forward_mps, 0.05);
  EXPECT_EQ(options.drive.min_turn_radps, 0.1);
  EXPECT_EQ(options.filter.wheel_step_m, 0.0004);
  EXPECT_EQ(options.filter.wheel_noise_m_per_sqrt_m, 0.006);
}

TEST(Site, robot_slower_than_the_usual_dead_band_has_a_smaller_one) {
  Robot robot = lab().robot;
  robot.dead_band_mps.reset();
  robot.dead_band_radps.reset();
  robot.max_forward_mps = 0.015;
  robot.max_turn_radps = 0.05;
  const NavigationOptions options = navigation_options(robot);
  EXPECT_LE(options.drive.min_forward_mps, options.drive.max_forward_mps);
  EXPECT_LE(options.drive.min_turn_radps, options.drive.max_turn_radps);
}

TEST(Site, robot_that_says_nothing_of_its_base_has_one_like_the_labs) {
  const NavigationOptions silent = navigation_options(robot_with(""));
  const NavigationOptions spoken = navigation_options(lab().robot);
  EXPECT_EQ(silent.drive.response_s, spoken.drive.response_s);
  EXPECT_EQ(silent.drive.min_forward_mps, spoken.drive.min_forward_mps);
  EXPECT_EQ(silent.drive.min_turn_radps, spoken.drive.min_turn_radps);
  EXPECT_EQ(silent.filter.wheel_step_m, spoken.filter.wheel_step_m);
  EXPECT_EQ(silent.filter.wheel_noise_m_per_sqrt_m, spoken.filter.wheel_noise_m_per_sqrt_m);
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

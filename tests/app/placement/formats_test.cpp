#include "app/placement/formats.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "maps/input_error.hpp"
#include "maps/marker.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

using ::testing::HasSubstr;

class Format : public ::testing::TestWithParam<std::string> {};

/// Markers spread out, in all directions, in a registry rotated on the map.
MarkerRegistry askew_registry() {
  MarkerRegistry registry;
  registry.map_from_registry = {{3.0, -2.0}, radians(33.0)};
  for (int i = 0; i < 37; ++i) {
    const double yaw_deg = -180.0 + 10.0 * i;
    registry.markers.push_back({100 * i + 7, {0.37 * i, 20.0 - 1.1 * i, 2.6 + 0.01 * i}, radians(yaw_deg)});
  }
  return registry;
}

std::string error_of(const std::string& text, MarkerFormat format) {
  try {
    (void)parse_markers(text, format, "theirs");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST_P(Format, gives_back_every_pose_on_the_map) {
  const MarkerFormat format = *marker_format_named(GetParam());
  const MarkerRegistry ours = askew_registry();

  const MarkerRegistry back = parse_markers(markers_text(ours, format), format, "theirs");

  ASSERT_EQ(back.markers.size(), ours.markers.size());
  for (std::size_t i = 0; i < ours.markers.size(); ++i) {
    EXPECT_EQ(back.markers[i].id, ours.markers[i].id);
    const Eigen::Isometry3d left =
        map_from_marker(back, back.markers[i]).inverse() * map_from_marker(ours, ours.markers[i]);
    EXPECT_TRUE(left.matrix().isIdentity(1e-9)) << left.matrix();
  }
}

TEST_P(Format, refuses_noise_with_words) {
  const MarkerFormat format = *marker_format_named(GetParam());
  for (const char* noise : {"{", "a: [", "\x01\x02", "[1, 2]", "1 2 3", "\"x\""}) {
    EXPECT_THAT(error_of(noise, format), HasSubstr("theirs")) << noise;
  }
}

INSTANTIATE_TEST_SUITE_P(MarkerFormats, Format, ::testing::ValuesIn(marker_format_names()),
                         [](const auto& format) { return format.param; });

// The pose that the KIT localizer's own sample gives to a marker that looks down: pi about (1, -1, 0).
TEST(MarkerFormats, read_a_stargazer_landmark_that_looks_down) {
  const MarkerRegistry registry = parse_markers(
      "CameraIntrinsics: {fu: 1, fv: 1, u0: 1, v0: 1}\nLandmarks:\n"
      "- { HexID: 0x0016, x: 2.4, y: 0.6, z: 3.3, rx: 2.221441469, ry: -2.221441469, rz: 0 }\n",
      MarkerFormat::stargazer, "stargazer.yaml");
  ASSERT_EQ(registry.markers.size(), 1U);
  EXPECT_EQ(registry.markers[0].id, 0x16);
  EXPECT_NEAR(registry.markers[0].yaw_rad, radians(-90.0), 1e-8);
  EXPECT_TRUE(registry.markers[0].position_m.isApprox(Vec3(2.4, 0.6, 3.3), 1e-12));
}

// A field layout's tag with pitch 90 degrees looks down, its top towards the field's x, its right towards y.
TEST(MarkerFormats, read_a_field_tag_that_looks_down) {
  const double h = std::sqrt(0.5);
  const std::string text =
      R"({"tags":[{"ID":5,"pose":{"translation":{"x":1,"y":2,"z":3},"rotation":{"quaternion":{"W":)" +
      std::to_string(h) + R"(,"X":0,"Y":)" + std::to_string(h) +
      R"(,"Z":0}}}}],"field":{"length":16,"width":8}})";
  const MarkerRegistry registry = parse_markers(text, MarkerFormat::apriltag, "field.json");
  ASSERT_EQ(registry.markers.size(), 1U);
  EXPECT_NEAR(registry.markers[0].yaw_rad, radians(90.0), 1e-6);
  // The centre is 6 cm along the marker's x (map y) and 6 cm along its y (yaw - 90: map x) from O.
  EXPECT_TRUE(registry.markers[0].position_m.isApprox(Vec3(0.94, 1.94, 3.0), 1e-6));
}

TEST(MarkerFormats, take_a_spreadsheet_with_other_columns) {
  const MarkerRegistry registry =
      parse_markers("\xEF\xBB\xBFname,id,z_m,y_m,x_m,yaw_deg,size\r\n\"door\",9,2.6,2,1,90,0.12\r\n\r\n",
                    MarkerFormat::csv, "s.csv");
  ASSERT_EQ(registry.markers.size(), 1U);
  EXPECT_EQ(registry.markers[0].id, 9);
  EXPECT_TRUE(registry.markers[0].position_m.isApprox(Vec3(1, 2, 2.6), 1e-12));
}

TEST(MarkerFormats, take_a_spreadsheet_with_semicolons_or_tabs_and_decimal_commas) {
  for (const std::string text : {"id;x_m;y_m;z_m;yaw_deg\r\n9;1,5;-2,25;2,6;90\r\n10;1.5;2;2.6;0\r\n",
                                 "id\tx\ty\tz\tyaw_deg\n9\t1,5\t-2,25\t2,6\t90\n10\t1.5\t2\t2.6\t0\n"}) {
    const MarkerRegistry registry = parse_markers(text, MarkerFormat::csv, "s.csv");
    ASSERT_EQ(registry.markers.size(), 2U) << text;
    EXPECT_TRUE(registry.markers[0].position_m.isApprox(Vec3(1.5, -2.25, 2.6), 1e-12));
    EXPECT_TRUE(registry.markers[1].position_m.isApprox(Vec3(1.5, 2, 2.6), 1e-12));
  }
  // What may mean thousands is no number.
  EXPECT_THAT(error_of("id;x;y;z;yaw_deg\n9;1.000,5;2;2,6;90\n", MarkerFormat::csv),
              HasSubstr("theirs:2: found '1.000,5'"));
}

TEST(MarkerFormats, refuse_what_hangs_on_no_ceiling_and_ids_that_are_not) {
  EXPECT_THAT(error_of("9 1 2 3 90 0 0 0 1\n", MarkerFormat::fiducial_slam),
              HasSubstr("theirs:1: found marker 9"));
  EXPECT_THAT(error_of("id,x,y,z,yaw_deg\n4096,0,0,0,0\n", MarkerFormat::csv),
              HasSubstr("theirs:2: found ID 4096"));
  EXPECT_THAT(error_of("id,x,y,z,yaw_deg\n1,0,0,0,0\n1,0,0,0,0\n", MarkerFormat::csv),
              HasSubstr("theirs:3: found marker 1 again"));
  EXPECT_THAT(error_of("id,x,y,z,yaw_deg\n1,0,nan,0,0\n", MarkerFormat::csv), HasSubstr("theirs:2"));
  EXPECT_THAT(error_of("id,x,y,z\n", MarkerFormat::csv), HasSubstr("no column 'yaw_deg'"));
}

TEST(MarkerFormats, are_told_by_the_name_of_the_file) {
  EXPECT_EQ(guess_marker_format("a.yaml", "format: lodestar-markers"), MarkerFormat::lodestar);
  EXPECT_EQ(guess_marker_format("a.yaml", "Landmarks:\n"), MarkerFormat::stargazer);
  EXPECT_EQ(guess_marker_format("map.txt", ""), MarkerFormat::fiducial_slam);
  EXPECT_EQ(guess_marker_format("a.json", "{\"type\": \"FeatureCollection\"}"), MarkerFormat::geojson);
  EXPECT_EQ(guess_marker_format("a", ""), std::nullopt);
}

}  // namespace
}  // namespace lodestar

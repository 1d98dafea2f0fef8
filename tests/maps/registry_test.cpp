#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "maps/input_error.hpp"
#include "maps/marker.hpp"
#include "maps/marker_registry.hpp"

#include "tests/maps/spoilt_file.hpp"
#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

using ::testing::HasSubstr;

const std::string good =
    "format: lodestar-markers\nversion: 1\nalignment: {x_m: 0.5, y_m: -0.25, yaw_deg: 90}\nmarkers:\n"
    "  - {id: 447, x_m: 1.2, y_m: 3.4, z_m: 2.6, yaw_deg: 90}\n"
    "  - {id: 1782, x_m: 2, y_m: 3.4, z_m: 2.6, yaw_deg: -45.5}\n";

std::string error_of(const std::string& text) {
  return error_of("markers.yaml", text, load_registry);
}

std::string with(const std::string& piece, const std::string& by) {
  return lodestar::with(good, piece, by);
}

/// The ID of a pattern of coded dots, by a matrix of ones and zeros as in Eq. (9).
int id_of(const std::array<std::array<int, 4>, 4>& w) {
  int id = 0;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      id += w[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] * id_bit({row, column});
    }
  }
  return id;
}

TEST(MarkerCode, gives_447_for_the_printed_w_and_1782_for_the_sample) {
  EXPECT_EQ(id_of({{{0, 1, 0, 0}, {1, 1, 1, 0}, {1, 1, 1, 0}, {0, 1, 0, 0}}}), 447);
  EXPECT_EQ(id_of({{{0, 1, 1, 0}, {1, 1, 0, 0}, {0, 0, 1, 1}, {0, 1, 1, 0}}}), 1782);
}

TEST(MarkerCode, has_all_bits_once_and_three_to_fifteen_dots) {
  int bits = 0;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      EXPECT_EQ(bits & id_bit({row, column}), 0);
      bits |= id_bit({row, column});
    }
  }
  EXPECT_EQ(bits, 0xFFF);
  EXPECT_EQ(dots_of(0).size(), 3U);
  EXPECT_EQ(dots_of(4095).size(), 15U);
  EXPECT_FALSE(has_dot(4095, cell_always_empty));
}

TEST(MarkerRegistry, places_markers_face_down) {
  MarkerRegistry registry;
  registry.markers.push_back({.id = 1, .position_m = {1.0, 2.0, 2.6}, .yaw_rad = 0.0});
  const Eigen::Isometry3d pose = map_from_marker(registry, registry.markers[0]);
  EXPECT_TRUE((pose * Vec3(0.12, 0.0, 0.0)).isApprox(Vec3(1.12, 2.0, 2.6))) << "X to the east";
  EXPECT_TRUE((pose * Vec3(0.0, 0.12, 0.0)).isApprox(Vec3(1.0, 1.88, 2.6))) << "Y to the south";
  EXPECT_TRUE((pose.linear().col(2)).isApprox(Vec3(0.0, 0.0, -1.0)));
  EXPECT_NEAR(pose.linear().determinant(), 1.0, 1e-12);
}

TEST(MarkerRegistry, is_aligned_to_the_map_as_a_whole) {
  const TemporaryFolder folder;
  const MarkerRegistry registry = load_registry(folder.write("m.yaml", good));
  const Eigen::Isometry3d pose = map_from_marker(registry, *registry.find(447));
  EXPECT_TRUE(pose.translation().isApprox(Vec3(0.5 - 3.4, -0.25 + 1.2, 2.6)));
  EXPECT_NEAR(std::abs(flattened(pose).yaw_rad), std::numbers::pi, 1e-12);
}

TEST(MarkerRegistry, find_does_not_guess_between_two) {
  MarkerRegistry registry;
  registry.markers = {{.id = 5}, {.id = 6}, {.id = 5}};
  EXPECT_EQ(registry.find(5), nullptr);
  EXPECT_EQ(registry.find(7), nullptr);
  EXPECT_EQ(registry.find(6), &registry.markers[1]);
}

TEST(RegistryFile, is_written_one_marker_a_line_as_it_was_read) {
  const TemporaryFolder folder;
  const MarkerRegistry registry = load_registry(folder.write("m.yaml", good));
  save_registry(registry, folder / "saved.yaml");
  EXPECT_EQ(folder.read("saved.yaml"), good);
  save_registry(MarkerRegistry{}, folder / "empty.yaml");
  EXPECT_TRUE(load_registry(folder / "empty.yaml").markers.empty());
  EXPECT_THROW(save_registry(registry, folder / "no/such/folder.yaml"), InputError);
}

TEST(RegistryFile, refuses_what_is_wrong_with_its_line) {
  EXPECT_EQ(error_of(good), "no error");
  EXPECT_THAT(error_of(with("id: 447", "id: 4096")), HasSubstr("markers.yaml:5: found '4096'"));
  EXPECT_THAT(error_of(with("id: 447", "id: -1")), HasSubstr("markers.yaml:5: found '-1'"));
  EXPECT_THAT(error_of(with("id: 447", "id: 4.5")), HasSubstr("markers.yaml:5: found '4.5'"));
  EXPECT_THAT(error_of(with("id: 1782", "id: 447")), HasSubstr("markers.yaml:6: found marker 447 again"));
  EXPECT_THAT(error_of(with("x_m: 1.2", "x_m: 1.2m")), HasSubstr("markers.yaml:5: found '1.2m'"));
  EXPECT_THAT(error_of(with("x_m: 1.2", "x_m: true")), HasSubstr("markers.yaml:5: found 'true'"));
  EXPECT_THAT(error_of(with("x_m: 1.2", "x_m: \"1.2\"")), HasSubstr("markers.yaml:5: found '1.2'"));
  EXPECT_THAT(error_of(with("x_m: 1.2", "x_m: .inf")), HasSubstr("markers.yaml:5: found '.inf'"));
  EXPECT_THAT(error_of(with("x_m: 1.2", "x_m: ")), HasSubstr("markers.yaml:5: found"));
  EXPECT_THAT(error_of(with("x_m: 1.2, ", "")), HasSubstr("markers.yaml:5: found no key 'x_m'"));
  EXPECT_THAT(error_of(with("x_m: 1.2", "x_m: 1.2, x_m: 3")),
              HasSubstr("markers.yaml:5: found a second key 'x_m'"));
  EXPECT_THAT(error_of(with("yaw_deg: -45.5", "yaw_deg: 0, note: hi")),
              HasSubstr("markers.yaml:6: found unknown key 'note'"));
  EXPECT_THAT(error_of(with("version: 1", "version: 2")), HasSubstr("markers.yaml:2: found '2'"));
  EXPECT_THAT(error_of(with("lodestar-markers", "other")), HasSubstr("markers.yaml:1: found 'other'"));
  EXPECT_THAT(error_of(with("markers:\n", "marker:\n")), HasSubstr("found no key 'markers'"));
  EXPECT_THAT(error_of(with("  - {id: 447", "  - [id: 447")), HasSubstr("markers.yaml:5: found broken YAML"));
  EXPECT_THAT(error_of("\t\n"), HasSubstr("markers.yaml:"));
  EXPECT_THAT(error_of(", y\n"),
              HasSubstr("markers.yaml:"));  // yaml-cpp reads empty documents from it forever
  EXPECT_THAT(error_of("markers: 3\n"), HasSubstr("markers.yaml:1: found no key 'format'"));
  EXPECT_THAT(error_of(good + "---\nmore: 1\n"), HasSubstr("a second document"));
}

}  // namespace
}  // namespace lodestar

#include "maps/map_file.hpp"

#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "maps/input_error.hpp"
#include "maps/random.hpp"

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::int8_t unknown = OccupancyMap::unknown;

const std::string good_yaml =
    "image: m.pgm\nmode: trinary\nresolution: 0.05\norigin: [1.0, -2.0, 0.5]\nnegate: 0\noccupied_thresh: "
    "0.65\nfree_thresh: 0.196\n";

std::string replaced(std::string text, const std::string& piece, const std::string& by) {
  const std::size_t at = text.find(piece);
  EXPECT_NE(at, std::string::npos) << piece;
  return text.replace(at, piece.size(), by);
}

class MapFile : public ::testing::Test {
 protected:
  LoadedMap load(const std::string& yaml, const std::string& image, const std::string& image_name = "m.pgm") {
    folder_.write("m.yaml", yaml);
    folder_.write(image_name, image);
    return load_map(folder_ / "m.yaml");
  }

  std::string error_of(const std::string& yaml, const std::string& image) {
    try {
      (void)load(yaml, image);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  TemporaryFolder folder_;
};

/// Two rows of three pixels; the upper one is the grid's last.
const std::string small_pgm =
    std::string("P5\n# a comment\n3 2\n255\n") + '\xfe' + '\x00' + '\xcd' + '\x00' + '\xfe' + '\xfe';

TEST_F(MapFile, reads_pgm_bottom_row_first) {
  const LoadedMap loaded = load(good_yaml, small_pgm);
  EXPECT_THAT(loaded.map.cells, ElementsAre(100, 0, 0, 0, 100, unknown));
  EXPECT_EQ(loaded.map.columns, 3);
  EXPECT_EQ(loaded.map.map_from_grid.position_m, Vec2(1.0, -2.0));
  EXPECT_EQ(loaded.map.map_from_grid.yaw_rad, 0.5);
  EXPECT_TRUE(loaded.warnings.empty());
}

TEST_F(MapFile, reads_plain_pgm_and_16_bits) {
  EXPECT_THAT(load(good_yaml, "P2 # plain\n3 2 255\n254 0 205\n0 254 254\n").map.cells,
              ElementsAre(100, 0, 0, 0, 100, unknown));
  EXPECT_THAT(load(good_yaml, std::string("P5 2 1 65535\n") + '\xff' + '\xff' + '\x00' + '\x00').map.cells,
              ElementsAre(0, 100));
}

TEST_F(MapFile, negates_scales_and_reads_raw) {
  const std::string image = "P2 4 1 255\n0 102 127 255\n";
  EXPECT_THAT(load(replaced(good_yaml, "negate: 0", "negate: 1"), image).map.cells,
              ElementsAre(0, unknown, unknown, 100));
  const auto scaled = load(replaced(good_yaml, "trinary", "scale"), image).map.cells;
  EXPECT_EQ(scaled[0], 100);
  EXPECT_EQ(scaled[1], 89);  // (0.6 - 0.196) / (0.65 - 0.196)
  EXPECT_EQ(scaled[3], 0);
  EXPECT_THAT(load(replaced(good_yaml, "trinary", "raw"), "P2 4 1 255\n0 42 100 101\n").map.cells,
              ElementsAre(0, 42, 100, unknown));
}

TEST_F(MapFile, transparent_pixels_are_unknown) {
  cv::Mat picture(1, 3, CV_8UC4, cv::Scalar(255, 255, 255, 255));
  picture.at<cv::Vec4b>(0, 1) = {0, 0, 0, 255};
  picture.at<cv::Vec4b>(0, 2) = {255, 255, 255, 10};
  cv::imwrite((folder_ / "m.png").string(), picture);
  folder_.write("m.yaml", replaced(good_yaml, "m.pgm", "m.png"));
  EXPECT_THAT(load_map(folder_ / "m.yaml").map.cells, ElementsAre(0, 100, unknown));
}

TEST_F(MapFile, warns_when_a_savers_unknown_would_be_free) {
  const LoadedMap loaded = load(replaced(good_yaml, "free_thresh: 0.196", "free_thresh: 0.25"), small_pgm);
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_THAT(loaded.warnings[0], HasSubstr("205"));
}

// Other programs write keys of their own: Nav2's test map has a map_type.
TEST_F(MapFile, warns_of_keys_of_other_programs_and_keeps_them) {
  const LoadedMap loaded =
      load(replaced(good_yaml, "negate: 0", "negate: 0\nmap_type: occupancy\nlayers: [a, b]"), small_pgm);
  ASSERT_EQ(loaded.warnings.size(), 2U);
  EXPECT_THAT(loaded.warnings[0], HasSubstr("m.yaml:6: the key 'map_type'"));
  save_map(loaded.map, folder_ / "saved.yaml", loaded.info.other_keys);
  const LoadedMap back = load_map(folder_ / "saved.yaml");
  EXPECT_EQ(back.info.other_keys, "map_type: occupancy\nlayers: [a, b]\n");
  EXPECT_EQ(back.map.cells, loaded.map.cells);
}

TEST_F(MapFile, takes_no_image_of_another_map_in_the_folder) {
  const OccupancyMap kept = load(good_yaml, small_pgm).map;
  save_map(kept, folder_ / "map.yaml");
  OccupancyMap other = kept;
  other.cells.assign(other.cells.size(), 0);
  for (int i = 0; i < 3; ++i) save_map(other, folder_ / "map.yml");
  EXPECT_EQ(load_map(folder_ / "map.yaml").map.cells, kept.cells);
  EXPECT_EQ(load_map(folder_ / "map.yml").map.cells, other.cells);
}

TEST_F(MapFile, refuses_bad_keys_with_their_line) {
  const auto error = [&](const std::string& piece, const std::string& by) {
    return error_of(replaced(good_yaml, piece, by), small_pgm);
  };
  EXPECT_THAT(error("resolution: 0.05", "resolution: 0"), HasSubstr("m.yaml:3: found"));
  EXPECT_THAT(error("resolution: 0.05", "resolution: 0.05m"), HasSubstr("m.yaml:3: found '0.05m'"));
  EXPECT_THAT(error("resolution", "resolutoin"), HasSubstr("m.yaml:1: found no key 'resolution'"));
  EXPECT_THAT(error("origin: [1.0, -2.0, 0.5]", "origin: [1.0, -2.0]"),
              HasSubstr("m.yaml:4: found 2 values"));
  EXPECT_THAT(error("-2.0", ".nan"), HasSubstr("m.yaml:4: found '.nan'"));
  EXPECT_THAT(error("0.5]", "-nan]"), HasSubstr("m.yaml:4: found '-nan'"));
  EXPECT_THAT(error("trinary", "binary"), HasSubstr("m.yaml:2: found 'binary'"));
  EXPECT_THAT(error("negate: 0", "negate: 2"), HasSubstr("m.yaml:5: found '2'"));
  EXPECT_THAT(error("occupied_thresh: 0.65", "occupied_thresh: 65"), HasSubstr("m.yaml:6: found"));
  EXPECT_THAT(error("free_thresh: 0.196", "free_thresh: 0.9"), HasSubstr("m.yaml:7: found"));
  EXPECT_THAT(error("negate: 0", "negate: 0\nnegate: 0"), HasSubstr("m.yaml:6: found a second key 'negate'"));
  EXPECT_THAT(error("m.pgm", "n.pgm"), HasSubstr("m.yaml:1: found"));
  EXPECT_THAT(error_of("", small_pgm), HasSubstr("m.yaml:1: found nothing"));
  EXPECT_THAT(error_of("- a\n- b\n", small_pgm), HasSubstr("m.yaml:1: found a list"));
  EXPECT_THAT(error_of("image: [\n", small_pgm), HasSubstr("broken YAML"));
}

TEST_F(MapFile, refuses_broken_images_with_a_reason) {
  for (const std::string& image :
       {std::string(), std::string("P5"), std::string("P5\n3 2\n255\nab"), std::string("P5\n0 2\n255\n"),
        std::string("P5\n-3 2\n255\n"), std::string("P5\n3 2\n0\nabcdef"),
        std::string("P5\n3 2\n70000\nabcdef"), std::string("P5\n99999999999 2\n255\n"),
        std::string("P5\n30000 30000\n255\nabc"), std::string("P2\n3 1\n255\n1 2"),
        std::string("P2\n3 1\n255\n1 2 256"), std::string("\x89PNG\r\n\x1a\n broken"),
        std::string("BM broken")}) {
    EXPECT_THAT(error_of(good_yaml, image), HasSubstr("m.yaml:1: found")) << image;
  }
}

TEST_F(MapFile, saves_without_losing_anything) {
  Random random(1);
  for (const bool trinary : {true, false}) {
    for (int trial = 0; trial < 20; ++trial) {
      OccupancyMap map;
      map.columns = 1 + static_cast<int>(random.below(20));
      map.rows = 1 + static_cast<int>(random.below(20));
      map.resolution_m = random.uniform(0.0125, 0.1);
      map.map_from_grid = {{random.uniform(-9.0, 9.0), random.uniform(-9.0, 9.0)}, random.uniform(-3.0, 3.0)};
      for (int i = 0; i < map.columns * map.rows; ++i) {
        const int value = static_cast<int>(random.below(trinary ? 3 : 102));
        map.cells.push_back(static_cast<std::int8_t>(trinary ? (value == 0   ? 0
                                                                : value == 1 ? 100
                                                                             : -1)
                                                             : value - 1));
      }
      save_map(map, folder_ / "saved.yaml");
      const OccupancyMap back = load_map(folder_ / "saved.yaml").map;
      EXPECT_EQ(back.cells, map.cells);
      EXPECT_EQ(back.columns, map.columns);
      EXPECT_EQ(back.resolution_m, map.resolution_m);
      EXPECT_EQ(back.map_from_grid.position_m, map.map_from_grid.position_m);
      EXPECT_EQ(back.map_from_grid.yaw_rad, map.map_from_grid.yaw_rad);
    }
  }
}

TEST(PublicMaps, are_read) {
  const fs::path data = fs::path(LODESTAR_SOURCE_DIR) / "../shared/data/rosmaps";
  if (!fs::exists(data)) GTEST_SKIP() << "no maps of other projects";
  int read = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(data)) {
    if (entry.path().extension() != ".yaml") continue;
    const LoadedMap loaded = load_map(entry.path());
    EXPECT_GT(std::ranges::count(loaded.map.cells, OccupancyMap::occupied), 0) << entry.path();
    ++read;
  }
  EXPECT_GE(read, 5);
}

}  // namespace
}  // namespace lodestar

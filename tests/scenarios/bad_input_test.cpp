#include <cstdlib>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include "maps/random.hpp"

#include "tests/scenarios/command_line.hpp"

// Any error in a file or an option gives exit code 2 and a message with the place, what was found and what
// was wanted; nothing is written.
namespace lodestar {
namespace {

namespace fs = std::filesystem;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

/// A site like the lab in which one piece of one file is replaced.
struct BadFile {
  std::string name;
  std::string file;
  std::string piece;  ///< replaced once; must be there
  std::string replacement;
  std::string message;  ///< regular expression for stderr
};

void PrintTo(const BadFile& bad, std::ostream* out) {
  *out << bad.name;
}

class BadSite : public ::testing::TestWithParam<BadFile> {
 protected:
  BadSite() { fs::copy(fs::path(LODESTAR_SOURCE_DIR) / "sites/lab", site_, fs::copy_options::recursive); }

  ScratchFolder scratch_;
  fs::path site_ = scratch_.path() / "site";
};

TEST_P(BadSite, is_refused_with_its_place) {
  const BadFile& bad = GetParam();
  std::string text = read_text(site_ / bad.file);
  const std::size_t at = text.find(bad.piece);
  ASSERT_NE(at, std::string::npos) << "the lab's " << bad.file << " has no '" << bad.piece << "'";
  text.replace(at, bad.piece.size(), bad.replacement);
  write_text(site_ / bad.file, text);

  const Ran ran = run_lodestar("replay site -o out", scratch_.path());

  EXPECT_EQ(ran.exit_code, 2) << ran.err;
  EXPECT_THAT(ran.err, ContainsRegex(bad.message));
  EXPECT_FALSE(fs::exists(scratch_.path() / "out"));
}

INSTANTIATE_TEST_SUITE_P(
    Files, BadSite,
    ::testing::Values(
        BadFile{"unknown_site_key", "site.yaml",
                "default_camera:", "defualt_camera:", "site.yaml:[0-9]+: found"},
        BadFile{"site_name_in_latin_1", "site.yaml", "name: lab", "name: B\xFCro",
                "site.yaml:[0-9]+: found 'B.xfcro', wanted text in UTF-8"},
        BadFile{"site_of_another_format", "site.yaml", "lodestar-site", "lodestar-cite",
                "site.yaml:1: found 'lodestar-cite'"},
        BadFile{"site_names_a_missing_map", "site.yaml", "map.yaml", "no_map.yaml", "no_map.yaml: found"},
        BadFile{"footprint_of_crossing_edges", "robot.yaml", "radius_m: 0.25",
                "radius_m: 0.25\nfootprint_m: [[0, 0], [1, 1], [1, 0], [0, 1]]",
                "robot.yaml:5: found 4 corners that make none"},
        BadFile{"footprint_of_numbers", "robot.yaml", "radius_m: 0.25", "radius_m: 0.25\nfootprint_m: [1, 2]",
                "robot.yaml:5: found .*wanted a list of \\[x, y\\]"},
        BadFile{"site_without_the_default_camera", "site.yaml", "default_camera: wide",
                "default_camera: narrow", "site.yaml:[0-9]+: found 'narrow'"},
        BadFile{"robot_radius_as_word", "robot.yaml", "radius_m: 0.25", "radius_m: 25cm",
                "robot.yaml:[0-9]+: found '25cm'"},
        BadFile{"robot_radius_negative", "robot.yaml", "radius_m: 0.25", "radius_m: -0.25",
                "robot.yaml:[0-9]+: found .?-0.25"},
        BadFile{"robot_radius_nan", "robot.yaml", "radius_m: 0.25", "radius_m: .nan",
                "robot.yaml:[0-9]+: found"},
        BadFile{"robot_with_unknown_key", "robot.yaml",
                "track_width_m:", "track_width:", "robot.yaml:[0-9]+: found"},
        BadFile{"robot_response_as_word", "robot.yaml", "response_s: 0.12", "response_s: soon",
                "robot.yaml:19: found 'soon', wanted a finite number"},
        BadFile{"robot_response_nan", "robot.yaml", "response_s: 0.12", "response_s: .nan",
                "robot.yaml:19: found '.nan', wanted a finite number"},
        BadFile{"robot_dead_band_beyond_its_limit", "robot.yaml", "dead_band_mps: 0.02", "dead_band_mps: 0.7",
                "robot.yaml:19: found 0.7, wanted 0 to 0.6"},
        BadFile{"robot_dead_band_in_degrees", "robot.yaml", "dead_band_radps: 0.06", "dead_band_radps: 3.4",
                "robot.yaml:19: found 3.4, wanted 0 to 1.2"},
        BadFile{"robot_encoder_step_in_millimetres", "robot.yaml", "encoder_step_m: 0.001",
                "encoder_step_m: 1", "robot.yaml:20: found 1, wanted 0 to 0.05"},
        BadFile{"robot_wheels_without_noise", "robot.yaml", "noise_m_per_sqrt_m: 0.002",
                "noise_m_per_sqrt_m: 0", "robot.yaml:20: found 0, wanted"},
        BadFile{"robot_wheels_as_number", "robot.yaml", "wheels: {", "wheels: 2 # {", "robot.yaml:20: found"},
        BadFile{"robot_motors_with_unknown_key", "robot.yaml", "response_s: 0.12", "lag_s: 0.12",
                "robot.yaml:19: found"},
        BadFile{"map_resolution_zero", "map.yaml", "resolution: 0.05", "resolution: 0",
                "map.yaml:[0-9]+: found .?0"},
        BadFile{"map_origin_nan", "map.yaml", "origin: [", "origin: [.nan, ", "map.yaml:[0-9]+: found"},
        BadFile{"map_image_missing", "map.yaml", "map.pgm", "mop.pgm", "map.yaml:[0-9]+: found"},
        BadFile{"map_image_of_another_kind", "map.pgm", "P5", "P9", "map.yaml:[0-9]+: found"},
        BadFile{"marker_id_too_large", "markers.yaml", "{id: ", "{id: 9", "markers.yaml:[0-9]+: found"},
        BadFile{"marker_key_misspelt", "markers.yaml", "yaw_deg", "yaw_rad", "markers.yaml:[0-9]+: found"},
        BadFile{"markers_of_a_later_version", "markers.yaml", "version: 1", "version: 2",
                "markers.yaml:2: found .?2"},
        BadFile{"markers_broken_yaml", "markers.yaml", "markers:", "markers: [",
                "markers.yaml:[0-9]+: found"},
        BadFile{"camera_without_width", "camera.yaml",
                "image_width:", "image_wide:", "camera.yaml:[0-9]*:? ?found"},
        BadFile{"camera_of_unknown_model", "camera.yaml", "plumb_bob", "plum_bob",
                "camera.yaml:[0-9]+: found 'plum_bob'"}),
    [](const auto& instance) { return instance.param.name; });

struct BadCommand {
  std::string name;
  std::string arguments;
  std::string message;
};

void PrintTo(const BadCommand& bad, std::ostream* out) {
  *out << bad.name;
}

class BadArguments : public ::testing::TestWithParam<BadCommand> {};

TEST_P(BadArguments, are_refused) {
  const ScratchFolder scratch;
  const std::string lab = std::string(LODESTAR_SOURCE_DIR) + "/sites/lab";
  std::string arguments = GetParam().arguments;
  for (std::size_t at = 0; (at = arguments.find("LAB", at)) != std::string::npos;)
    arguments.replace(at, 3, lab);

  const Ran ran = run_lodestar(arguments, scratch.path());

  EXPECT_EQ(ran.exit_code, 2) << ran.out << ran.err;
  EXPECT_THAT(ran.err, ContainsRegex(GetParam().message));
  EXPECT_TRUE(fs::is_empty(scratch.path())) << "something was written";
}

INSTANTIATE_TEST_SUITE_P(
    Options, BadArguments,
    ::testing::Values(
        BadCommand{"no_command", "", "subcommand"},
        BadCommand{"unknown_command", "fly", "found 'fly', wanted"},
        BadCommand{"misspelt_command", "replya", "found 'replya', wanted replay\\?"},
        BadCommand{"radius_nan", "plan --map LAB/map.yaml --start 1,1 --goal 2,2 --radius nan",
                   "--radius: found 'nan', wanted a finite number"},
        BadCommand{"map_converted_to_its_image", "map convert LAB/map.yaml -o out/map.pgm",
                   "out/map.pgm: found '.pgm', wanted the name of a YAML file"},
        BadCommand{"minutes_nan", "soak --minutes nan", "--minutes: found 'nan'"},
        BadCommand{"unequal_wheels_nan", "replay --unequal-wheels nan", "--unequal-wheels: found 'nan'"},
        BadCommand{"share_infinite", "replay --lose-frames inf", "--lose-frames: .*inf"},
        BadCommand{"seed_negative", "replay --seed -1",
                   "--seed: found '-1', wanted a whole number, 0 or more"},
        BadCommand{"seed_of_65_bits", "replay --seed 18446744073709551616",
                   "--seed: found '18446744073709551616'"},
        BadCommand{"mission_of_67_bits", "campaign --mission 99999999999999999999", "--mission: found"},
        BadCommand{"unknown_option", "replay --fast", "--fast"},
        BadCommand{"seed_as_word", "replay --seed one", "seed"},
        BadCommand{"no_runs", "replay --runs 0", "runs"},
        BadCommand{"unknown_camera", "replay --camera tele", "camera"},
        BadCommand{"unknown_planner", "replay --planner rrtstar9", "planner"},
        BadCommand{"goal_with_one_number", "replay --goal 3", "--goal: found '3', wanted X,Y"},
        BadCommand{"goal_not_a_number", "replay --goal 3,nan", "--goal: found '3,nan'"},
        BadCommand{"goal_with_a_space", "replay --goal '3, 4'", "--goal: found '3, 4'"},
        BadCommand{"site_that_is_not_there", "replay nowhere", "nowhere/site.yaml: found"},
        BadCommand{"plan_without_a_map", "plan --start 1,1 --goal 2,2", "--map"},
        BadCommand{"plan_with_a_bad_start", "plan --map LAB/map.yaml --start 1 --goal 2,2",
                   "--start: found '1'"},
        BadCommand{"plan_with_a_negative_radius",
                   "plan --map LAB/map.yaml --start 1,1 --goal 2,2 --radius=-1", "radius"},
        BadCommand{"plan_on_a_camera_file", "plan --map LAB/camera.yaml --start 1,1 --goal 2,2",
                   "camera.yaml:[0-9]+: found"},
        BadCommand{"localize_without_markers", "localize --camera LAB/camera.yaml x.png", "--markers"},
        BadCommand{"localize_a_missing_image",
                   "localize --markers LAB/markers.yaml --camera LAB/camera.yaml x.png", "x.png: found"},
        BadCommand{"localize_what_is_no_image",
                   "localize --markers LAB/markers.yaml --camera LAB/camera.yaml LAB/map.yaml",
                   "map.yaml: found no image and no video"},
        BadCommand{"localize_an_image_of_another_size",
                   "localize --markers LAB/markers.yaml --camera LAB/camera.yaml LAB/map.pgm",
                   "map.pgm: found 306 x 150"},
        BadCommand{
            "localize_upright_and_tilted",
            "localize --upright --tilt-sigma-deg 1 --markers LAB/markers.yaml --camera LAB/camera.yaml x.png",
            "excludes"},
        BadCommand{"detect_nothing", "detect", "input"},
        BadCommand{"detect_by_a_pattern_without_matches", "detect 'shots/*.png'",
                   "shots/.*.png: found no file that matches"},
        BadCommand{"detect_no_frames", "detect --frames 0 x.png", "frames"},
        BadCommand{"detect_with_a_device_that_is_no_camera", "detect /dev/null",
                   "/dev/null: found no video device"},
        BadCommand{"detect_in_an_empty_folder", "detect .", "folder without images"},
        BadCommand{"markers_without_a_file", "markers list nothing.yaml", "nothing.yaml: found"},
        BadCommand{"markers_generate_without_a_count", "markers generate --min-hamming 3", "--count"},
        BadCommand{"markers_generate_too_many", "markers generate --count 4097", "--count"},
        BadCommand{"markers_generate_beside_nothing", "markers generate --count 5 --avoid no.yaml",
                   "no.yaml: found"},
        BadCommand{"map_info_of_nothing", "map info nothing.bt", "nothing.bt: found"},
        BadCommand{"map_slice_of_a_floor_map", "map slice LAB/map.yaml --z-min 0 --z-max 1 -o out/map.yaml",
                   "map.yaml"}),
    [](const auto& instance) { return instance.param.name; });

TEST(CommandLine, prints_help_and_version_with_exit_code_0) {
  const ScratchFolder scratch;
  const Ran help = run_lodestar("--help", scratch.path());
  EXPECT_EQ(help.exit_code, 0);
  for (const char* word : {"replay", "localize", "detect", "plan", "map", "markers", "bench"}) {
    EXPECT_THAT(help.out, HasSubstr(word));
  }
  EXPECT_EQ(run_lodestar("--version", scratch.path()).exit_code, 0);
}

/// Random words from a small dictionary; each line ends with an option that no command has.
TEST(CommandLine, is_refused_in_words_whatever_it_is) {
  const ScratchFolder scratch;
  const std::vector<std::string> words{
      "replay",  "plan",      "map",      "markers", "localize", "detect", "calibrate", "doctor", "bench",
      "--goal",  "1,2",       "1,2,3,4",  "nan,inf", "--start",  "--seed", "-1",        "1e999",  "''",
      "--map",   "/dev/null", "--radius", "-o",      "check",    "slice",  "--format",  "json",   "--planner",
      "fastest", "%n",        "-",        "0x10",    "--runs",   "\\xff"};
  Random random(3);
  for (int trial = 0; trial < 25; ++trial) {
    std::string line;
    const std::uint64_t count = random.below(8);
    for (std::uint64_t i = 0; i < count; ++i) line += words[random.below(words.size())] + " ";
    const Ran ran = run_lodestar(line + "--no-such-option", scratch.path());
    EXPECT_EQ(ran.exit_code, 2) << line << ran.err;
    EXPECT_FALSE(ran.err.empty()) << line;
  }
}

TEST(Output, that_a_full_disk_does_not_take_is_an_error) {
  const int status = std::system("'" LODESTAR_BINARY "' --help >/dev/full 2>/dev/null </dev/null");
  EXPECT_EQ(WEXITSTATUS(status), 1);
}

}  // namespace
}  // namespace lodestar

#include "maps/places.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "maps/input_error.hpp"

#include "tests/maps/spoilt_file.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string whole = R"(format: lodestar-places
version: 1
places:
  - {name: "desk: \"A\"", x_m: 1.25, y_m: -2, yaw_deg: 90}
  - {name: "Türe", x_m: 0.1, y_m: 2}
nodes:
  - {name: "N1", x_m: 3, y_m: 2}
edges:
  - {from: "N1", to: "Türe", one_way: true, max_mps: 0.3}
  - {from: "N1", to: "desk: \"A\""}
keep_out:
  - {name: "stairs", corners_m: [[0, 0], [1, 0], [1, 1.5]]}
  - {corners_m: [[5, 5], [5, 6], [6, 6], [6, 5]]}
speed_zones:
  - {name: "ward", corners_m: [[2, 0], [3, 0], [3, 1]], max_mps: 0.25}
missions:
  - {name: "round", places: ["Türe", "desk: \"A\"", "Türe"]}
)";

const std::string older = R"(format: lodestar-routes
version: 1
places:
  - {name: "desk", x_m: 1.25, y_m: -2, yaw_deg: 90}
  - {name: "door", x_m: 0.1, y_m: 2}
routes:
  - {name: "round", places: ["door", "desk"]}
)";

std::string refusal(const std::string& piece, const std::string& by) {
  return error_of("places.yaml", with(whole, piece, by),
                  [](const fs::path& file) { return load_places(file.parent_path()); });
}

TEST(Places, are_written_as_they_are_read_one_item_a_line) {
  const Places places = parse_places(whole, "places.yaml");
  ASSERT_EQ(places.places.size(), 2U);
  EXPECT_EQ(places.find("desk: \"A\"")->position_m, Vec2(1.25, -2.0));
  EXPECT_NEAR(*places.places[0].yaw_rad, radians(90.0), 1e-12);
  EXPECT_FALSE(places.places[1].yaw_rad);
  EXPECT_EQ(*places.position_m("N1"), Vec2(3.0, 2.0));
  EXPECT_EQ(places.find("N1"), nullptr);  // nobody stops at a node
  EXPECT_FALSE(places.position_m("N2"));
  EXPECT_TRUE(places.edges[0].one_way);
  EXPECT_EQ(places.edges[0].max_mps, 0.3);
  EXPECT_FALSE(places.edges[1].one_way || places.edges[1].max_mps);
  EXPECT_EQ(places.keep_out[0].corners_m[2], Vec2(1.0, 1.5));
  EXPECT_EQ(places.keep_out[1].name, "");
  EXPECT_EQ(places.speed_zones[0].max_mps, 0.25);
  EXPECT_EQ(places.missions[0].stops.size(), 3U);
  EXPECT_EQ(places_text(places), whole);
}

TEST(Places, without_any_are_a_file_too) {
  EXPECT_EQ(places_text(parse_places(places_text({}), "none")), places_text({}));
  EXPECT_TRUE(parse_places("{format: lodestar-places, version: 1, places: []}", "none").edges.empty());
}

TEST(Places, refuse_with_line_what_they_do_not_know) {
  EXPECT_THAT(refusal("lodestar-places", "lodestar-markers"), HasSubstr("places.yaml:1: found"));
  EXPECT_THAT(refusal("x_m: 1.25", "x: 1.25"), HasSubstr("places.yaml:4: found no key 'x_m'"));
  EXPECT_THAT(refusal("y_m: -2", "y_m: .nan"), HasSubstr("places.yaml:4"));
  EXPECT_THAT(refusal("yaw_deg: 90", "yaw_deg: 900"), HasSubstr("-360 to 360"));
  EXPECT_THAT(refusal("yaw_deg: 90", "yaw: 90"), HasSubstr("unknown key 'yaw'"));
  EXPECT_THAT(refusal("max_mps: 0.25", "max_mps: 0"), HasSubstr("places.yaml:15"));
  EXPECT_THAT(refusal("one_way: true", "one_way: maybe"), HasSubstr("true or false"));
  EXPECT_THAT(refusal("missions:", "routes:"), HasSubstr("unknown key 'routes'"));
}

TEST(Places, refuse_names_that_are_no_names) {
  EXPECT_THAT(refusal("name: \"N1\"", "name: \"Türe\""), HasSubstr("places.yaml:7: found 'Türe' twice"));
  EXPECT_THAT(refusal("name: \"N1\"", "name: \"1.5,-2\""), HasSubstr("no pair of numbers"));
  EXPECT_THAT(refusal("name: \"N1\"", "name: \"N\\n1\""), HasSubstr("plain text"));
  EXPECT_THAT(refusal("name: \"N1\"", "name: \"N\xff\""), HasSubstr("places.yaml"));
  EXPECT_THAT(refusal("name: \"N1\"", fmt::format("name: {:n<81}", "")), HasSubstr("81 bytes"));
}

TEST(Places, refuse_ways_that_lead_nowhere) {
  EXPECT_THAT(refusal("to: \"Türe\"", "to: \"N7\""), HasSubstr("places.yaml:9: found 'N7'"));
  EXPECT_THAT(refusal("to: \"Türe\"", "to: \"N1\""), HasSubstr("another end"));
  EXPECT_THAT(refusal("to: \"Türe\", one_way: true", "to: \"desk: \\\"A\\\"\", one_way: true"),
              HasSubstr("places.yaml:10"));
  EXPECT_THAT(refusal("[\"Türe\", \"desk", "[\"N1\", \"desk"),
              HasSubstr("places.yaml:17: found 'N1', wanted the name of a place"));
  EXPECT_THAT(refusal("[\"Türe\", \"desk: \\\"A\\\"\", \"Türe\"]", "[]"), HasSubstr("found none"));
}

TEST(Places, missions_say_what_is_done_at_their_stops) {
  const std::string stops =
      "stops: [{place: \"Türe\", wait_s: 2.5}, {place: \"desk: \\\"A\\\"\", action: "
      "\"pick\"}, {place: \"Türe\"}], repeat: 3";
  const std::string text = with(whole, "places: [\"Türe\", \"desk: \\\"A\\\"\", \"Türe\"]", stops);
  const Places places = parse_places(text, "places.yaml");
  const NamedMission& mission = places.missions.at(0);
  EXPECT_EQ(mission.repeat, 3);
  EXPECT_EQ(mission.stops.at(0), (MissionStop{.place = "Türe", .wait_s = 2.5, .action = ""}));
  EXPECT_EQ(mission.stops.at(1), (MissionStop{.place = "desk: \"A\"", .wait_s = 0.0, .action = "pick"}));
  EXPECT_EQ(places_text(places), text);
}

TEST(Places, refuse_stops_that_are_none) {
  const std::string list = "places: [\"Türe\", \"desk: \\\"A\\\"\", \"Türe\"]";
  EXPECT_THAT(refusal(list, "stops: []"), HasSubstr("places.yaml:17: found none"));
  EXPECT_THAT(refusal(list, "stops: [{place: N1}]"), HasSubstr("found 'N1', wanted the name of a place"));
  EXPECT_THAT(refusal(list, "stops: [{place: Türe, wait_s: -1}]"), HasSubstr("wanted 0 to 86400"));
  EXPECT_THAT(refusal(list, "stops: [{place: Türe, waits: 1}]"), HasSubstr("unknown key 'waits'"));
  EXPECT_THAT(refusal(list, "stops: [{place: Türe, action: \"\"}]"), HasSubstr("found ''"));
  EXPECT_THAT(refusal(list, list + ", repeat: 167"), HasSubstr("1 to 166"));
  EXPECT_THAT(refusal(list, list + ", stops: [{place: Türe}]"), HasSubstr("unknown key"));
}

TEST(Places, refuse_polygons_that_are_none) {
  EXPECT_THAT(refusal("[1, 0], [1, 1.5]]", "[1, 0]]"), HasSubstr("places.yaml:12: found 2 corners"));
  EXPECT_THAT(refusal("[5, 6], [6, 6], [6, 5]", "[6, 6], [5, 6], [6, 5]"), HasSubstr("crossing itself"));
  EXPECT_THAT(refusal("[2, 0], [3, 0], [3, 1]", "[2, 0], [3, 0], [4, 0]"), HasSubstr("places.yaml:15"));
  EXPECT_THAT(refusal("[1, 1.5]", "[1, .inf]"), HasSubstr("places.yaml:12"));
  EXPECT_THAT(refusal("[1, 1.5]", "[1, 1e-10]"), HasSubstr("of no polygon"));  // none as written
}

TEST(Places, of_a_site_that_keeps_the_older_file_move_when_they_are_first_written) {
  const TemporaryFolder site;
  EXPECT_EQ(places_text(load_places(site.path())), places_text({}));
  site.write("routes.yaml", older);

  const Places places = load_places(site.path());
  ASSERT_EQ(places.missions.size(), 1U);
  EXPECT_EQ(places.missions[0].stops, (std::vector<MissionStop>{{.place = "door"}, {.place = "desk"}}));
  EXPECT_FALSE(fs::exists(site / "places.yaml"));  // reading changes nothing

  save_places(places, site.path());
  EXPECT_EQ(places_text(load_places(site.path())), places_text(places));
  EXPECT_FALSE(fs::exists(site / "routes.yaml"));
  EXPECT_EQ(site.read("routes.yaml.old"), older);
}

TEST(Places, newer_ones_count_and_an_old_file_is_never_lost) {
  const TemporaryFolder site;
  site.write("routes.yaml", older);
  site.write("routes.yaml.old", "older still");
  site.write("places.yaml", whole);
  EXPECT_EQ(places_text(load_places(site.path())), whole);
  save_places(load_places(site.path()), site.path());
  EXPECT_EQ(site.read("routes.yaml.old"), "older still");
  EXPECT_EQ(site.read("routes.yaml"), older);
}

}  // namespace
}  // namespace lodestar

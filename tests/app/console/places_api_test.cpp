#include "app/console/places_api.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "app/console/document_api.hpp"
#include "app/console/places_json.hpp"

#include "tests/maps/temporary_folder.hpp"

// All that people name on a map, as the page reads and saves it.
namespace lodestar {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

class PlacesApiTest : public ::testing::Test {
 protected:
  PlacesApiTest() {
    fs::copy(fs::path(LODESTAR_SOURCE_DIR) / "sites/lab", site_, fs::copy_options::recursive);
    console_.emplace(site_, folder_ / "runs");
  }

  HttpResponse get(const std::string& target = "/api/places") {
    return console_->answer({.method = "GET", .target = target});
  }
  HttpResponse put(const json& places, const std::string& etag) {
    return console_->answer(
        {.method = "PUT", .target = "/api/places", .if_match = etag, .body = places.dump()});
  }
  HttpResponse check(const json& places) {
    return console_->answer({.method = "POST", .target = "/api/places/check", .body = places.dump()});
  }
  /// With a place, a node, a lane, and a zone of each kind.
  json drawn() {
    json places = json::parse(get().body);
    places["places"] = {{{"name", "desk"}, {"x_m", 2.5}, {"y_m", 5.0}, {"yaw_deg", 90.0}}};
    places["nodes"] = {{{"name", "N1"}, {"x_m", 1.7}, {"y_m", 5.0}}};
    places["edges"] = {{{"from", "N1"}, {"to", "desk"}, {"one_way", true}, {"max_mps", 0.3}}};
    places["keep_out"] = {{{"name", "stairs"}, {"corners_m", {{9, 2}, {10, 2}, {10, 3}}}}};
    places["speed_zones"] = {{{"corners_m", {{5, 0}, {8, 0}, {8, 7}}}, {"max_mps", 0.25}}};
    return places;
  }

  TemporaryFolder folder_;
  fs::path site_ = folder_ / "site";
  std::optional<DocumentApi> console_;
};

TEST_F(PlacesApiTest, saves_all_kinds_and_gives_them_back_and_tells) {
  std::optional<Places> told;
  console_->on_saved_places([&](const Places& saved) { told = saved; });
  const json places = drawn();

  const HttpResponse saved = put(places, get().etag);

  ASSERT_EQ(saved.status, 200) << saved.body;
  EXPECT_EQ(json::parse(saved.body), places);
  EXPECT_EQ(saved.etag, get().etag);
  EXPECT_EQ(places_text(load_places(site_)), places_text(*told));
  EXPECT_EQ(told->edges.front().max_mps, 0.3);
  EXPECT_TRUE(told->edges.front().one_way);
}

TEST_F(PlacesApiTest, refuses_to_save_over_what_was_not_read) {
  const std::string etag = get().etag;
  ASSERT_EQ(put(drawn(), etag).status, 200);
  EXPECT_EQ(put(drawn(), etag).status, 412);
  EXPECT_EQ(put(drawn(), "").status, 428);
}

TEST_F(PlacesApiTest, names_the_item_to_blame) {
  json places = drawn();
  places["keep_out"].push_back({{"name", "bow"}, {"corners_m", {{0, 0}, {1, 1}, {1, 0}, {0, 1}}}});
  for (const HttpResponse& refused : {put(places, get().etag), check(places)}) {
    EXPECT_EQ(refused.status, 422);
    const json why = json::parse(refused.body);
    EXPECT_EQ(why["list"], "keep_out");
    EXPECT_EQ(why["index"], 1);
    EXPECT_THAT(why["error"].get<std::string>(), testing::StartsWith("found 4 corners of no polygon"));
  }
  places = drawn();
  places["edges"][0]["to"] = "nowhere";
  EXPECT_EQ(json::parse(check(places).body)["list"], "edges");
  EXPECT_FALSE(fs::exists(site_ / places_file_name));
}

TEST_F(PlacesApiTest, refuses_speeds_below_the_robots_dead_band_which_no_site_could_load) {
  Robot robot = console_->site().robot;
  robot.dead_band_mps = 0.26;
  const auto read = places_from_json(drawn().dump(), robot);
  const auto& why = std::get<PlacesRefusal>(read);
  EXPECT_EQ(why.list, "speed_zones");
  EXPECT_THAT(why.words, HasSubstr("0.26"));
}

TEST_F(PlacesApiTest, takes_no_document_that_is_none) {
  const std::string etag = get().etag;
  for (const json& sent : {json(), json::array(), json("x"), json{{"format", "lodestar-places"}}})
    EXPECT_EQ(put(sent, etag).status, 422) << sent;
  EXPECT_FALSE(fs::exists(site_ / places_file_name));
}

TEST_F(PlacesApiTest, checks_a_draft_and_leaves_the_site_as_it_is) {
  json places = drawn();
  places["keep_out"][0]["corners_m"] = {{2.2, 4.7}, {2.8, 4.7}, {2.8, 5.3}, {2.2, 5.3}};

  const json issues = json::parse(check(places).body);

  std::vector<std::string> kinds;
  for (const json& issue : issues) kinds.push_back(issue["kind"]);
  EXPECT_THAT(kinds, testing::Contains("in-keep-out"));
  EXPECT_THAT(kinds, testing::Contains("blocked-edge"));
  EXPECT_FALSE(fs::exists(site_ / places_file_name));
}

TEST_F(PlacesApiTest, refuses_to_lose_the_place_where_the_robot_charges) {
  ASSERT_EQ(put(drawn(), get().etag).status, 200);
  std::ofstream(site_ / "site.yaml", std::ios::app) << "charging: {place: desk, full_v: 29}\n";
  console_.emplace(site_, folder_ / "runs");

  json without = drawn();
  without["places"][0].erase("yaw_deg");
  for (const HttpResponse& response : {put(without, get().etag), check(without)}) {
    EXPECT_EQ(response.status, 422);
    EXPECT_THAT(response.body, HasSubstr("found no place 'desk' with a heading"));
  }
  json moved = drawn();
  moved["places"][0]["x_m"] = 2.4;
  EXPECT_EQ(put(moved, get().etag).status, 200);
}

TEST_F(PlacesApiTest, keeps_earlier_states_beside_those_of_the_markers) {
  const json before = json::parse(get().body);
  ASSERT_EQ(put(drawn(), get().etag).status, 200);
  const json states = json::parse(get("/api/places/history").body);
  ASSERT_EQ(states.size(), 1U);
  EXPECT_EQ(states[0]["number"], 1);
  EXPECT_EQ(json::parse(get("/api/places/history/1").body), before);
  EXPECT_EQ(get("/api/places/history/2").status, 404);
  EXPECT_EQ(get("/api/places/history/../1").status, 404);
  EXPECT_EQ(json::parse(get("/api/markers/history").body), json::array());
}

}  // namespace
}  // namespace lodestar

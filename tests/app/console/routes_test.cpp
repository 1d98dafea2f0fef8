#include "app/console/routes.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "app/console/document_api.hpp"
#include "maps/input_error.hpp"

#include "tests/maps/temporary_folder.hpp"

// Places and routes of the page, kept in the site's places.yaml.
namespace lodestar {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

const std::string older = R"(format: lodestar-routes
version: 1
places:
  - {name: "desk", x_m: 2.25, y_m: 4, yaw_deg: 90}
  - {name: "door", x_m: 2.1, y_m: 5}
routes:
  - {name: "round", places: ["door", "desk"]}
)";

class RoutesTest : public ::testing::Test {
 protected:
  RoutesTest() { fs::copy(fs::path(LODESTAR_SOURCE_DIR) / "sites/lab", site_, fs::copy_options::recursive); }

  HttpResponse get() { return console().answer({.method = "GET", .target = "/api/routes"}); }
  HttpResponse put(const json& routes, const std::string& etag) {
    return console().answer(
        {.method = "PUT", .target = "/api/routes", .if_match = etag, .body = routes.dump()});
  }
  DocumentApi& console() {
    if (!console_) console_.emplace(site_, folder_ / "runs");
    return *console_;
  }

  TemporaryFolder folder_;
  fs::path site_ = folder_ / "site";
  std::optional<DocumentApi> console_;
};

TEST_F(RoutesTest, kept_in_the_older_file_move_when_the_page_saves) {
  folder_.write("site/routes.yaml", older);
  const HttpResponse read = get();
  json routes = json::parse(read.body);
  EXPECT_EQ(routes["places"][0], json({{"name", "desk"}, {"x_m", 2.25}, {"y_m", 4.0}, {"yaw_deg", 90.0}}));
  EXPECT_FALSE(routes["places"][1].contains("yaw_deg"));
  EXPECT_EQ(routes["routes"][0]["places"], json({"door", "desk"}));
  routes["places"][1]["x_m"] = 2.5;

  const HttpResponse saved = put(routes, read.etag);

  ASSERT_EQ(saved.status, 200) << saved.body;
  EXPECT_EQ(json::parse(saved.body), routes);
  const Places kept = load_places(site_);
  EXPECT_EQ(kept.find("door")->position_m, Vec2(2.5, 5.0));
  EXPECT_EQ(kept.missions.size(), 1U);
  EXPECT_EQ(folder_.read("site/routes.yaml.old"), older);
  EXPECT_EQ(put(routes, read.etag).status, 412);
}

TEST_F(RoutesTest, leave_zones_and_edges_as_they_are) {
  Places places = parse_routes(older, "older");
  places.nodes = {{"N1", {3.0, 4.0}}};
  places.edges = {{.from = "N1", .to = "desk", .one_way = true, .max_mps = std::nullopt}};
  places.keep_out = {{"stairs", {{5.0, 5.0}, {6.0, 5.0}, {6.0, 6.0}}}};
  save_places(places, site_);
  const HttpResponse read = get();
  json routes = json::parse(read.body);

  json without_desk = routes;
  without_desk["places"].erase(0);
  without_desk["routes"].clear();
  const HttpResponse refused = put(without_desk, read.etag);
  EXPECT_EQ(refused.status, 422);
  EXPECT_THAT(refused.body, HasSubstr("found 'desk', wanted the name of a place or a node"));
  EXPECT_EQ(places_text(load_places(site_)), places_text(places));

  routes["routes"].clear();
  ASSERT_EQ(put(routes, read.etag).status, 200);
  places.missions.clear();
  EXPECT_EQ(places_text(load_places(site_)), places_text(places));
}

TEST_F(RoutesTest, are_refused_when_they_cannot_be_read) {
  const std::string etag = get().etag;
  EXPECT_EQ(put({}, etag).status, 422);
  EXPECT_EQ(put(json::parse(get().body), "").status, 428);
  EXPECT_THROW((void)with_routes({}, "{format: lodestar-routes, version: 1, places: []}"), InputError);
}

}  // namespace
}  // namespace lodestar

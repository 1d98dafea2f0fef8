#include "app/console/document_api.hpp"

#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <octomap/OcTree.h>
#include <sstream>

#include "app/console/registry_edit.hpp"
#include "app/console/registry_json.hpp"
#include "maps/file_text.hpp"
#include "maps/input_error.hpp"

#include "tests/maps/temporary_folder.hpp"

// The console's document API, without a network.
namespace lodestar {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

class ConsoleTest : public ::testing::Test {
 protected:
  ConsoleTest() { fs::copy(fs::path(LODESTAR_SOURCE_DIR) / "sites/lab", site_, fs::copy_options::recursive); }

  HttpResponse get(const std::string& target, const std::string& if_none_match = "") {
    return console().answer({.method = "GET", .target = target, .if_none_match = if_none_match});
  }
  HttpResponse put(const json& registry, const std::string& etag) {
    return console().answer(
        {.method = "PUT", .target = "/api/markers", .if_match = etag, .body = registry.dump()});
  }
  HttpResponse post(const std::string& target, const json& body) {
    return console().answer({.method = "POST", .target = target, .body = body.dump()});
  }
  std::string file() { return file_text(site_ / "markers.yaml", "a registry"); }

  DocumentApi& console() {
    if (!console_) console_.emplace(site_, folder_ / "runs");
    return *console_;
  }

  TemporaryFolder folder_;
  fs::path site_ = folder_ / "site";
  std::optional<DocumentApi> console_;
};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST_F(ConsoleTest, changes_the_line_of_the_moved_marker_and_no_other) {
  const std::vector<std::string> before = lines_of(file());
  const HttpResponse read = get("/api/markers");
  json registry = json::parse(read.body);
  registry["markers"][3]["x_m"] = 2.5;

  const HttpResponse saved = put(registry, read.etag);

  ASSERT_EQ(saved.status, 200) << saved.body;
  EXPECT_NE(saved.etag, read.etag);
  const std::vector<std::string> after = lines_of(file());
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (before[i].find("id: 689,") == std::string::npos) {
      EXPECT_EQ(after[i], before[i]);
    } else {
      EXPECT_THAT(after[i], HasSubstr("x_m: 2.5, y_m: 2.456"));
    }
  }
}

TEST_F(ConsoleTest, tells_the_usual_routes_from_place_to_place) {
  const json routes = json::parse(get("/api/site").body)["routes"];
  ASSERT_EQ(routes.size(), 2U);  // the lab's drive goes to E and back to S
  EXPECT_EQ(routes[0].front(), json({1.2, 5.6}));
  EXPECT_EQ(routes[0].back(), json({13.9, 2.0}));
  EXPECT_EQ(routes[1].back(), json({1.2, 5.6}));
}

TEST_F(ConsoleTest, expects_small_deviations_below_markers_and_tells_where_none_is_seen) {
  json registry = json::parse(get("/api/markers").body);
  registry["markers"] =
      json::array({{{"id", 447}, {"x_m", 7.4}, {"y_m", 3.74}, {"z_m", 2.6}, {"yaw_deg", 0}}});
  const json found = json::parse(post("/api/markers/deviations", registry).body);
  const int stride = found["stride"];
  const int columns = found["columns"];
  const auto at = [&](double x_m, double y_m) {
    const auto cell = [&](double metres) { return static_cast<int>(metres / 0.05) / stride; };
    return found["sigma_mm"][static_cast<std::size_t>(cell(y_m) * columns + cell(x_m))];
  };
  ASSERT_TRUE(at(7.46, 3.68).is_number());
  EXPECT_GT(at(7.46, 3.68), 0.1);
  EXPECT_LT(at(7.46, 3.68), 20.0);
  EXPECT_TRUE(at(1.2, 5.6).is_null());
}

TEST_F(ConsoleTest, gives_heights_only_where_there_is_an_octomap) {
  EXPECT_TRUE(json::parse(get("/api/map").body)["heights"].is_null());
  EXPECT_EQ(get("/api/map/heights").status, 404);
  console_.reset();
  octomap::OcTree tree(0.1);
  tree.updateNode(octomap::point3d(5.05F, 4.05F, 1.55F), true);
  tree.updateInnerOccupancy();
  tree.writeBinary((site_ / "lab.bt").string());
  std::ofstream(site_ / "site.yaml", std::ios::app) << "octomap: lab.bt\n";

  const json heights = json::parse(get("/api/map").body)["heights"];
  const std::string bytes = get("/api/map/heights").body;
  EXPECT_EQ(bytes.size(), 4U * 306U * 150U);
  EXPECT_GE(heights["step_m"], 0.1);
  const std::size_t cell = 4U * (81U * 306U + 101U);  // at 5.05, 4.05 m
  EXPECT_NE(bytes.substr(cell, 4), std::string(4, '\0'));
  EXPECT_EQ(std::ranges::count_if(bytes, [](char byte) { return byte != '\0'; }),
            4);  // its voxel covers four cells
}

TEST_F(ConsoleTest, takes_markers_away_and_adds_them) {
  const HttpResponse read = get("/api/markers");
  json registry = json::parse(read.body);
  registry["markers"].erase(0);
  registry["markers"].push_back({{"id", 5}, {"x_m", 1}, {"y_m", 2}, {"z_m", 2.6}, {"yaw_deg", 45}});

  ASSERT_EQ(put(registry, read.etag).status, 200);

  const MarkerRegistry saved = load_registry(site_ / "markers.yaml");
  EXPECT_EQ(saved.markers.size(), 25U);
  EXPECT_EQ(saved.find(387), nullptr);
  ASSERT_NE(saved.find(5), nullptr);
  EXPECT_NEAR(saved.find(5)->yaw_rad, radians(45.0), 1e-12);
}

TEST_F(ConsoleTest, refuses_to_save_over_what_it_has_not_read) {
  const HttpResponse read = get("/api/markers");
  json registry = json::parse(read.body);
  registry["markers"][0]["y_m"] = 5.0;
  ASSERT_EQ(put(registry, read.etag).status, 200);
  const std::string first = file();

  registry["markers"][0]["y_m"] = 6.0;
  EXPECT_EQ(put(registry, read.etag).status, 412);
  EXPECT_EQ(put(registry, "").status, 428);
  EXPECT_EQ(file(), first);
}

TEST_F(ConsoleTest, keeps_the_last_fifty_states) {
  const std::string original = file();
  std::string etag = get("/api/markers").etag;
  json registry = json::parse(get("/api/markers").body);
  for (int i = 1; i <= 53; ++i) {
    registry["markers"][0]["z_m"] = 2.0 + 0.001 * i;
    const HttpResponse saved = put(registry, etag);
    ASSERT_EQ(saved.status, 200);
    etag = saved.etag;
    if (i > 1) continue;
    EXPECT_EQ(file_text(site_ / ".history" / "000001.yaml", "a registry"), original);
  }
  const json states = json::parse(get("/api/markers/history").body);
  EXPECT_EQ(states.size(), 50U);
  EXPECT_EQ(states.front()["number"], 53);
  const json former = json::parse(get("/api/markers/history/53").body);
  EXPECT_EQ(former["markers"][0]["z_m"], 2.052);
}

TEST_F(ConsoleTest, refuses_documents_that_are_no_registry_and_writes_nothing) {
  const std::string before = file();
  const HttpResponse read = get("/api/markers");
  const json good = json::parse(read.body);
  const auto status_with = [&](const char* key, const json& value) {
    json bad = good;
    bad["markers"][1][key] = value;
    return put(bad, read.etag).status;
  };
  EXPECT_EQ(status_with("id", 4096), 422);
  EXPECT_EQ(status_with("id", 1.5), 422);
  EXPECT_EQ(status_with("id", 387), 422);  // a repeated ID
  EXPECT_EQ(status_with("x_m", "1"), 422);
  EXPECT_EQ(status_with("x_m", nullptr), 422);
  EXPECT_EQ(status_with("x_m", 1e300), 422);
  EXPECT_EQ(status_with("note", "<script>"), 422);
  for (const char* text : {"", "[]", "{}", "{\"alignment\":1,\"markers\":[]}", "nul", "[[[[[[[["}) {
    const HttpResponse response =
        console().answer({.method = "PUT", .target = "/api/markers", .if_match = read.etag, .body = text});
    EXPECT_EQ(response.status, 422) << text;
  }
  EXPECT_EQ(file(), before);
}

TEST_F(ConsoleTest, knows_documents_by_their_names_and_nothing_else) {
  for (const char* target :
       {"/api/../site.yaml", "/api/markers/../../etc/passwd", "/api/markers/history/../markers",
        "//etc/passwd", "/api/markers/history/1%00", "/api/markers/history/-1",
        "/api/markers/history/99999999999999999999", "/api/markers/history/", "/api/markers/historyx",
        "/site.yaml", "/%2e%2e/site.yaml", ""}) {
    EXPECT_EQ(get(target).status, 404) << target;
  }
  EXPECT_EQ(console().answer({.method = "DELETE", .target = "/api/markers"}).status, 405);
  EXPECT_EQ(console().answer({.method = "PUT", .target = "/api/site"}).status, 405);
}

TEST_F(ConsoleTest, shows_run_folders_and_nothing_beside_them) {
  EXPECT_EQ(get("/api/runs").body, "[]");
  const fs::path run = folder_ / "runs" / "seed 7";
  fs::create_directories(run);
  std::ofstream(run / "summary.json") << "{\"seed\": 7}";
  std::ofstream(run / "estimate.tum") << "0.5 1 2 0 0 0 0 1\n1 1.5 2 0 0 0 0.707106781 0.707106781\n";
  fs::create_directory_symlink(run, folder_ / "runs" / "link");
  fs::create_directories(folder_ / "runs" / "empty");

  const auto names = [this] {
    std::vector<std::string> found;
    for (const json& one : json::parse(get("/api/runs").body)) found.push_back(one["name"]);
    return found;
  };
  EXPECT_THAT(names(), ::testing::ElementsAre("seed 7"));
  fs::copy(run, folder_ / "runs" / "seed 10", fs::copy_options::recursive);
  fs::last_write_time(run / "summary.json", fs::file_time_type::clock::now() - std::chrono::hours(1));
  EXPECT_THAT(names(), ::testing::ElementsAre("seed 7", "seed 10")) << "the newest last";
  const json read = json::parse(get("/api/runs/seed%207").body);
  EXPECT_EQ(read["summary"]["seed"], 7);
  EXPECT_EQ(read["estimate"], json::parse("[[0.5, 1.0, 2.0, 0.0], [1.0, 1.5, 2.0, 90.0]]"));
  for (const char* name : {"link", "empty", "..", "../site", "seed%207/..", "", ".", "seed%207%00", "%"}) {
    EXPECT_EQ(get(std::string("/api/runs/") + name).status, 404) << name;
  }
  fs::create_directories(run / "pictures");
  std::ofstream(run / "pictures" / "0.500.jpg") << "a picture";
  std::ofstream(run / "pictures" / "1.000.jpg") << std::string((4U << 20U) + 1, 'x');  // too large
  EXPECT_EQ(json::parse(get("/api/runs/seed%207").body)["pictures"], json({"0.500.jpg"}));
  EXPECT_EQ(get("/api/runs/seed%207/pictures/0.500.jpg").body, "a picture");
  for (const char* picture : {"1.000.jpg", "../summary.json", "..%2fsummary.json"}) {
    EXPECT_EQ(get(std::string("/api/runs/seed%207/pictures/") + picture).status, 404) << picture;
  }
  std::ofstream(run / "estimate.tum") << "0.5 1 two\n";
  EXPECT_EQ(get("/api/runs/seed%207").status, 422);
}

TEST_F(ConsoleTest, gives_each_document_a_tag_and_304_for_it) {
  for (const char* target :
       {"/api/site", "/api/map", "/api/map/cells", "/api/markers", "/api/places", "/api/routes"}) {
    const HttpResponse read = get(target);
    ASSERT_EQ(read.status, 200) << target;
    const HttpResponse again = get(target, read.etag);
    EXPECT_EQ(again.status, 304) << target;
    EXPECT_TRUE(again.body.empty());
  }
  EXPECT_EQ(get("/api/map/cells").body.size(), 306U * 150U);
}

TEST_F(ConsoleTest, finds_in_a_draft_what_the_check_finds_and_ids_that_stand_twice) {
  json draft = json::parse(get("/api/markers").body);
  draft["markers"][1]["id"] = draft["markers"][0]["id"];
  draft["markers"][2]["x_m"] = 99.0;
  const json issues = json::parse(post("/api/markers/check", draft).body);
  const auto has = [&](const char* kind) {
    return std::ranges::any_of(issues, [&](const json& issue) { return issue["kind"] == kind; });
  };
  EXPECT_TRUE(has("repeated-id"));
  EXPECT_TRUE(has("gap"));
  EXPECT_TRUE(has("outside-map"));
}

TEST_F(ConsoleTest, checks_no_more_markers_than_there_are_ids) {
  json draft = json::parse(get("/api/markers").body);
  const json marker = draft["markers"][0];
  while (draft["markers"].size() < 4097) draft["markers"].push_back(marker);
  EXPECT_EQ(post("/api/markers/check", draft).status, 422);
}

TEST_F(ConsoleTest, exports_imports_and_prints) {
  const json registry = json::parse(get("/api/markers").body);
  const json exported =
      json::parse(post("/api/markers/export", {{"format", "csv"}, {"registry", registry}}).body);
  const json back =
      json::parse(post("/api/markers/import", {{"name", "m.csv"}, {"text", exported["text"]}}).body);
  EXPECT_EQ(back["markers"].size(), 25U);
  EXPECT_EQ(post("/api/markers/import", {{"name", "m.exe"}, {"text", ""}}).status, 422);
  EXPECT_THAT(post("/api/markers/print", {{"ids", {447, 5}}, {"paper", "A3"}}).body, HasSubstr("%PDF-1.4"));
  for (const json& id :
       {json(4096), json(-1), json(1.5), json(1e20), json(4294967301), json(true), json("all")})
    EXPECT_EQ(post("/api/markers/print", {{"ids", json::array({id})}}).status, 422) << id;
  EXPECT_EQ(post("/api/markers/print", {{"ids", "all"}}).status, 422);
  EXPECT_THAT(post("/api/markers/print", {{"ids", {447}}, {"registry", registry}}).body,
              HasSubstr("(centre x "));
  EXPECT_EQ(post("/api/markers/print", {{"ids", {5}}, {"registry", registry}}).status, 422) << "it has none";
  json all = json::array();
  for (int id = 0; id < 4096; ++id) all.push_back(id);
  EXPECT_EQ(post("/api/markers/print", {{"ids", all}}).status, 200);
}

/// Printing such a value into a response recurses once per level, and would overflow the stack.
TEST_F(ConsoleTest, refuses_what_is_nested_deeper_than_a_stack) {
  const std::string nested = std::string(200'000, '[') + std::string(200'000, ']');
  for (const char* target : {"/api/markers/print", "/api/markers/export", "/api/markers/import",
                             "/api/markers/check", "/api/markers/deviations"}) {
    for (const std::string& body : {nested, R"({"ids":)" + nested + "}", R"({"format":)" + nested + "}"}) {
      const HttpResponse response = console().answer({.method = "POST", .target = target, .body = body});
      EXPECT_EQ(response.status, 422) << target;
      EXPECT_THAT(response.body, HasSubstr("nested deeper than 32 levels")) << target;
    }
  }
}

TEST(RegistryEdit, keeps_comments_and_rewrites_what_is_not_one_a_line) {
  const TemporaryFolder folder;
  const std::string text =
      "# surveyed in spring\nformat: lodestar-markers\nversion: 1\nalignment: {x_m: 0, y_m: 0, yaw_deg: 0}\n"
      "markers:\n  - {id: 1, x_m: 1.50, y_m: 2, z_m: 2.6, yaw_deg: 0}   # by the door\n"
      "  - {id: 2, x_m: 3, y_m: 2, z_m: 2.6, yaw_deg: 0}\n";
  const MarkerRegistry before = load_registry(folder.write("markers.yaml", text));
  MarkerRegistry after = before;
  after.markers[1].position_m.x() = 4.0;
  std::string wanted = text;
  wanted.replace(wanted.find("x_m: 3,"), 7, "x_m: 4,");
  EXPECT_EQ(edited_registry_text(text, before, after), wanted);
  after.map_from_registry.position_m.x() = 0.5;
  wanted.replace(wanted.find("x_m: 0,"), 7, "x_m: 0.5,");
  EXPECT_EQ(edited_registry_text(text, before, after), wanted) << "an alignment";

  const std::string block =
      "format: lodestar-markers\nversion: 1\nalignment: {x_m: 0, y_m: 0, yaw_deg: 0}\n"
      "markers: [{id: 1, x_m: 1, y_m: 2, z_m: 2.6, yaw_deg: 0}]\n";
  const MarkerRegistry flow = load_registry(folder.write("flow.yaml", block));
  EXPECT_THAT(edited_registry_text(block, flow, after), HasSubstr("\n  - {id: 2, x_m: 4,"));
}

TEST(RegistryEdit, keeps_a_surveys_sigmas_of_markers_that_were_not_moved) {
  const TemporaryFolder folder;
  const std::string text =
      "format: lodestar-markers\nversion: 1\nalignment: {x_m: 0, y_m: 0, yaw_deg: 0}\nmarkers:\n"
      "  - {id: 1, x_m: 1, y_m: 2, z_m: 2.6, yaw_deg: 0, sigma_m: 0.0012, sigma_deg: 0.02}\n"
      "  - {id: 2, x_m: 3, y_m: 2, z_m: 2.6, yaw_deg: 0, sigma_m: 0.0015, sigma_deg: 0.03}\n";
  const MarkerRegistry before = load_registry(folder.write("markers.yaml", text));
  ASSERT_TRUE(before.markers[0].sigma);
  MarkerRegistry after = registry_from_json(registry_json(before).dump());  // as the page sends it
  after.map_from_registry.position_m.x() = 0.5;  // so that all lines are written anew
  after.markers[1].position_m.x() = 4.0;
  const std::string edited = edited_registry_text(text, before, after);
  EXPECT_THAT(edited,
              HasSubstr("{id: 1, x_m: 1, y_m: 2, z_m: 2.6, yaw_deg: 0, sigma_m: 0.0012, sigma_deg: 0.02}"));
  EXPECT_THAT(edited, HasSubstr("{id: 2, x_m: 4, y_m: 2, z_m: 2.6, yaw_deg: 0}"));
}

}  // namespace
}  // namespace lodestar

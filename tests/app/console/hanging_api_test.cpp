#include "app/console/hanging_api.hpp"

#include <fstream>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "app/common/base64.hpp"
#include "app/placement/hanging.hpp"
#include "maps/input_error.hpp"

#include "tests/maps/temporary_folder.hpp"

// What hangs already: the file, and the documents of the page.
namespace lodestar {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

TEST(Hanging, is_read_back_as_it_was_written) {
  const TemporaryFolder folder;
  EXPECT_TRUE(load_hanging(folder / "").empty());
  const std::map<int, HungMarker> markers{
      {3, {HangingState::hung, "", "2026-01-02T03:04:05Z"}},
      {4095, {HangingState::verified, "Zoë \"of the\" ladder: {x}\n", "2026-01-02T03:04:05Z"}},
      {0, {HangingState::planned, "yes", "2026-01-02T03:04:05Z"}}};
  save_hanging(markers, folder / "");
  const std::map<int, HungMarker> read = load_hanging(folder / "");
  ASSERT_EQ(read.size(), markers.size());
  for (const auto& [id, marker] : markers) {
    EXPECT_EQ(read.at(id).state, marker.state);
    EXPECT_EQ(read.at(id).by, marker.by);
    EXPECT_EQ(read.at(id).at, marker.at);
  }
  save_hanging({}, folder / "");
  EXPECT_TRUE(load_hanging(folder / "").empty());
}

TEST(Hanging, is_refused_with_the_line) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& item) -> std::string {
    std::ofstream(folder / hanging_file_name) << "format: lodestar-hanging\nversion: 1\nmarkers:\n" << item;
    try {
      (void)load_hanging(folder / "");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refused("  - {id: 1, state: hung, at: now}\n"), "");
  EXPECT_THAT(refused("  - {id: 1, state: up, at: now}\n"),
              HasSubstr("hanging.yaml:4: found 'up', wanted planned"));
  EXPECT_THAT(refused("  - {id: 4096, state: hung, at: now}\n"), HasSubstr("hanging.yaml:4"));
  EXPECT_THAT(refused("  - {id: 1, state: hung, at: now}\n  - {id: 1, state: hung, at: now}\n"),
              HasSubstr("hanging.yaml:5: found 1 twice"));
}

class HangingApiTest : public testing::Test {
 protected:
  HangingApiTest() {
    fs::copy(fs::path(LODESTAR_SOURCE_DIR) / "sites/lab", folder_ / "site", fs::copy_options::recursive);
    site_ = load_site(folder_ / "site");
  }
  HttpResponse get(const std::string& rest = "") {
    return *api_.answer({.method = "GET", .target = "/api/hanging" + rest});
  }
  HttpResponse put(const std::string& rest, const json& sent) {
    return *api_.answer({.method = "PUT", .target = "/api/hanging" + rest, .body = sent.dump()});
  }
  json marker(int id) {
    const json all = json::parse(get().body);
    for (const json& one : all)
      if (one["id"] == id) return one;
    return nullptr;
  }

  TemporaryFolder folder_;
  Site site_;
  AuditLog audit_{folder_ / "site"};
  HangingApi api_{site_, audit_};
};

TEST_F(HangingApiTest, lists_all_saved_markers_with_the_walls_about_them) {
  const json all = json::parse(get().body);
  EXPECT_EQ(all.size(), site_.registry.markers.size());
  const json one = marker(447);
  EXPECT_EQ(one["state"], "planned");
  EXPECT_EQ(one["photo"], false);
  // The room about it is 1.3 m wide to the left wall; its centre is given to the millimetre.
  EXPECT_NEAR(one["x_m"].get<double>() - one["walls"]["left"].get<double>(), 0.1, 0.051);
  EXPECT_GT(one["walls"]["below"], 0.5);
}

TEST_F(HangingApiTest, keeps_state_and_photo_of_each_marker_by_itself) {
  const std::string jpeg = "\xFF\xD8\xFF and more";
  EXPECT_EQ(put("/447", {{"state", "hung"}, {"by", "Ada"}}).status, 200);
  EXPECT_EQ(put("/936", {{"state", "verified"}}).status, 200);
  EXPECT_EQ(put("/936/photo", {{"jpeg", base64(jpeg)}}).status, 200);
  EXPECT_EQ(marker(447)["state"], "hung");
  EXPECT_EQ(marker(447)["by"], "Ada");
  EXPECT_EQ(marker(447)["photo"], false);
  EXPECT_EQ(marker(936)["state"], "verified");
  EXPECT_EQ(get("/936.jpg").body, jpeg);
  EXPECT_EQ(get("/447.jpg").status, 404);
  EXPECT_EQ(put("/447", {{"state", "planned"}}).status, 200);
  EXPECT_EQ(marker(447)["state"], "planned");
}

TEST_F(HangingApiTest, refuses_what_is_no_marker_no_state_and_no_photo) {
  EXPECT_EQ(put("/1", {{"state", "hung"}}).status, 422);
  EXPECT_EQ(put("/447", {{"state", "up"}}).status, 422);
  EXPECT_EQ(put("/447", {{"state", "hung"}, {"by", std::string(41, 'a')}}).status, 422);
  EXPECT_EQ(put("/447/photo", {{"jpeg", base64("GIF89a")}}).status, 422);
  EXPECT_EQ(put("/447/photo", {{"jpeg", 7}}).status, 422);
  EXPECT_EQ(put("/../447", {{"state", "hung"}}).status, 404);
  EXPECT_EQ(get("/../../etc/passwd.jpg").status, 404);
  EXPECT_FALSE(fs::exists(site_.folder / hanging_file_name));
}

}  // namespace
}  // namespace lodestar

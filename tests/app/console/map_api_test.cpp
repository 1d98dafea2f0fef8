#include <fstream>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "app/common/base64.hpp"
#include "app/console/document_api.hpp"

#include "tests/maps/temporary_folder.hpp"

// A map that somebody has drawn on, as the page saves it.
namespace lodestar {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

class MapApiTest : public testing::Test {
 protected:
  MapApiTest() {
    fs::copy(fs::path(LODESTAR_SOURCE_DIR) / "sites/lab", site_, fs::copy_options::recursive);
    documents_.emplace(site_, folder_ / "runs");
    documents_->on_saved_map([this] { ++told_; });
  }
  HttpResponse read() { return documents_->answer({.method = "GET", .target = "/api/map/cells"}); }
  HttpResponse save(const std::string& cells, const std::string& etag) {
    return documents_->answer({.method = "PUT",
                               .target = "/api/map/cells",
                               .if_match = etag,
                               .body = json{{"cells", base64(cells)}}.dump()});
  }

  TemporaryFolder folder_;
  fs::path site_ = folder_ / "site";
  std::optional<DocumentApi> documents_;
  int told_ = 0;
};

TEST_F(MapApiTest, is_saved_with_what_was_before_beside_it) {
  const HttpResponse before = read();
  std::string cells = before.body;
  const std::size_t at = 1000;
  const auto old = static_cast<std::int8_t>(cells[at]);
  cells[at] = old == 100 ? 0 : 100;
  EXPECT_EQ(save(cells, before.etag).status, 200);
  EXPECT_EQ(told_, 1);
  EXPECT_EQ(save(cells, before.etag).status, 409);  // until it is loaded anew

  const Site site = load_site(site_);
  EXPECT_EQ(site.map.map.cells, std::vector<std::int8_t>(cells.begin(), cells.end()));
  std::vector<fs::path> kept;
  for (const auto& one : fs::directory_iterator(site_ / ".history" / "map")) kept.push_back(one.path());
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_EQ(load_map(kept.front() / "map.yaml").map.cells[at], old);
}

TEST_F(MapApiTest, is_refused_where_it_is_none_or_somebody_was_faster) {
  const HttpResponse before = read();
  std::string wrong = before.body;
  wrong.back() = 101;
  EXPECT_THAT(save(wrong, before.etag).body, HasSubstr("found 101, wanted -1 to 100"));
  EXPECT_THAT(save("abc", before.etag).body, HasSubstr("cells: found 3, wanted"));
  EXPECT_EQ(save(before.body, "\"other\"").status, 412);
  EXPECT_EQ(save(before.body, before.etag).status, 200);  // nothing has changed
  EXPECT_EQ(told_, 0);
  EXPECT_FALSE(fs::exists(site_ / ".history" / "map"));
}

TEST_F(MapApiTest, is_kept_as_it_is_where_a_robot_runs_on_it) {
  documents_.emplace(site_, folder_ / "runs");
  const HttpResponse before = read();
  EXPECT_EQ(save(before.body, before.etag).status, 409);
}

}  // namespace
}  // namespace lodestar

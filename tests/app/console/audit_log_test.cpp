#include "app/console/audit_log.hpp"

#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <optional>

#include "app/console/document_api.hpp"
#include "app/console/history_json.hpp"

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

TEST(AuditLog, shows_the_newest_first_and_keeps_them_for_the_next_program) {
  const TemporaryFolder folder;
  {
    AuditLog log(folder.path());
    log.note({.by = "Ada", .what = "saved the markers", .document = "markers", .state = 3});
    log.note({.what = "client 1 (Ben): go to (1.00, 2.00)", .document = {}});
    EXPECT_EQ(log.newest()[0]["what"], "client 1 (Ben): go to (1.00, 2.00)") << "at once, written or not";
  }
  const AuditLog next(folder.path());
  ASSERT_EQ(next.newest().size(), 2U);
  EXPECT_EQ(next.newest()[1]["by"], "Ada");
  EXPECT_EQ(next.author_of("markers", 3), "Ada");
  EXPECT_EQ(next.author_of("places", 3), "");
  EXPECT_EQ(next.author_of("markers", 4), "");
}

TEST(AuditLog, passes_over_lines_that_are_none) {
  const TemporaryFolder folder;
  fs::create_directories(folder / ".history");
  std::ofstream(folder / ".history" / "log.jsonl")
      << "{\"at\":\"2026-11-26T09:05:00Z\",\"by\":\"Ada\",\"what\":\"saved\"}\n[1]\n{\"by\":7}\n{\"at\":\"20";
  const AuditLog log(folder.path());
  ASSERT_EQ(log.newest().size(), 1U);
  EXPECT_EQ(log.newest()[0]["by"], "Ada");
}

TEST(AuditLog, begins_a_new_file_at_a_mebibyte_and_keeps_the_one_before) {
  const TemporaryFolder folder;
  const std::string long_words(10'000, 'x');
  for (int i = 0; i < 120; ++i) {
    AuditLog log(folder.path());  // each waits until its line is written
    log.note({.what = long_words, .document = {}});
  }
  EXPECT_TRUE(fs::exists(folder / ".history" / "log.1.jsonl"));
  EXPECT_LT(fs::file_size(folder / ".history" / "log.jsonl"), 1U << 20U);
}

TEST(AuditLog, of_a_folder_that_cannot_be_written_still_shows_what_it_was_told) {
  const TemporaryFolder folder;
  std::ofstream(folder / ".history") << "a file in the way";
  AuditLog log(folder.path());
  log.note({.by = "Ada", .what = "saved", .document = {}});
  EXPECT_EQ(log.newest().size(), 1U);
}

TEST(AuditLog, of_a_console_tells_who_saved_what_and_when) {
  const TemporaryFolder folder;
  const fs::path site = folder / "site";
  fs::copy(fs::path(LODESTAR_SOURCE_DIR) / "sites/lab", site, fs::copy_options::recursive);
  fs::remove_all(site / ".history");  // of whoever served it there
  std::optional<DocumentApi> console(std::in_place, site, folder / "runs");
  const auto get = [&](const char* target) { return console->answer({.method = "GET", .target = target}); };
  json registry = json::parse(get("/api/markers").body);
  registry["markers"][0]["z_m"] = 2.7;
  registry["markers"].erase(3);
  const HttpResponse saved = console->answer({.method = "PUT",
                                              .target = "/api/markers",
                                              .client_name = "Z%C3%B6e%0A",
                                              .if_match = get("/api/markers").etag,
                                              .body = registry.dump()});
  ASSERT_EQ(saved.status, 200);
  const json states = json::parse(get("/api/markers/history").body);
  ASSERT_EQ(states.size(), 1U);
  EXPECT_EQ(states[0]["by"], "Zöe") << "without control characters";
  EXPECT_THAT(states[0]["at"].get<std::string>(), ::testing::MatchesRegex("20..-..-..T..:..:..Z"));
  (void)console->answer({.method = "PUT",
                         .target = "/api/markers",
                         .client_name = "%FF" + std::string(38, 'x') + "%C3%B6%C3%B6",
                         .if_match = "*",
                         .body = registry.dump()});  // nothing changed: nobody saved
  const json log = json::parse(get("/api/log").body);
  ASSERT_EQ(log.size(), 1U);
  EXPECT_EQ(log[0]["by"], "Zöe");
  EXPECT_EQ(log[0]["what"], "saved the markers: 1 changed, 0 added, 1 removed");
  console.reset();
  console.emplace(site, folder / "runs");  // it reads what the one before wrote
  EXPECT_EQ(json::parse(get("/api/log").body), log);
  EXPECT_EQ(json::parse(get("/api/markers/history").body), states);
}

TEST(AuditLog, names_are_cut_between_letters) {
  EXPECT_EQ(name_of({.client_name = std::string(39, 'x') + "%C3%B6"}), std::string(39, 'x'));
  EXPECT_EQ(name_of({.client_name = std::string(38, 'x') + "%C3%B6"}), std::string(38, 'x') + "ö");
  EXPECT_EQ(name_of({.client_name = "%4"}), "") << "no percent-encoding";
  EXPECT_EQ(name_of({}), "");
}

}  // namespace
}  // namespace lodestar

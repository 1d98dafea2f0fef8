#include <gmock/gmock.h>

#include "tests/scenarios/command_line.hpp"

// The commands that take a site's places, as a person calls them.
namespace lodestar {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string whole = R"(format: lodestar-places
version: 1
places:
  - {name: "desk", x_m: 2.5, y_m: 5, yaw_deg: 90}
  - {name: "door", x_m: 13.5, y_m: 2}
nodes:
  - {name: "N1", x_m: 1.7, y_m: 5}
edges:
  - {from: "N1", to: "desk", one_way: true, max_mps: 0.3}
  - {from: "desk", to: "N1", one_way: true, max_mps: 0.2}
keep_out:
  - {name: "stairs", corners_m: [[9, 2], [10, 2], [10, 3]]}
speed_zones:
  - {name: "ward", corners_m: [[5, 0], [8, 0], [8, 7.5], [5, 7.5]], max_mps: 0.25}
missions:
  - {name: "round", places: ["door", "desk"]}
)";

class PlacesCommands : public testing::Test {
 protected:
  PlacesCommands() {
    fs::copy(fs::path(LODESTAR_SOURCE_DIR) / "sites/lab", site(), fs::copy_options::recursive);
  }
  [[nodiscard]] fs::path site() const { return scratch_.path() / "site"; }
  [[nodiscard]] Ran run(const std::string& arguments) const {
    return run_lodestar(arguments, scratch_.path());
  }
  void write_places(std::string text, const std::string& piece = "", const std::string& by = "") const {
    write_text(site() / "places.yaml", text.replace(text.find(piece), piece.size(), by));
  }

  ScratchFolder scratch_;
};

TEST_F(PlacesCommands, check_says_what_is_wrong_by_exit_code_and_name) {
  write_places(whole);
  const Ran good = run("places check site");
  EXPECT_EQ(good.exit_code, 0) << good.err;
  EXPECT_EQ(good.out,
            "site/places.yaml: warning: mission 'round' sees no marker for 2.2 m from 13.5, 2.0 m\n"
            "site/places.yaml: warning: mission 'round' sees no marker for 1.3 m from 2.9, 4.2 m\n"
            "2 places, 1 nodes, 2 edges, 1 keep-outs, 1 speed zones\n");

  write_places(whole, "[10, 3]]", "[10, 3], [2, 6]]");
  const Ran bad = run("places check site");
  EXPECT_EQ(bad.exit_code, 1) << bad.err;
  EXPECT_THAT(bad.out, HasSubstr("site/places.yaml: error: 'door' cannot be reached from the start\n"));
  EXPECT_THAT(run("places check site --json").out, HasSubstr("\"severity\": \"error\""));

  write_places(whole, "to: \"desk\"", "to: \"dock\"");
  const Ran unusable = run("places check site");
  EXPECT_EQ(unusable.exit_code, 2);
  EXPECT_THAT(unusable.err, HasSubstr("places.yaml:9: found 'dock', wanted the name of a place or a node"));
}

TEST_F(PlacesCommands, export_and_import_keep_the_graph_and_what_the_format_has_not) {
  write_places(whole);
  EXPECT_EQ(run("places export site -o graph.lif").exit_code, 0);
  const Ran imported = run("places import site graph.lif");
  EXPECT_EQ(imported.exit_code, 0) << imported.err;
  EXPECT_EQ(imported.out, "2 places, 1 nodes, 2 edges\n");
  EXPECT_EQ(read_text(site() / "places.yaml"), whole);

  write_text(scratch_.path() / "no.lif", "[1, 2");
  EXPECT_EQ(run("places import site no.lif").exit_code, 2);
  EXPECT_EQ(read_text(site() / "places.yaml"), whole);
}

/// A program of the site that keeps what it is given and ends with this code.
void write_program(const fs::path& file, const std::string& last_line) {
  write_text(file, "#!/bin/sh\ncat >> picked\n" + last_line + "\n");
  fs::permissions(file, fs::perms::owner_all);
}

TEST_F(PlacesCommands, a_mission_waits_acts_and_repeats) {
  write_places(whole, "places: [\"door\", \"desk\"]",
               "stops: [{place: desk, wait_s: 3}, {place: desk, action: pick}], repeat: 2");
  const Ran unknown = run("replay site --mission round");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err,
              HasSubstr("found the action 'pick' in mission 'round', wanted one of the actions"));

  write_text(site() / "site.yaml",
             read_text(site() / "site.yaml") + "actions:\n  - {type: pick, run: [./pick], timeout_s: 10}\n");
  write_program(site() / "pick", "echo two boxes");
  const Ran done = run("replay site --mission round --json --quiet -o out");
  EXPECT_EQ(done.exit_code, 0) << done.err;
  const std::string given = read_text(site() / "picked");
  EXPECT_THAT(given, HasSubstr(R"("actionId":"stop-2","actionType":"pick")")) << "twice";
  EXPECT_THAT(given, HasSubstr(R"("x":"2.5")"));
  EXPECT_THAT(read_text(scratch_.path() / "out/summary.json"), HasSubstr("--mission 'round'"));

  write_program(site() / "pick", "echo no box; exit 3");
  const Ran failed = run("replay site --mission round --quiet -o out");
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_THAT(failed.out, HasSubstr("pick: exit code 3: no box"));
}

TEST_F(PlacesCommands, replay_goes_to_a_place_by_name) {
  write_places(whole);
  const Ran there = run("replay site --goal desk --quiet -o out");
  EXPECT_EQ(there.exit_code, 0) << there.err;
  EXPECT_THAT(there.out, HasSubstr("(2.50, 5.00): reached"));
  const Ran nowhere = run("replay site --goal dor --quiet -o nowhere");
  EXPECT_EQ(nowhere.exit_code, 2);
  EXPECT_THAT(nowhere.err, HasSubstr("--goal: found 'dor', wanted X,Y"));
  EXPECT_THAT(nowhere.err, HasSubstr("a place such as 'door', 'desk'"));
}

}  // namespace
}  // namespace lodestar

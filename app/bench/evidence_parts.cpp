#include "app/bench/evidence_parts.hpp"

#include "app/bench/evidence_readers.hpp"

namespace lodestar {
namespace {

constexpr const char* times_of_here =
    "that another machine, or this one while it does other work, takes the same time";

EvidencePart localize_part() {
  return {.name = "localize",
          .title = "Localization on rendered frames, beside AprilTag 3 and ArUco",
          .arguments = {"bench", "localize", "--sweep", "none", "--frames", "1000", "--json", "--quiet"},
          .quick_arguments = {"bench", "localize", "--sweep", "none", "--trials", "1", "--frames", "4",
                              "--json", "--quiet"},
          .promises = {"3 markers: detect, decode and pose over cv::threshold", "pose errors over the bound",
                       "wrong IDs", "markers read on each kind of ceiling",
                       "from frame to pose, beside AprilTag and ArUco"},
          .read = localize_rows,
          .conclude =
              "how near the estimate is to the Cramer-Rao bound of the same frames, and how it and the "
              "peers compare when each sees its own markers from the same views",
          .not_conclude =
              "how a real lens, film or ceiling behaves; the peers' column is not their own bound, and "
              "they do not need the light that film needs"};
}

EvidencePart paper_part() {
  return {.name = "paper",
          .title = "The paper's Tables 1 to 3",
          .arguments = {"bench", "paper", "--json"},
          .quick_arguments = {"bench", "paper", "--json"},
          .promises = {"Table 1: identified", "Table 2: mean deviation of the angle",
                       "Table 3: mean deviation of the position"},
          .read = paper_rows,
          .conclude = "what the paper's method and ours reach on the same rendered frames",
          .not_conclude =
              "that the paper's own figures, taken with a real camera, were reproduced: they are printed "
              "as the limit only"};
}

EvidencePart octile_part() {
  return {
      .name = "plan-octile",
      .title = "8-connected planning on a MovingAI map",
      .arguments = {"bench", "plan", "--map", "{needs}", "--scen", "{needs}.scen", "--json"},
      .quick_arguments = {"bench", "plan", "--map", "{needs}", "--scen", "{needs}.scen", "--json"},
      .needs = "tests/data/rooms.map",
      .promises = {"queries answered with the optimal length", "time over that of plain A*"},
      .read = octile_rows,
      .conclude = "that the search is optimal on these queries, and faster than plain A* in the same process",
      .not_conclude =
          "the ratio on other maps: the benchmark's maps are not in the source tree; `bench plan "
          "--map F.map --scen F.scen` takes them"};
}

EvidencePart ragged_part(const std::string& name, const std::string& title, const std::string& map) {
  return {.name = name,
          .title = title,
          .arguments = {"bench", "plan", "--generated", map, "--queries", "200", "--json"},
          .quick_arguments = {"bench", "plan", "--generated", map, "--queries", "3", "--json"},
          .promises = {"time of a plan, 99 %", "time of a plan, longest", "travel time over the best known"},
          .read = map_rows,
          .conclude =
              "how long the default planner takes on a map of this raggedness, and how near its path is to "
              "the best that is known",
          .not_conclude = std::string(times_of_here) + "; the best known is no proven optimum"};
}

EvidencePart site_part() {
  return {
      .name = "plan-site",
      .title = "All kinds of planners in the lab, side by side",
      .arguments = {"bench", "plan", "--site", "{needs}", "--queries", "20", "--planner", "fastest",
                    "anyangle", "astar", "rrtstar", "bitstar", "--json"},
      .quick_arguments = {"bench", "plan", "--site", "{needs}", "--queries", "3", "--planner", "fastest",
                          "anyangle", "astar", "bitstar", "--json"},
      .needs = "sites/lab",
      .promises = {"time of a plan by the default planner", "travel time over the best path of all planners"},
      .read = site_rows,
      .conclude =
          "how the default planner and OMPL's compare on the same random queries with the same checks",
      .not_conclude = "how OMPL's planners do with other settings or longer limits"};
}

EvidencePart survey_part() {
  return {.name = "survey",
          .title = "Registries by driving",
          .arguments = {"bench", "survey", "--seeds", "3", "--json"},
          .quick_arguments = {"bench", "survey", "--seeds", "1", "--only", "lab, lanes both ways", "--json"},
          .promises = {"RMS and worst marker of each tour"},
          .read = survey_rows,
          .conclude =
              "errors of surveyed registries in simulated worlds with tilted markers, slip, sway and a wrong "
              "mount, against the smallest possible",
          .not_conclude =
              "ratios to the bound from three seeds: half of a print's error is one number a seed; "
              "`--seeds 20` judges them too"};
}

EvidencePart spoiled_part() {
  return {
      .name = "survey-spoiled",
      .title = "Surveys of logs with something wrong in them",
      .arguments = {"bench", "survey", "--spoiled", "300", "--json"},
      .quick_arguments = {"bench", "survey", "--spoiled", "6", "--json"},
      .promises = {"registries silently wrong"},
      .read = spoiled_rows,
      .conclude = "that none of these logs gave a registry that its own covariance excludes without a word",
      .not_conclude = "anything about mistakes of other kinds"};
}

EvidencePart campaign_part(bool with_people) {
  EvidencePart part{.name = with_people ? "campaign-people" : "campaign",
                    .title = with_people ? "Missions with people and faults in random buildings"
                                         : "Missions with faults in random buildings",
                    .arguments = {"campaign", "300", "--quiet", "-o"},
                    .quick_arguments = {"campaign", "3", "--quiet", "-o"},
                    .needs = "sites/lab",
                    .promises = {"missions with a contact", "missions that arrived silently wrong"},
                    .read = campaign_rows,
                    .conclude = "that these missions, each repeatable by its number, ended as counted",
                    .not_conclude =
                        "a rate below 3 in the number of missions, nor anything about faults, buildings and "
                        "people of other kinds; docs/safety.md has 10,000"};
  for (auto* const arguments : {&part.arguments, &part.quick_arguments}) {
    arguments->push_back("{folder}/" + part.name);
    if (with_people) arguments->push_back("--people");
  }
  if (with_people) part.promises.push_back("contacts with people while the robot moved");
  return part;
}

EvidencePart scenario_part(const std::string& name) {
  return {.name = name,
          .title = "The scenario " + name,
          .arguments = {"scenario", "{needs}", "--seeds", "10", "--json"},
          .quick_arguments = {"scenario", "{needs}", "--seeds", "1", "--json"},
          .needs = "scenarios/" + name + ".yaml",
          .promises = {"runs that arrive", "contacts while the robot moved"},
          .read = scenario_rows,
          .conclude = "how drives through this world end, judged by the simulated truth (docs/scenario.md)",
          .not_conclude = "that a robot which stands is never walked into, or that people move as discs do"};
}

EvidencePart benchmark_part(const std::string& program, const std::string& title,
                            const std::vector<std::string>& promises, const std::string& only) {
  EvidencePart part{.name = program,
                    .title = title,
                    .program = program,
                    .arguments = {"--benchmark_format=json"},
                    .quick_arguments = {"--benchmark_format=json", "--benchmark_min_time=0.01"},
                    .promises = promises,
                    .read = program == "control_bench" ? scan_rows : timing_rows,
                    .conclude = "CPU time of one thread for one call on this processor",
                    .not_conclude = times_of_here};
  for (auto* const arguments : {&part.arguments, &part.quick_arguments})
    if (!only.empty()) arguments->push_back("--benchmark_filter=" + only);
  return part;
}

}  // namespace

std::vector<EvidencePart> evidence_parts() {
  return {localize_part(),
          paper_part(),
          octile_part(),
          ragged_part("plan-offices", "Plans on a ragged map: offices, 60 m, cells of 2 cm", "offices-2cm"),
          ragged_part("plan-posts", "Plans among 6000 posts, 40 m, cells of 5 cm", "posts-6000"),
          site_part(),
          survey_part(),
          spoiled_part(),
          campaign_part(false),
          campaign_part(true),
          scenario_part("crossing-people"),
          scenario_part("corridor"),
          scenario_part("static-clutter"),
          benchmark_part("control_bench", "One scan of 720 beams: protective field, obstacle memory, corners",
                         {"field/720_beams", "memory/720_beams", "corners/720_beams"}, ""),
          benchmark_part("drivers_bench", "Ray casting: 720 beams over the map, and a whole simulated scan",
                         {"cast_720_beams", "simulate_a_scan"}, "720_beams|simulate_a_scan"),
          benchmark_part("maps_bench", "An occupancy map from scans", {"add_scan"}, "")};
}

}  // namespace lodestar

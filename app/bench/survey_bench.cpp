#include "app/bench/survey_bench.hpp"

#include <algorithm>
#include <cmath>

#include "app/bench/survey_bound.hpp"
#include "app/common/stopwatch.hpp"
#include "maps/chi_square.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

constexpr double ceiling_m = 2.6;
constexpr double known_print = 1e-4;
constexpr std::uint64_t print_stream = 11;
constexpr std::uint64_t anchor_stream = 12;
constexpr std::uint64_t spoiling_stream = 13;

std::vector<Vec2> joined(std::vector<Vec2> way, const std::vector<Vec2>& more) {
  way.insert(way.end(), more.begin(), more.end());
  return way;
}

/// The markers nearest to the corners, as a person measures them to 3 mm.
std::vector<Anchor> corner_anchors(const std::vector<RegisteredMarker>& markers,
                                   const SurveyScenario& scenario, std::uint64_t seed) {
  constexpr double sigma_m = 0.003;
  Random random = Random(seed).stream(anchor_stream);
  const std::vector<Vec2> corners{
      {0.0, 0.0}, {scenario.width_m, scenario.depth_m}, {scenario.width_m, 0.0}, {0.0, scenario.depth_m}};
  std::vector<Anchor> anchors;
  for (int i = 0; i < std::min<int>(scenario.anchors, static_cast<int>(corners.size())); ++i) {
    const Vec2& corner = corners[static_cast<std::size_t>(i)];
    const RegisteredMarker& nearest = *std::ranges::min_element(
        markers, {},
        [&](const RegisteredMarker& marker) { return (marker.position_m.head<2>() - corner).norm(); });
    const Vec2 off(sigma_m * random.normal(), sigma_m * random.normal());
    anchors.push_back(
        {MarkerAnchor{.id = nearest.id, .position_m = nearest.position_m.head<2>() + off, .sigma_m = sigma_m},
         i + 1});
  }
  return anchors;
}

/// Of a lab in which every marker is seen on lanes both ways.
SurveyLimits lab_limits() {
  return {.most_rms_m = 0.0008,
          .most_over_bound = 1.15,
          .least_nees = 0.8,
          .most_nees = 1.25,
          .most_over_true_fix = 1.1,
          .most_lost_fixes = 0.01,
          .most_mount_m = 0.001,
          .most_mount_rad = radians(0.05)};
}

/// Of a hall of 60 x 40 m. That the print is known to 1e-4 is 2.1 mm there, whoever surveys: what the survey
/// itself adds is the shape.
SurveyLimits hall_limits(int anchors) {
  SurveyLimits limits{.most_shape_m = 0.002, .least_nees = 0.8, .most_nees = 1.25, .most_lost_fixes = 0.01};
  if (anchors > 0) limits.most_rms_m = 0.006;
  return limits;
}

SurveyScenario lab(std::string name, std::vector<Vec2> way) {
  return {.name = std::move(name), .way_m = std::move(way)};
}

SurveyScenario hall(std::string name, std::vector<Vec2> way, int anchors) {
  return {.name = std::move(name),
          .width_m = 60.0,
          .depth_m = 40.0,
          .pitch_m = 2.0,
          .way_m = std::move(way),
          .anchors = anchors};
}

SurveyScenario corridor(std::string name, double length_m, int anchors) {
  return {.name = std::move(name),
          .width_m = length_m,
          .depth_m = 2.0,
          .pitch_m = 2.0,
          .way_m = {{0.5, 1.0}, {length_m - 0.5, 1.0}, {0.5, 1.0}},
          .anchors = anchors};
}

std::vector<Vec2> lab_lanes_and_cross() {
  return joined(mower_lanes(15.0, 7.5, 1.5, 0.8), cross_lanes(15.0, 7.5, 2.2, 0.8));
}

/// Frames in which a marker is seen.
std::vector<std::size_t> frames_with(int id, const SurveyLog& log) {
  std::vector<std::size_t> frames;
  for (std::size_t i = 0; i < log.frames.size(); ++i)
    if (std::ranges::find(log.frames[i].markers, id, &SightedMarker::id) != log.frames[i].markers.end())
      frames.push_back(i);
  return frames;
}

/// Two markers change places when half of the first one's sightings are done, for a quarter of the drive. Had
/// they hung the other way round whenever they were seen, nobody could know.
void swap_two_ids(SurveyLog& log, Random& random) {
  const auto any_id = [&] {
    const std::vector<SightedMarker>* markers = nullptr;
    do markers = &log.frames[random.below(log.frames.size())].markers;
    while (markers->empty());
    return (*markers)[random.below(markers->size())].id;
  };
  const int a = any_id();
  int b = a;
  while (b == a) b = any_id();
  const std::vector<std::size_t> with_a = frames_with(a, log);
  const std::size_t begin = with_a[with_a.size() / 2];
  const std::size_t end = std::min(log.frames.size(), begin + log.frames.size() / 4);
  for (std::size_t i = begin; i < end; ++i) {
    for (SightedMarker& marker : log.frames[i].markers) {
      if (marker.id != a && marker.id != b) continue;
      marker.id = marker.id == a ? b : a;
      // What does not belong to the other's dots is left out, as a reader would.
      MarkerDots kept;
      for (const MarkerDot& dot : marker.dots)
        if (has_dot(marker.id, dot.cell)) kept.push_back(dot);
      marker.dots = kept;
    }
  }
}

}  // namespace

std::vector<SurveyScenario> survey_scenarios() {
  const std::vector<Vec2> rows = mower_lanes(60.0, 40.0, 2.0, 1.0);
  const std::vector<Vec2> grid = joined(rows, cross_lanes(60.0, 40.0, 10.0, 1.0));
  SurveyScenario both_ways = lab("lab, lanes both ways", lab_lanes_and_cross());
  both_ways.limits = lab_limits();
  SurveyScenario by_rows = hall("hall, rows alone", rows, 0);
  SurveyScenario by_lanes = hall("hall, lanes every 10 m", grid, 0);
  by_lanes.limits = hall_limits(0);
  SurveyScenario by_two = hall("hall, lanes every 10 m, 2 anchors", grid, 2);
  by_two.limits = hall_limits(2);
  SurveyScenario anchored = lab("lab, lanes both ways, 4 anchors", lab_lanes_and_cross());
  anchored.anchors = 4;
  return {lab("lab, one pass", {{0.8, 3.75}, {14.2, 3.75}}),
          lab("lab, loop", {{1.0, 1.0}, {14.0, 1.0}, {14.0, 6.5}, {1.0, 6.5}, {1.0, 1.0}, {3.0, 1.0}}),
          lab("lab, lanes", mower_lanes(15.0, 7.5, 1.5, 0.8)),
          both_ways,
          anchored,
          corridor("corridor of 20 m", 20.0, 0),
          corridor("corridor of 60 m, 2 anchors", 60.0, 2),
          by_rows,
          by_lanes,
          by_two};
}

SurveyTrial try_survey(const SurveyScenario& scenario, std::uint64_t seed, bool has_exact_print) {
  SurveyWorldOptions options;
  if (!has_exact_print) options.print_scale = 1.0 + known_print * Random(seed).stream(print_stream).normal();
  const SurveyWorld world = make_survey_world(
      marker_grid(scenario.width_m, scenario.depth_m, scenario.pitch_m, ceiling_m, seed), options, seed);
  const SurveyDrive drive = drive_survey(world, scenario.way_m, seed);
  Anchors anchors{.anchors = corner_anchors(world.markers, scenario, seed),
                  .print_scale = {1.0, known_print}};
  SurveyOptions survey_options;
  survey_options.least_sightings = 1;  // errors of badly seen markers count too
  survey_options.most_sigma_m = 1.0;
  const Stopwatch watch;
  double solve_s = 0.0;
  survey_options.before_covariance = [&] { solve_s = watch.seconds(); };
  const MarkerSurvey survey =
      survey_markers(std::span(&drive.log, 1), world.camera, world.belief, anchors, survey_options);
  SurveyTrial trial{
      .length_m = drive.length_m, .solve_s = solve_s, .covariance_s = watch.seconds() - solve_s};
  trial.refused = !survey.flaws.empty();
  if (trial.refused) {
    trial.why = std::string(to_string(survey.flaws.front().flaw)) + ": " + survey.flaws.front().found;
    return trial;
  }
  trial.markers = survey.markers.size();
  trial.keyframes = survey.keyframes;
  trial.errors = survey_errors(survey, world.markers);
  trial.bound_m = survey_bound_m(world, drive, anchors, survey_options).value_or(0.0);
  const Eigen::Isometry3d& mount = survey.mount.base_from_camera;
  const Eigen::Isometry3d& true_mount = world.options.base_from_camera;
  trial.mount_off_m = (mount.translation() - true_mount.translation()).head<2>().norm();
  trial.mount_off_rad = Eigen::AngleAxisd(mount.linear().transpose() * true_mount.linear()).angle();
  trial.fixes = fix_errors(world, survey, scenario.way_m, seed);
  return trial;
}

std::string to_string(Spoiling spoiling) {
  switch (spoiling) {
    case Spoiling::swapped_id:
      return "swapped ID";
    case Spoiling::clock_shift:
      return "clock shift";
    case Spoiling::slip:
      return "slip";
    case Spoiling::lens:
      return "lens";
    case Spoiling::moved_anchor:
      return "moved anchor";
    case Spoiling::print_scale:
      return "print scale";
  }
  return "";
}

std::vector<Spoiling> all_spoilings() {
  return {Spoiling::swapped_id, Spoiling::clock_shift,  Spoiling::slip,
          Spoiling::lens,       Spoiling::moved_anchor, Spoiling::print_scale};
}

bool SpoiledTrial::is_wrong() const {
  constexpr double least_probability = 1e-6;
  return !refused && nees > chi_square_quantile(1.0 - least_probability, freedom);
}

SpoiledTrial try_spoiled(Spoiling spoiling, std::uint64_t seed) {
  Random random = Random(seed).stream(spoiling_stream);
  SurveyScenario scenario = lab("", mower_lanes(15.0, 7.5, 1.5, 0.8));
  scenario.anchors = 4;
  SurveyWorldOptions options;
  double print_sigma = known_print;
  options.print_scale = 1.0 + known_print * random.normal();
  if (spoiling == Spoiling::clock_shift) options.wheels_late = from_seconds(random.uniform(-0.3, 0.3));
  if (spoiling == Spoiling::slip) options.slip_sigma_per_sqrt_m *= random.uniform(2.0, 20.0);
  if (spoiling == Spoiling::lens) options.k1_off = random.uniform(-0.05, 0.05);
  if (spoiling == Spoiling::print_scale) options.print_scale = 1.0 + random.uniform(-0.03, 0.03);
  const SurveyWorld world = make_survey_world(
      marker_grid(scenario.width_m, scenario.depth_m, scenario.pitch_m, ceiling_m, seed), options, seed);
  SurveyDrive drive = drive_survey(world, scenario.way_m, seed);
  Anchors anchors{.anchors = corner_anchors(world.markers, scenario, seed),
                  .print_scale = {1.0, print_sigma}};
  std::size_t moved = 0;
  double moved_m = 0.0;
  if (spoiling == Spoiling::moved_anchor) {
    moved = random.below(anchors.anchors.size());
    const double direction = random.uniform(-std::numbers::pi, std::numbers::pi);
    moved_m = random.uniform(0.0, 0.3);
    std::get<MarkerAnchor>(anchors.anchors[moved].what).position_m +=
        moved_m * Vec2(std::cos(direction), std::sin(direction));
  }
  if (spoiling == Spoiling::swapped_id) swap_two_ids(drive.log, random);
  const MarkerSurvey survey =
      survey_markers(std::span(&drive.log, 1), world.camera, world.belief, anchors, SurveyOptions{});
  SpoiledTrial trial{.refused = !survey.flaws.empty()};
  if (trial.refused) {
    trial.why = std::string(to_string(survey.flaws.front().flaw));
    return trial;
  }
  const SurveyErrors errors = survey_errors(survey, world.markers);
  trial.nees = errors.nees;
  trial.freedom = errors.freedom;
  if (spoiling == Spoiling::moved_anchor)
    trial.is_said_unnoticeable = moved_m < survey.anchor_checks.at(moved).noticeable_m;
  if (spoiling == Spoiling::print_scale)
    trial.is_said_unnoticeable = std::abs(options.print_scale - 1.0) < survey.noticeable_print_scale;
  return trial;
}

}  // namespace lodestar

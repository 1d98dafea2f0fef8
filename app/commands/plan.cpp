#include <fmt/core.h>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands/commands.hpp"
#include "app/commands/format_option.hpp"
#include "app/commands/planner_options.hpp"
#include "app/common/json_text.hpp"
#include "app/common/picture_file.hpp"
#include "app/common/stopwatch.hpp"
#include "app/navigation/navigation_setup.hpp"
#include "app/placement/uncertainty_constraint.hpp"
#include "app/report/figure.hpp"
#include "app/site/arguments.hpp"
#include "maps/input_error.hpp"
#include "maps/map_file.hpp"
#include "maps/marker_registry.hpp"
#include "planning/grid_planner.hpp"

namespace lodestar {
namespace {

struct PlanArguments {
  std::string map;
  std::string markers;
  std::string camera;
  std::string mount;
  std::string robot;
  std::string start;
  std::string goal;
  std::string planner = "fastest";
  std::string format = "text";
  std::string draw;
  GridPlannerOptions options{.clearance_weight = 0.0};
  UncertaintyConstraintOptions uncertainty_constraint;
};

struct TimedPlan {
  PlanResult result;
  double microseconds = 0.0;
  double prepare_microseconds = 0.0;  ///< before: of the planner, for the map
};

TimedPlan timed_plan(const GridPlanner& planner, double prepare_us, const Goal& start, const Goal& goal) {
  const PlanHeadings headings{.start_rad = start.heading_rad, .goal_rad = goal.heading_rad};
  const Stopwatch watch;
  PlanResult result = planner.plan(start.position_m, goal.position_m, headings);
  const double microseconds = watch.microseconds();
  return {std::move(result), microseconds, prepare_us};
}

std::size_t turns_in(const Path& path) {
  return path.waypoints_m.size() < 2 ? 0 : path.waypoints_m.size() - 2;
}

nlohmann::ordered_json as_json(const TimedPlan& timed, const std::string& planner, const Goal& start,
                               const Goal& goal, const MotionLimits& limits) {
  if (const auto* failure = std::get_if<PlanFailure>(&timed.result)) {
    return {{"status", to_string(*failure)},
            {"planner", planner},
            {"length_m", nullptr},
            {"turns", nullptr},
            {"travel_time_s", nullptr},
            {"plan_us", timed.microseconds},
            {"expanded", nullptr},
            {"prepare_us", timed.prepare_microseconds},
            {"waypoints", nlohmann::ordered_json::array()}};
  }
  const Plan& plan = std::get<Plan>(timed.result);
  nlohmann::ordered_json waypoints = nlohmann::ordered_json::array();
  for (const Vec2& point : plan.path.waypoints_m) waypoints.push_back({point.x(), point.y()});
  return {{"status", "ok"},
          {"planner", planner},
          {"length_m", length_m(plan.path)},
          {"turns", turns_in(plan.path)},
          {"travel_time_s", travel_time_s(plan.path, start.heading_rad, goal.heading_rad, limits)},
          {"plan_us", timed.microseconds},
          {"expanded", plan.expanded},
          {"prepare_us", timed.prepare_microseconds},
          {"waypoints", waypoints}};
}

void print_text(const TimedPlan& timed, const nlohmann::ordered_json& summary) {
  if (std::holds_alternative<PlanFailure>(timed.result)) {
    fmt::print("no plan: {}\n", summary["status"].get<std::string>());
    return;
  }
  fmt::print("{:.3f} m, {} turns, {:.1f} s to drive; planned in {:.0f} us, {} expanded\n",
             summary["length_m"].get<double>(), summary["turns"].get<int>(),
             summary["travel_time_s"].get<double>(), timed.microseconds,
             summary["expanded"].get<std::size_t>());
  for (const Vec2& point : std::get<Plan>(timed.result).path.waypoints_m) {
    fmt::print("  {:.3f}, {:.3f}\n", point.x(), point.y());
  }
}

void warn(const LoadedMap& map) {
  for (const std::string& warning : map.warnings) fmt::print(stderr, "lodestar: warning: {}\n", warning);
}

/// A suggestion for the operator; nothing is planned to it.
void offer_nearest(const GridPlanner& planner, const Goal& start, const Goal& goal) {
  const std::optional<Vec2> nearest = planner.nearest_reachable(start.position_m, goal.position_m);
  if (!nearest) return;
  fmt::print(stderr,
             "lodestar: the nearest place that can be reached is {:.3f},{:.3f}, {:.2f} m from the goal\n",
             nearest->x(), nearest->y(), (*nearest - goal.position_m).norm());
}

/// Visibility from each cell, when the plan is constrained by it.
std::optional<Visibility> visibility_for(const PlanArguments& arguments, const OccupancyMap& map,
                                         const MarkerRegistry& registry) {
  if (!arguments.uncertainty_constraint.wanted()) return std::nullopt;
  return view_on_drives(map, registry, load_camera(arguments.camera),
                        visibility_options(load_robot(arguments.mount)), arguments.options.radius_m);
}

ExitCode plan(PlanArguments arguments) {
  const Goal start = parse_goal("--start", arguments.start);
  const Goal goal = parse_goal("--goal", arguments.goal);
  arguments.options.kind = planner_kind(arguments.planner).value();
  if (!arguments.robot.empty()) {
    const GridPlannerOptions robot = navigation_options(load_robot(arguments.robot)).planner;
    arguments.options.radius_m = robot.radius_m;
    arguments.options.footprint = robot.footprint;
    arguments.options.limits = robot.limits;
  }
  const LoadedMap loaded = load_map(arguments.map);
  warn(loaded);
  MarkerRegistry registry;
  if (!arguments.markers.empty()) registry = load_registry(arguments.markers);
  const std::optional<Visibility> visibility = visibility_for(arguments, loaded.map, registry);
  if (visibility)
    arguments.options.uncertainty_constraint =
        uncertainty_constraint(*visibility, arguments.uncertainty_constraint);

  const Stopwatch preparing;
  const GridPlanner planner(loaded.map, arguments.options);
  const TimedPlan timed = timed_plan(planner, preparing.microseconds(), start, goal);
  const nlohmann::ordered_json summary =
      as_json(timed, arguments.planner, start, goal, arguments.options.limits);
  if (arguments.format == "json") {
    fmt::print("{}", json_document(summary));
  } else {
    print_text(timed, summary);
  }
  const auto* found = std::get_if<Plan>(&timed.result);
  if (!arguments.draw.empty()) {
    write_png(arguments.draw, draw_plan(loaded.map, registry, start.position_m, goal.position_m,
                                        found ? found->path : Path{}, visibility ? &*visibility : nullptr));
  }
  if (found) return done;
  const PlanFailure failure = std::get<PlanFailure>(timed.result);
  if (failure != PlanFailure::limit_reached && failure != PlanFailure::unsure)
    offer_nearest(planner, start, goal);
  return job_failed;
}

}  // namespace

std::vector<Command> plan_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<PlanArguments>();
  CLI::App* command = lodestar.add_subcommand("plan", "Plan a path on a map; exit 1 when there is none");
  command->add_option("--map", arguments->map, "Occupancy map, ROS map_server YAML")->required();
  command->add_option("--markers", arguments->markers, "Marker registry, for the picture and for visibility");
  command->add_option("--camera", arguments->camera, "Camera file, for visibility");
  command->add_option("--mount", arguments->mount, "robot.yaml with the camera's mount, for visibility");
  add_uncertainty_constraint_options(*command, arguments->uncertainty_constraint);
  for (const char* option : {"--max-sigma", "--keep-markers"}) {
    for (const char* needed : {"--markers", "--camera", "--mount"})
      command->get_option(option)->needs(command->get_option(needed));
  }
  command->add_option("--start", arguments->start, "X,Y[,DEG] in metres and degrees in the map frame")
      ->required();
  command->add_option("--goal", arguments->goal, "X,Y[,DEG] in metres and degrees in the map frame")
      ->required();
  command
      ->add_option(
          "--planner", arguments->planner,
          "fastest (turns counted), anyangle (shortest), astar (8-connected, shortened), or one of OMPL's")
      ->check(CLI::IsMember(planner_names()))
      ->capture_default_str();
  command->add_option("--seed", arguments->options.sampling.seed, "Seed of sampling planners")
      ->check(CLI::Range(1, 2147483647))
      ->capture_default_str();
  add_sampling_options(*command, arguments->options.sampling);
  CLI::Option* radius =
      command->add_option("--radius", arguments->options.radius_m, "Robot radius in metres");
  radius->check(CLI::Range(0.0, 10.0))->capture_default_str();
  command
      ->add_option("--robot", arguments->robot,
                   "robot.yaml instead: its radius, or outline if it has one, and its limits")
      ->excludes(radius);
  command
      ->add_option("--clearance-weight", arguments->options.clearance_weight,
                   "Extra cost of driving close to obstacles; 0: shortest path")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command
      ->add_option("--clearance", arguments->options.preferred_clearance_m,
                   "Distance that counts as close, metres beyond the radius")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  add_format_option(*command, arguments->format, {"text", "json"}, "text or json");
  command->add_option("--draw", arguments->draw, "PNG file for a picture of map and path");
  return {{command, [arguments] { return plan(*arguments); }}};
}

}  // namespace lodestar

#include <cmath>
#include <fmt/core.h>
#include <memory>

#include "app/commands/commands.hpp"
#include "app/commands/shell_quoting.hpp"
#include "app/common/program_data.hpp"
#include "app/site/floor_plan.hpp"
#include "app/site/new_site.hpp"
#include "maps/input_error.hpp"
#include "maps/map_file.hpp"

// `lodestar site new`: a site folder from a plan, a map or nothing but a size.
namespace lodestar {
namespace {

namespace fs = std::filesystem;

struct SiteNewArguments {
  std::string plan;
  std::string output;
  std::vector<double> size_m;
  std::vector<double> points;
  double distance_m = 0.0;
  double resolution_m = 0.0;
  PlanOptions options;
  double rotate_deg = 0.0;
  double ceiling_m = 2.6;
  std::string robot = "agilex";
  std::string robot_file;
  std::optional<double> radius_m;
  std::optional<double> camera_height_m;
  std::string camera = "wide";
};

/// By two points and their distance, or as given; nothing: the plan itself must say.
std::optional<double> metres_per_unit(const SiteNewArguments& arguments) {
  if (arguments.resolution_m > 0.0) return arguments.resolution_m;
  if (arguments.points.empty()) return std::nullopt;
  const double apart =
      std::hypot(arguments.points[2] - arguments.points[0], arguments.points[3] - arguments.points[1]);
  if (apart <= 0.0) throw InputError("--points: found the same point twice, wanted two");
  return arguments.distance_m / apart;
}

bool is_map(const fs::path& plan) {
  return plan.extension() == ".yaml" || plan.extension() == ".yml";
}

MapFromPlan chosen_map(const SiteNewArguments& arguments) {
  PlanOptions options = arguments.options;
  options.metres_per_unit = metres_per_unit(arguments);
  options.rotate_rad = radians(arguments.rotate_deg);
  if (arguments.plan.empty()) {
    if (arguments.size_m.empty()) throw InputError("found neither a plan nor --size, wanted one of them");
    return {empty_hall(arguments.size_m[0], arguments.size_m[1], options.cell_m), {}};
  }
  if (!arguments.size_m.empty()) throw InputError("found a plan and --size, wanted one of them");
  if (!is_map(arguments.plan)) return map_from_plan(arguments.plan, options);
  if (options.metres_per_unit || options.rotate_rad != 0.0)
    throw InputError(arguments.plan, 0, "a map with a scale or --rotate", "neither: a map has both");
  LoadedMap loaded = load_map(arguments.plan);
  return {std::move(loaded.map), std::move(loaded.warnings)};
}

/// A camera of the lab by its name, or a file.
NewSite chosen_site(const SiteNewArguments& arguments) {
  NewSite site;
  const fs::path lab = program_data("sites/lab");
  site.robot_file = arguments.robot_file.empty() ? lab / "robot.yaml" : fs::path(arguments.robot_file);
  site.base_protocol = arguments.robot;
  site.radius_m = arguments.radius_m;
  site.camera_height_m = arguments.camera_height_m;
  site.camera_profile = arguments.camera == "paper" ? "paper" : "wide";
  site.camera_file = arguments.camera == "wide"    ? lab / "camera.yaml"
                     : arguments.camera == "paper" ? lab / "camera_paper.yaml"
                                                   : fs::path(arguments.camera);
  return site;
}

std::string shell_word(const std::string& word) {
  const bool is_plain = word.find_first_not_of(
                            "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                            "0123456789_-./") == std::string::npos;
  return is_plain ? word : shell_quoted(word);
}

void say_next(const SiteNewArguments& arguments, const OccupancyMap& map) {
  const std::string site = shell_word(arguments.output);
  fmt::print("{}: {:.2f} x {:.2f} m, cells of {} m, no markers yet\n", arguments.output,
             map.columns * map.resolution_m, map.rows * map.resolution_m, map.resolution_m);
  fmt::print(
      "next:\n"
      "  lodestar markers fill {0} --ceiling {1}      places for markers\n"
      "  lodestar markers plan {0} -o plan.csv        where to hang them, with wall distances\n"
      "  lodestar markers check --site {0}            what is still missing\n"
      "  lodestar replay {0}                          the first drive, in simulation\n"
      "on the robot: `camera:` and `base:` in {0}/site.yaml, `camera_mount` in robot.yaml, then\n"
      "  lodestar doctor {0}, and lodestar survey {0} LOG once the markers hang\n",
      site, arguments.ceiling_m);
}

ExitCode make_new_site(const SiteNewArguments& arguments) {
  if (arguments.points.empty() != (arguments.distance_m <= 0.0))
    throw InputError("--points and --distance: found one of them, wanted both");
  NewSite site = chosen_site(arguments);
  MapFromPlan planned = chosen_map(arguments);
  for (const std::string& warning : planned.warnings) fmt::print(stderr, "lodestar: warning: {}\n", warning);
  site.map = std::move(planned.map);
  make_site(site, arguments.output);
  say_next(arguments, site.map);
  return done;
}

void add_scale_options(CLI::App& command, SiteNewArguments& arguments) {
  CLI::Option* resolution =
      command
          .add_option("--resolution", arguments.resolution_m,
                      "Scale: metres for a pixel of the picture, or for a unit of the drawing")
          ->check(CLI::Range(1e-6, 1000.0));
  command
      .add_option("--points", arguments.points,
                  "Scale by two points whose distance is known: pixels from the picture's upper left corner "
                  "(of a PDF at 150 per inch), or units of a drawing")
      ->delimiter(',')
      ->expected(4)
      ->type_name("X1,Y1,X2,Y2")
      ->excludes(resolution);
  command.add_option("--distance", arguments.distance_m, "Metres between these points")
      ->check(CLI::Range(0.01, 10'000.0));
  command.add_option("--rotate", arguments.rotate_deg, "Turn the plan counter-clockwise by so many degrees")
      ->check(CLI::Range(-360.0, 360.0));
  command
      .add_option("--threshold", arguments.options.darkest_free,
                  "Gray values below this one are walls: 0 black .. 255 white")
      ->check(CLI::Range(1, 255))
      ->capture_default_str();
  command.add_option("--cell", arguments.options.cell_m, "Side of the map's cells in metres")
      ->check(CLI::Range(0.005, 1.0))
      ->capture_default_str();
}

}  // namespace

std::vector<Command> site_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<SiteNewArguments>();
  CLI::App* site = lodestar.add_subcommand("site", "Make a site folder");
  site->require_subcommand(1);
  CLI::App* command = site->add_subcommand(
      "new", "Make a complete site folder from a plan, a map, or the size of an empty hall");
  command->add_option("plan", arguments->plan,
                      "Plan: .png .jpg .pgm .bmp, .pdf (first page), .dxf, or a map's .yaml");
  command->add_option("-o,--output", arguments->output, "Site folder to make; it must not exist")->required();
  command->add_option("--size", arguments->size_m, "Without a plan: an empty hall of so many metres")
      ->delimiter(',')
      ->expected(2)
      ->type_name("W,H")
      ->check(CLI::Range(0.1, 10'000.0));
  add_scale_options(*command, *arguments);
  command->add_option("--ceiling", arguments->ceiling_m, "Height of the ceiling in metres, for the next step")
      ->check(CLI::Range(1.5, 30.0))
      ->capture_default_str();
  command->add_option("--robot", arguments->robot, "The base's protocol: agilex or odrive")
      ->check(CLI::IsMember({"agilex", "odrive"}))
      ->capture_default_str();
  command->add_option("--robot-file", arguments->robot_file, "robot.yaml to begin with; default: the lab's");
  command
      ->add_option("--radius", arguments->radius_m, "The robot's radius in metres; default: as in robot.yaml")
      ->check(CLI::Range(0.01, 5.0));
  command
      ->add_option("--camera-height", arguments->camera_height_m,
                   "Of its camera above the floor in metres; default: as in robot.yaml")
      ->check(CLI::Range(0.0, 10.0));
  command
      ->add_option("--camera", arguments->camera, "Camera to begin with: wide, paper (the lab's), or a file")
      ->capture_default_str();
  return {{command, [arguments] { return make_new_site(*arguments); }}};
}

}  // namespace lodestar

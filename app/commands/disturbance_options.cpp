#include "app/commands/disturbance_options.hpp"

#include <fmt/format.h>

namespace lodestar {

void add_disturbance_options(CLI::App& command, DisturbanceArguments& arguments) {
  const auto share = CLI::Range(0.0, 1.0);
  command.add_option("--lose-frames", arguments.values.lost_frames, "Share of frames that never arrive")
      ->check(share);
  command
      .add_option(
          "--unequal-wheels", arguments.values.unequal_wheels,
          "Share by which the left wheel rolls farther than the right one for the same encoder reading")
      ->check(CLI::Range(-0.2, 0.2));
  command
      .add_option("--remove-markers", arguments.values.removed_markers,
                  "Share of markers missing from the ceiling, drawn from the seed; those nearest to start "
                  "and goals stay")
      ->check(share);
  command.add_flag("--plain-ceiling", arguments.values.plain_ceiling,
                   "Nothing on the ceiling but markers: no joints, stains or lamps");
  command
      .add_option(
          "--hang", arguments.hung,
          "Markers that hang over the site, where they differ from its registry, which the robot goes by")
      ->check(CLI::ExistingFile);
  command
      .add_option("--misplace-markers", arguments.values.misplaced_m,
                  "Markers hang off their places by this standard deviation of x and y in metres, drawn from "
                  "the seed")
      ->check(CLI::Range(0.0, 1.0));
  command.add_option("--misturn-markers", arguments.misturned_deg, "The same of their yaw, in degrees")
      ->check(CLI::Range(0.0, 180.0));
  command
      .add_option("--tilt-markers", arguments.tilted_deg,
                  "Markers are tilted by this standard deviation about each horizontal axis, in degrees")
      ->check(CLI::Range(0.0, 20.0));
  command
      .add_option("--print-scale", arguments.values.print_scale,
                  "True size of the printed markers over the nominal one")
      ->check(CLI::Range(0.5, 2.0));
}

Disturbances disturbances_of(const DisturbanceArguments& arguments) {
  Disturbances disturbances = arguments.values;
  disturbances.misturned_rad = radians(arguments.misturned_deg);
  disturbances.tilted_rad = radians(arguments.tilted_deg);
  if (!arguments.hung.empty()) disturbances.hung = load_registry_draft(arguments.hung);
  return disturbances;
}

std::string words_of(const DisturbanceArguments& arguments) {
  const Disturbances& disturbances = arguments.values;
  std::string flags;
  if (disturbances.lost_frames) flags += fmt::format(" --lose-frames {}", *disturbances.lost_frames);
  if (disturbances.unequal_wheels) flags += fmt::format(" --unequal-wheels {}", *disturbances.unequal_wheels);
  if (disturbances.removed_markers > 0.0)
    flags += fmt::format(" --remove-markers {}", disturbances.removed_markers);
  if (disturbances.plain_ceiling) flags += " --plain-ceiling";
  if (disturbances.misplaced_m > 0.0)
    flags += fmt::format(" --misplace-markers {}", disturbances.misplaced_m);
  if (arguments.misturned_deg > 0.0) flags += fmt::format(" --misturn-markers {}", arguments.misturned_deg);
  if (arguments.tilted_deg > 0.0) flags += fmt::format(" --tilt-markers {}", arguments.tilted_deg);
  if (disturbances.print_scale != 1.0) flags += fmt::format(" --print-scale {}", disturbances.print_scale);
  if (!arguments.hung.empty()) flags += " --hang " + arguments.hung;
  return flags;
}

}  // namespace lodestar

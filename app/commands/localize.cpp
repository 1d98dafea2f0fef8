#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fmt/core.h>
#include <fmt/ranges.h>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands/commands.hpp"
#include "app/commands/format_option.hpp"
#include "app/commands/frame_arguments.hpp"
#include "app/commands/localize_methods.hpp"
#include "app/common/json_text.hpp"
#include "app/common/rounding.hpp"
#include "app/navigation/navigation_setup.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

struct LocalizeArguments {
  std::string markers;
  std::string camera;
  std::string mount;
  std::string format = "csv";
  bool upright = false;
  double tilt_sigma_deg = -1.0;
  double marker_tilt_sigma_deg = 0.0;
  bool track = false;
  FrameArguments frames;
};

PoseFixOptions fix_options(const LocalizeArguments& arguments, const std::optional<Robot>& robot) {
  PoseFixOptions options;
  PosePrior& prior = options.prior;
  if (robot) prior = pose_prior(*robot);
  if (arguments.upright) prior.tilt_sigma_rad = 0.0;
  if (arguments.tilt_sigma_deg >= 0.0) prior.tilt_sigma_rad = radians(arguments.tilt_sigma_deg);
  options.marker_tilt_sigma_rad = radians(arguments.marker_tilt_sigma_deg);
  return options;
}

void print_csv(const LocalizeRow& row) {
  const Vec3 p = row.pose.translation();
  const RollPitchYaw angles = angles_of(row.pose.linear());
  const std::string sigmas =
      row.sigmas ? fmt::format("{:.6f},{:.6f},{:.5f}", row.sigmas->x_m, row.sigmas->y_m, row.sigmas->yaw_deg)
                 : ",,";
  fmt::print("{},{:.6f},{},{:.6f},{:.6f},{:.6f},{:.5f},{:.5f},{:.5f},{},{:.4f},{}\n", csv_cell(row.file),
             seconds(row.stamp), fmt::join(row.ids, "+"), p.x(), p.y(), p.z(), degrees(angles.yaw_rad),
             degrees(angles.roll_rad), degrees(angles.pitch_rad), sigmas, row.confidence, row.dots);
}

void print_tum(const LocalizeRow& row) {
  const Vec3 p = row.pose.translation();
  const Eigen::Quaterniond q(row.pose.linear());
  fmt::print("{:.6f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}\n", seconds(row.stamp), p.x(), p.y(),
             p.z(), q.x(), q.y(), q.z(), q.w());
}

/// A number, or null.
nlohmann::ordered_json sigma_json(const LocalizeRow& row, double LocalizeSigmas::* sigma) {
  return row.sigmas ? nlohmann::ordered_json(*row.sigmas.*sigma) : nlohmann::ordered_json();
}

void print_json(const LocalizeRow& row) {
  const Vec3 p = row.pose.translation();
  const RollPitchYaw angles = angles_of(row.pose.linear());
  const nlohmann::ordered_json line{{"file", row.file},
                                    {"stamp", seconds(row.stamp)},
                                    {"ids", row.ids},
                                    {"x", p.x()},
                                    {"y", p.y()},
                                    {"z", p.z()},
                                    {"yaw_deg", degrees(angles.yaw_rad)},
                                    {"roll_deg", degrees(angles.roll_rad)},
                                    {"pitch_deg", degrees(angles.pitch_rad)},
                                    {"sigma_x", sigma_json(row, &LocalizeSigmas::x_m)},
                                    {"sigma_y", sigma_json(row, &LocalizeSigmas::y_m)},
                                    {"sigma_yaw_deg", sigma_json(row, &LocalizeSigmas::yaw_deg)},
                                    {"confidence", row.confidence},
                                    {"dots", row.dots}};
  fmt::print("{}\n", json_text(line));
}

void print_row(const std::string& format, const LocalizeRow& row) {
  if (format == "csv") print_csv(row);
  if (format == "tum") print_tum(row);
  if (format == "json") print_json(row);
}

/// Why a detected marker is not used in the fix; empty when it is.
std::string objection_to(const DetectedMarker& marker, const MarkerRegistry& registry,
                         const std::optional<LocalizeRow>& row, const std::string& why_not_used) {
  if (std::ranges::count(registry.markers, marker.id, &RegisteredMarker::id) == 0) return "not registered";
  if (registry.find(marker.id) == nullptr) return "registered twice";
  if (row && !std::ranges::count(row->ids, marker.id)) return why_not_used;
  return {};
}

std::string words_of_refusal(const std::vector<OverlayMarker>& markers) {
  if (markers.empty()) return "REFUSED: no marker read";
  const bool registered = std::ranges::any_of(markers, &std::string::empty, &OverlayMarker::objection);
  return registered ? "REFUSED: the dots agree with no pose" : "REFUSED: no marker that is registered once";
}

/// To hundredths of a degree.
double in_words_deg(double angle_rad) {
  return rounded(degrees(angle_rad), 100.0);
}

std::vector<std::string> words_of_pose(const LocalizeRow& row, const char* who) {
  constexpr double mm = 1000.0;
  const Vec3 p = row.pose.translation();
  const RollPitchYaw angles = angles_of(row.pose.linear());
  const std::string sigmas =
      row.sigmas ? fmt::format("one sigma: x {:.1f} mm, y {:.1f} mm, yaw {:.3f} deg", mm * row.sigmas->x_m,
                               mm * row.sigmas->y_m, row.sigmas->yaw_deg)
                 : "one sigma: not told by this method";
  return {fmt::format("{} at x {:.3f} m, y {:.3f} m, z {:.3f} m, yaw {:.2f} deg (roll {:.2f}, pitch {:.2f})",
                      who, p.x(), p.y(), p.z(), in_words_deg(angles.yaw_rad), in_words_deg(angles.roll_rad),
                      in_words_deg(angles.pitch_rad)),
          fmt::format("{}; from {} dots of {}", sigmas, row.dots, fmt::join(row.ids, "+"))};
}

Overlay overlay_of(const SourceFrame& frame, const LocatedFrame& located, const MarkerRegistry& registry,
                   const std::string& why_not_used, const char* who) {
  const std::optional<LocalizeRow>& row = located.row;
  Overlay overlay{.gray = frame.gray, .markers = {}, .words = {}, .accepted = row.has_value()};
  for (const DetectedMarker& marker : located.markers)
    overlay.markers.push_back({marker, objection_to(marker, registry, row, why_not_used)});
  if (row) {
    overlay.words = words_of_pose(*row, who);
  } else {
    overlay.words = {words_of_refusal(overlay.markers)};
  }
  overlay.words.push_back(fmt::format("{}   {:.3f} s", frame.name, seconds(frame.stamp)));
  return overlay;
}

/// As --method says.
std::unique_ptr<FrameLocalizer> localizer_for(const LocalizeArguments& arguments,
                                              const MarkerRegistry& registry, const CameraModel& camera,
                                              const std::optional<Robot>& robot) {
  if (arguments.frames.method != "paper") {
    return default_localizer(registry, camera, robot, fix_options(arguments, robot), arguments.track);
  }
  if (arguments.upright || arguments.tilt_sigma_deg >= 0.0 || arguments.marker_tilt_sigma_deg > 0.0 ||
      arguments.track) {
    throw InputError(
        "--method paper: found --upright, --tilt-sigma-deg, --marker-tilt-sigma-deg or --track, wanted none "
        "of "
        "them: the paper's pose is from one frame alone, with the tilt free and level markers");
  }
  return paper_localizer(registry, camera, robot);
}

ExitCode localize(const LocalizeArguments& arguments) {
  const MarkerRegistry registry = load_registry(arguments.markers);
  const CameraModel camera = load_camera(arguments.camera);
  std::optional<Robot> robot;
  if (!arguments.mount.empty()) robot = load_robot(arguments.mount);
  const std::unique_ptr<FrameLocalizer> localizer = localizer_for(arguments, registry, camera, robot);
  FrameInputs inputs = open_inputs(arguments.frames, camera);
  std::optional<OverlayFolder> overlays = open_overlays(arguments.frames, inputs);

  if (arguments.format == "csv") {
    fmt::print(
        "file,stamp,ids,x,y,z,yaw_deg,roll_deg,pitch_deg,sigma_x,sigma_y,sigma_yaw_deg,confidence,dots\n");
  }
  int frames = 0;
  int found = 0;
  while (const std::optional<SourceFrame> frame = inputs.next()) {
    const LocatedFrame located = localizer->locate(*frame);
    ++frames;
    if (overlays) {
      overlays->write(*frame, draw_overlay(overlay_of(*frame, located, registry, localizer->why_not_used(),
                                                      robot ? "Robot" : "Camera")));
    }
    if (!located.row) continue;
    ++found;
    print_row(arguments.format, *located.row);
    if (inputs.live()) std::fflush(stdout);
  }
  if (!arguments.frames.quiet) fmt::print(stderr, "pose in {} of {} frames\n", found, frames);
  return found > 0 ? done : job_failed;
}

}  // namespace

std::vector<Command> localize_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<LocalizeArguments>();
  CLI::App* command = lodestar.add_subcommand(
      "localize",
      "Pose of the camera (with --mount: of the robot) for each frame; exit 1 when no frame gives one");
  command->add_option("--markers", arguments->markers, "Marker registry")->required();
  command->add_option("--camera", arguments->camera, "Calibrated camera, camera_info YAML")->required();
  command->add_option("--mount", arguments->mount, "robot.yaml: gives the robot's pose, on a flat floor");
  CLI::Option* upright =
      command->add_flag("--upright", arguments->upright, "The tilt is exactly that of the mount");
  command
      ->add_option("--tilt-sigma-deg", arguments->tilt_sigma_deg,
                   "Standard deviation of the tilt about that of the mount, in degrees")
      ->check(CLI::Range(0.0, 45.0))
      ->excludes(upright);
  command
      ->add_option("--marker-tilt-sigma-deg", arguments->marker_tilt_sigma_deg,
                   "Standard deviation of a marker's tilt about each horizontal axis, in degrees; drives "
                   "assume 1. 0: the markers are level")
      ->check(CLI::Range(0.0, 20.0))
      ->capture_default_str();
  command->add_flag("--track", arguments->track,
                    "The frames are a sequence: search first where the last pose predicts the markers");
  add_format_option(*command, arguments->format, {"csv", "tum", "json"},
                    "One line per frame with a pose. csv; json; tum: stamp x y z qx qy qz qw");
  add_frame_arguments(*command, arguments->frames);
  command->footer(command->get_footer() +
                  "\nStamps are in seconds: a video's own time, a camera's since boot; an image's is "
                  "its\nname when that is a number (12.40.png), else its position in the list, from 0.");
  return {{command, [arguments] { return localize(*arguments); }}};
}

}  // namespace lodestar

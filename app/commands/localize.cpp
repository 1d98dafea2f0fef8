#include <cmath>
#include <fmt/core.h>
#include <fmt/ranges.h>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands/command.hpp"
#include "app/image_files.hpp"
#include "app/overlay.hpp"
#include "app/site.hpp"
#include "localization/mount.hpp"
#include "localization/marker_detector.hpp"
#include "localization/pose_fix.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

struct LocalizeArguments {
  std::string markers;
  std::string camera;
  std::string mount;
  std::string format = "csv";
  std::string draw;
  bool upright = false;
  double tilt_sigma_deg = -1.0;
  std::vector<std::string> inputs;
};

/// One row of the results: the camera's pose in the map, or the robot's when its mount is known.
struct Row {
  std::string file;
  Stamp stamp;
  std::vector<int> ids;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  double sigma_x_m = 0.0;
  double sigma_y_m = 0.0;
  double sigma_yaw_rad = 0.0;
  double confidence = 0.0;
  int dots = 0;
};

PoseFixOptions fix_options(const LocalizeArguments& arguments, const std::optional<Robot>& robot) {
  PoseFixOptions options;
  PosePrior& prior = options.prior;
  if (robot) {
    prior.tilt = rotation_from({robot->camera_mount.roll_rad, robot->camera_mount.pitch_rad, 0.0});
    prior.tilt_sigma_rad = robot->mount_tilt_sigma_rad;
    prior.height_m = robot->base_from_camera.translation().z();
    prior.height_sigma_m = robot->mount_height_sigma_m;
  }
  if (arguments.upright) prior.tilt_sigma_rad = 0.0;
  if (arguments.tilt_sigma_deg >= 0.0) prior.tilt_sigma_rad = radians(arguments.tilt_sigma_deg);
  return options;
}

Row row_of(const ImageFile& image, const PoseFix& fix, const std::optional<Robot>& robot) {
  Row row{.file = image.file, .stamp = image.stamp, .ids = fix.ids};
  Eigen::Matrix3d covariance = fix.covariance({0, 1, 5}, {0, 1, 5});
  row.pose = fix.map_from_camera;
  if (robot) {
    row.pose = fix.map_from_camera * robot->base_from_camera.inverse();
    covariance = compensate_mount(fix, robot->base_from_camera).covariance;
  }
  row.sigma_x_m = std::sqrt(covariance(0, 0));
  row.sigma_y_m = std::sqrt(covariance(1, 1));
  row.sigma_yaw_rad = std::sqrt(covariance(2, 2));
  row.confidence = fix.confidence;
  row.dots = fix.dots;
  return row;
}

void print_csv(const Row& row) {
  const Vec3 p = row.pose.translation();
  const RollPitchYaw angles = angles_of(row.pose.linear());
  fmt::print("{},{:.6f},{},{:.6f},{:.6f},{:.6f},{:.5f},{:.5f},{:.5f},{:.6f},{:.6f},{:.5f},{:.4f},{}\n",
             row.file, seconds(row.stamp), fmt::join(row.ids, "+"), p.x(), p.y(), p.z(),
             degrees(angles.yaw_rad), degrees(angles.roll_rad), degrees(angles.pitch_rad), row.sigma_x_m,
             row.sigma_y_m, degrees(row.sigma_yaw_rad), row.confidence, row.dots);
}

void print_tum(const Row& row) {
  const Vec3 p = row.pose.translation();
  const Eigen::Quaterniond q(row.pose.linear());
  fmt::print("{:.6f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}\n", seconds(row.stamp), p.x(), p.y(),
             p.z(), q.x(), q.y(), q.z(), q.w());
}

void print_json(const Row& row) {
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
                                    {"sigma_x", row.sigma_x_m},
                                    {"sigma_y", row.sigma_y_m},
                                    {"sigma_yaw_deg", degrees(row.sigma_yaw_rad)},
                                    {"confidence", row.confidence},
                                    {"dots", row.dots}};
  fmt::print("{}\n", line.dump());
}

void print_row(const std::string& format, const Row& row) {
  if (format == "csv") print_csv(row);
  if (format == "tum") print_tum(row);
  if (format == "json") print_json(row);
}

ExitCode localize(const LocalizeArguments& arguments) {
  const MarkerRegistry registry = load_registry(arguments.markers);
  const CameraModel camera = load_camera(arguments.camera);
  std::optional<Robot> robot;
  if (!arguments.mount.empty()) robot = load_robot(arguments.mount);
  const PoseFixOptions options = fix_options(arguments, robot);
  ImageFiles images(arguments.inputs);

  if (arguments.format == "csv") {
    fmt::print(
        "file,stamp,ids,x,y,z,yaw_deg,roll_deg,pitch_deg,sigma_x,sigma_y,sigma_yaw_deg,confidence,dots\n");
  }
  int found = 0;
  while (const std::optional<ImageFile> image = images.next(camera)) {
    const std::vector<DetectedMarker> markers = detect_markers(image->gray);
    const std::optional<PoseFix> fix = fix_pose(image->stamp, markers, registry, camera, options);
    if (!arguments.draw.empty())
      write_overlay(arguments.draw, image->file, draw_markers(image->gray, markers));
    if (!fix) continue;
    ++found;
    print_row(arguments.format, row_of(*image, *fix, robot));
  }
  return found > 0 ? done : job_failed;
}

}  // namespace

std::vector<Command> localize_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<LocalizeArguments>();
  CLI::App* command = lodestar.add_subcommand(
      "localize",
      "Where was the camera (or, with --mount, the robot) when it took these images; exit 1 when none tells");
  command->add_option("--markers", arguments->markers, "Marker registry")->required();
  command->add_option("--camera", arguments->camera, "Calibrated camera, camera_info YAML")->required();
  command->add_option("--mount", arguments->mount, "robot.yaml: gives the robot's pose, on a flat floor");
  CLI::Option* upright =
      command->add_flag("--upright", arguments->upright, "The tilt is exactly that of the mount");
  command
      ->add_option("--tilt-sigma-deg", arguments->tilt_sigma_deg,
                   "The tilt is that of the mount, within so much")
      ->check(CLI::Range(0.0, 45.0))
      ->excludes(upright);
  command->add_option("--format", arguments->format, "csv, tum, or json: one line an image")
      ->check(CLI::IsMember({"csv", "tum", "json"}))
      ->capture_default_str();
  command->add_option("--draw", arguments->draw, "Folder for pictures of what was seen");
  command->add_option("images", arguments->inputs, "Images, or folders of images")->required();
  return {{command, [arguments] { return localize(*arguments); }}};
}

}  // namespace lodestar

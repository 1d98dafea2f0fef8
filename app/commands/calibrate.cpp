#include <filesystem>
#include <fmt/core.h>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands/commands.hpp"
#include "app/common/json_text.hpp"
#include "app/drive/site_frames.hpp"
#include "app/frames/frame_inputs.hpp"
#include "app/frames/survey_log_file.hpp"
#include "app/placement/camera_set.hpp"
#include "app/placement/mount_set.hpp"
#include "app/site/robot_mount.hpp"
#include "app/site/site.hpp"
#include "app/site/site_folder.hpp"
#include "maps/atomic_file.hpp"
#include "maps/camera_file.hpp"
#include "maps/camera_model.hpp"
#include "maps/input_error.hpp"
#include "maps/path_kind.hpp"

namespace lodestar {
namespace {

struct CameraArguments {
  CalibrationBoard board;
  CameraCalibrationOptions options;
  std::string output;
  bool json = false;
  std::vector<std::string> images;
};

/// What other programs keep in the camera file that is replaced; nothing when there is none, or it cannot be
/// read.
std::string other_keys_in(const std::filesystem::path& file) {
  try {
    return is_file(file) ? read_camera_file(file).other_keys : "";
  } catch (const InputError&) {
    return "";
  }
}

/// A site's camera, or what the command line names.
std::unique_ptr<FrameSource> frames_of(const std::vector<std::string>& inputs) {
  if (inputs.size() == 1 && is_file(site_folder(inputs.front()) / "site.yaml"))
    return std::make_unique<SiteFrames>(open_site(inputs.front()));
  return std::make_unique<FrameInputs>(inputs, FrameInputOptions{});
}

ExitCode calibrate_camera_from_images(const CameraArguments& arguments) {
  const std::unique_ptr<FrameSource> frames = frames_of(arguments.images);
  const CameraSet set = read_camera_set(*frames, arguments.board, [](const CameraSet& so_far) {
    fmt::print(stderr, "lodestar: {}: board {}, corners in {:.0f} % of the image\n", so_far.files.back(),
               so_far.views.size(),
               100.0 * coverage_of(so_far.views, so_far.width_px, so_far.height_px).share());
  });
  const CameraCalibration calibration =
      calibrate_camera(set.views, set.width_px, set.height_px, arguments.options);
  fmt::print("{}",
             arguments.json ? json_document(json_report(set, calibration)) : text_report(set, calibration));
  for (const std::string& line : complaints(set, calibration, arguments.options)) {
    fmt::print(stderr, "lodestar: {}\n", line);
  }
  if (!calibration.flaws.empty()) return job_failed;
  const std::filesystem::path output(arguments.output);
  save_camera(calibration.fit->camera, output.stem().string(), output, other_keys_in(output));
  fmt::print(stderr, "lodestar: wrote {}\n", arguments.output);
  return done;
}

void add_board(CLI::App* command, CalibrationBoard& board) {
  const std::map<std::string, BoardKind> kinds{{"chessboard", BoardKind::chessboard},
                                               {"charuco", BoardKind::charuco}};
  constexpr double longest_m = 10.0;
  const CLI::Range side_m(1e-4, longest_m);
  command->add_option("--board", board.kind, "chessboard or charuco")
      ->required()
      ->transform(CLI::CheckedTransformer(kinds));
  command
      ->add_option("--cols", board.columns,
                   "Chessboard: inner corners in a row (one less than squares). ChArUco: squares in a row")
      ->required()
      ->check(CLI::Range(3, 200));
  command->add_option("--rows", board.rows, "The same in a column")->required()->check(CLI::Range(3, 200));
  command->add_option("--square-m", board.square_m, "Side of a square, as measured on the print")
      ->required()
      ->check(side_m);
  command->add_option("--marker-m", board.marker_m, "ChArUco: side of a marker")->check(side_m);
  command->add_option("--dictionary", board.dictionary, "ChArUco: dictionary of the markers, DICT_5X5_100");
}

Command camera_command(CLI::App* calibrate) {
  const auto arguments = std::make_shared<CameraArguments>();
  CLI::App* command = calibrate->add_subcommand(
      "camera", "Intrinsics and distortion from images of a board; exit 1, and no file, for a poor set");
  add_board(command, arguments->board);
  const std::map<std::string, LensModel> models{
      {"pinhole", LensModel::pinhole}, {"rational", LensModel::rational}, {"fisheye", LensModel::fisheye}};
  command->add_option("--model", arguments->options.model, "pinhole (the default), rational or fisheye")
      ->transform(CLI::CheckedTransformer(models));
  command->add_option("--max-rms-px", arguments->options.most_rms_px, "Largest reprojection error to accept")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "Report as JSON");
  command->add_option("-o,--output", arguments->output, "Camera file to write, camera_info YAML")->required();
  command
      ->add_option(
          "images", arguments->images,
          "Images, folders of images, a video, or a site: its camera, until the board was held still at "
          "30 places, or Ctrl-C")
      ->required();
  command->callback([command] {
    const bool is_charuco = command->get_option("--board")->as<BoardKind>() == BoardKind::charuco;
    for (const char* name : {"--marker-m", "--dictionary"}) {
      const bool is_given = command->count(name) > 0;
      if (is_charuco && !is_given) throw CLI::RequiredError(name);
      if (!is_charuco && is_given) throw CLI::ExcludesError(name, "--board chessboard");
    }
    if (is_charuco &&
        command->get_option("--marker-m")->as<double>() >= command->get_option("--square-m")->as<double>())
      throw CLI::ValidationError("--marker-m", "must be less than --square-m");
  });
  return {command, [arguments] { return calibrate_camera_from_images(*arguments); }};
}

struct MountArguments {
  std::string markers;
  std::string camera;
  std::string robot;
  std::string output;
  bool json = false;
  std::vector<std::string> inputs;  ///< the log, preceded by the site if given
};

/// The files needed to evaluate a log.
struct MountInput {
  MarkerRegistry registry;
  CameraModel camera;
  std::filesystem::path robot_file;
};

/// The site's files, each overridden by its option.
MountInput input_of(const MountArguments& arguments) {
  std::optional<Site> site;
  if (arguments.inputs.size() == 2) site = open_site(arguments.inputs.front());
  if (!site && (arguments.markers.empty() || arguments.camera.empty() || arguments.robot.empty())) {
    throw InputError("found one folder, wanted SITE LOG, or LOG with --markers, --camera and --robot");
  }
  return {.registry = arguments.markers.empty() ? site->registry : load_registry(arguments.markers),
          .camera = arguments.camera.empty() ? site->cameras.at(site->default_camera)
                                             : load_camera(arguments.camera),
          .robot_file = arguments.robot.empty() ? site->robot_file : std::filesystem::path(arguments.robot)};
}

ExitCode calibrate_mount_from_log(const MountArguments& arguments) {
  const MountInput input = input_of(arguments);
  const Robot robot = load_robot(input.robot_file);
  const SurveyLog log = load_survey_log(arguments.inputs.back(), input.camera, expecting(input.registry));
  const MountSet set = mount_set_of(log, input.registry, input.camera, robot);
  const MountCalibrationOptions options;
  const MountCalibration calibration = calibrate_mount(set.frames, input.camera, belief_of(robot), options);
  fmt::print("{}",
             arguments.json ? json_document(json_report(set, calibration)) : text_report(set, calibration));
  for (const std::string& line : complaints(set, calibration, options)) {
    fmt::print(stderr, "lodestar: {}\n", line);
  }
  if (!calibration.flaws.empty()) return job_failed;
  write_file_atomically(arguments.output,
                        with_camera_mount(input.robot_file, measured_keys(*calibration.estimate)));
  fmt::print(stderr, "lodestar: wrote {}\n", arguments.output);
  return done;
}

Command mount_command(CLI::App* calibrate) {
  const auto arguments = std::make_shared<MountArguments>();
  CLI::App* command =
      calibrate->add_subcommand("mount",
                                "The camera's mount on the robot, from a log of five turns on the spot and a "
                                "straight drive; exit 1, and no file, for a log that does not determine it");
  command->add_option("--markers", arguments->markers, "Marker registry, instead of the site's");
  command->add_option("--camera", arguments->camera, "Calibrated camera, instead of the site's default");
  command->add_option("--robot", arguments->robot,
                      "robot.yaml with the mount known so far, instead of the site's");
  command->add_flag("--json", arguments->json, "Report as JSON");
  command->add_option("-o,--output", arguments->output, "Robot file to write")->required();
  command
      ->add_option(
          "log", arguments->inputs,
          "[SITE] LOG. A log is a run's folder, or one of images named by their stamp in seconds, and "
          "wheels.csv with the columns stamp_s,left_m,right_m")
      ->required()
      ->expected(1, 2);
  return {command, [arguments] { return calibrate_mount_from_log(*arguments); }};
}

}  // namespace

std::vector<Command> calibrate_commands(CLI::App& lodestar) {
  CLI::App* calibrate = lodestar.add_subcommand("calibrate", "Calibrate a camera, or its mount on the robot");
  calibrate->require_subcommand(1);
  return {camera_command(calibrate), mount_command(calibrate)};
}

}  // namespace lodestar

#include <filesystem>
#include <fmt/core.h>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands/command.hpp"
#include "app/image_files.hpp"
#include "app/overlay.hpp"
#include "localization/marker_detector.hpp"

namespace lodestar {
namespace {

struct DetectArguments {
  std::string camera;
  std::string format = "csv";
  std::string draw;
  std::vector<std::string> inputs;
};

void print_csv(const std::string& file, const DetectedMarker& m) {
  fmt::print("{},{},{:.4f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{}\n", file, m.id, m.confidence,
             m.o_px.x(), m.o_px.y(), m.x_px.x(), m.x_px.y(), m.y_px.x(), m.y_px.y(), m.dots.size());
}

nlohmann::ordered_json as_json(const Vec2& point) {
  return {point.x(), point.y()};
}

void print_json(const std::string& file, const std::vector<DetectedMarker>& markers) {
  nlohmann::ordered_json line{{"file", file}, {"markers", nlohmann::ordered_json::array()}};
  for (const DetectedMarker& marker : markers) {
    line["markers"].push_back({{"id", marker.id},
                               {"confidence", marker.confidence},
                               {"o", as_json(marker.o_px)},
                               {"x", as_json(marker.x_px)},
                               {"y", as_json(marker.y_px)},
                               {"dots", marker.dots.size()}});
  }
  fmt::print("{}\n", line.dump());
}

ExitCode detect(const DetectArguments& arguments) {
  std::optional<CameraModel> camera;
  if (!arguments.camera.empty()) camera = load_camera(arguments.camera);
  ImageFiles images(arguments.inputs);
  const bool csv = arguments.format == "csv";
  if (csv) fmt::print("file,id,confidence,o_u,o_v,x_u,x_v,y_u,y_v,dots\n");
  int seen = 0;
  while (const std::optional<ImageFile> image = images.next(camera)) {
    const std::vector<DetectedMarker> markers = detect_markers(image->gray);
    seen += static_cast<int>(markers.size());
    if (csv) {
      for (const DetectedMarker& marker : markers) print_csv(image->file, marker);
    } else {
      print_json(image->file, markers);
    }
    if (!arguments.draw.empty())
      write_overlay(arguments.draw, image->file, draw_markers(image->gray, markers));
  }
  return seen > 0 ? done : job_failed;
}

}  // namespace

std::vector<Command> detect_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<DetectArguments>();
  CLI::App* command =
      lodestar.add_subcommand("detect", "Decode the markers in images; exit 1 when there are none");
  command->add_option("--camera", arguments->camera, "camera_info YAML file: images must be of its size");
  command->add_option("--format", arguments->format, "csv, or json: one line an image")
      ->check(CLI::IsMember({"csv", "json"}))
      ->capture_default_str();
  command->add_option("--draw", arguments->draw, "Folder for pictures of what was seen");
  command->add_option("images", arguments->inputs, "Images, or folders of images")->required();
  return {{command, [arguments] { return detect(*arguments); }}};
}

}  // namespace lodestar

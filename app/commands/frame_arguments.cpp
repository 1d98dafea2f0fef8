#include "app/commands/frame_arguments.hpp"

namespace lodestar {

void add_frame_arguments(CLI::App& command, FrameArguments& arguments) {
  command
      .add_option("--method", arguments.method,
                  "Method: lodestar, or for comparison the paper's whole method (docs/method.md)")
      ->check(CLI::IsMember({"lodestar", "paper"}))
      ->capture_default_str();
  command.add_option("--draw", arguments.draw, "Folder for a PNG of each frame with its detections")
      ->type_name("FOLDER");
  command.add_option("--frames", arguments.most_frames, "Stop after N frames")
      ->type_name("N")
      ->check(CLI::Range(1, 1'000'000'000));
  command.add_flag("-q,--quiet", arguments.quiet, "No summary on stderr");
  command
      .add_option("input", arguments.inputs,
                  "Image files, folders of images, patterns like 'shots/*.png', videos, or cameras like "
                  "/dev/video0 (until Ctrl-C)")
      ->required();
  command.footer(
      "Images may be of 8 or 16 bits, gray or in colour; transparency is ignored. In the results, file is\n"
      "an image's path, and clip.avi#12 for the 13th frame of a video or camera.");
}

DetectorOptions detector_options(const FrameArguments& arguments) {
  return arguments.method == "paper" ? paper_detection() : DetectorOptions{};
}

FrameInputs open_inputs(const FrameArguments& arguments, const std::optional<CameraModel>& camera) {
  FrameInputOptions options{.camera = camera, .most_frames = std::nullopt};
  if (arguments.most_frames > 0) options.most_frames = arguments.most_frames;
  return {arguments.inputs, options};
}

std::optional<OverlayFolder> open_overlays(const FrameArguments& arguments, const FrameInputs& inputs) {
  if (arguments.draw.empty()) return std::nullopt;
  return OverlayFolder(arguments.draw, inputs.image_folders());
}

std::string csv_cell(const std::string& name) {
  if (name.find_first_of(",\"\r\n") == std::string::npos) return name;
  std::string quoted = "\"";
  for (const char c : name) {
    if (c == '"') quoted.push_back('"');
    quoted.push_back(c);
  }
  quoted.push_back('"');
  return quoted;
}

}  // namespace lodestar

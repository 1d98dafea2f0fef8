#include "app/commands/frame_arguments.hpp"

namespace lodestar {

void add_frame_arguments(CLI::App& command, FrameArguments& arguments) {
  command.add_option("--draw", arguments.draw, "Folder for a PNG of each frame with all that was seen in it");
  command.add_option("--frames", arguments.most_frames, "Stop after so many frames")
      ->check(CLI::PositiveNumber);
  command.add_flag("-q,--quiet", arguments.quiet, "No summary on stderr");
  command
      .add_option("input", arguments.inputs,
                  "Image files, folders of images, patterns like 'shots/*.png', videos, or cameras like "
                  "/dev/video0 (until Ctrl-C)")
      ->required();
  command.footer(
      "The file column holds an image's path, and clip.avi#12 for the 13th frame of a video or camera.\n"
      "Stamps are in seconds: a video's own time, a camera's since the machine started; for an image its "
      "name\n"
      "when that is a number (12.40.png), else its place in the list, from 0. Images may be of 8 or 16 bits, "
      "gray\n"
      "or in colour; transparency is ignored.");
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

}  // namespace lodestar

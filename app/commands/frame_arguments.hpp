#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "app/frames/frame_inputs.hpp"
#include "app/frames/overlay.hpp"
#include "localization/detection/marker_detector.hpp"

namespace lodestar {

/// Arguments of every command that reads frames.
struct FrameArguments {
  std::vector<std::string> inputs;
  std::string draw;
  std::string method = "lodestar";
  int most_frames = 0;  ///< 0: all
  bool quiet = false;
};

void add_frame_arguments(CLI::App& command, FrameArguments& arguments);

FrameInputs open_inputs(const FrameArguments& arguments, const std::optional<CameraModel>& camera);

/// Options for --method: the paper's own detector, or this project's.
DetectorOptions detector_options(const FrameArguments& arguments);

/// Nothing without --draw.
std::optional<OverlayFolder> open_overlays(const FrameArguments& arguments, const FrameInputs& inputs);

/// A name as one cell of a CSV row: in quotes when it contains a comma, a quote or a line break (RFC 4180).
std::string csv_cell(const std::string& name);

}  // namespace lodestar

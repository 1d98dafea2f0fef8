#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "app/frame_inputs.hpp"
#include "app/overlay.hpp"

namespace lodestar {

/// What every command that looks at frames takes.
struct FrameArguments {
  std::vector<std::string> inputs;
  std::string draw;
  int most_frames = 0;  ///< 0: all
  bool quiet = false;
};

void add_frame_arguments(CLI::App& command, FrameArguments& arguments);

FrameInputs open_inputs(const FrameArguments& arguments, const std::optional<CameraModel>& camera);

/// Nothing when no drawings are wanted.
std::optional<OverlayFolder> open_overlays(const FrameArguments& arguments, const FrameInputs& inputs);

/// A name as one cell of a CSV row: in quotes when it holds a comma, a quote or a line's end (RFC 4180).
std::string csv_cell(const std::string& name);

}  // namespace lodestar

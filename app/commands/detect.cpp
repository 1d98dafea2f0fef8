#include <cstdio>
#include <fmt/core.h>
#include <fmt/ranges.h>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands/commands.hpp"
#include "app/commands/format_option.hpp"
#include "app/commands/frame_arguments.hpp"
#include "app/common/json_text.hpp"
#include "localization/detection/marker_detector.hpp"

namespace lodestar {
namespace {

struct DetectArguments {
  std::string camera;
  std::string format = "csv";
  FrameArguments frames;
};

void print_csv(const std::string& file, const DetectedMarker& m) {
  fmt::print("{},{},{:.4f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{}\n", csv_cell(file), m.id,
             m.confidence, m.o_px.x(), m.o_px.y(), m.x_px.x(), m.x_px.y(), m.y_px.x(), m.y_px.y(),
             m.dots.size());
}

nlohmann::ordered_json as_json(const Vec2& point) {
  return {point.x(), point.y()};
}

void print_json(const std::string& file, std::span<const DetectedMarker> markers) {
  nlohmann::ordered_json line{{"file", file}, {"markers", nlohmann::ordered_json::array()}};
  for (const DetectedMarker& marker : markers) {
    const auto probability = marker.probability > 0.0 ? nlohmann::ordered_json(marker.probability)
                                                      : nlohmann::ordered_json();  // not told by this method
    line["markers"].push_back({{"id", marker.id},
                               {"probability", probability},
                               {"confidence", marker.confidence},
                               {"o", as_json(marker.o_px)},
                               {"x", as_json(marker.x_px)},
                               {"y", as_json(marker.y_px)},
                               {"dots", marker.dots.size()}});
  }
  fmt::print("{}\n", json_text(line));
}

Overlay overlay_of(const SourceFrame& frame, std::span<const DetectedMarker> markers) {
  Overlay overlay{.gray = frame.gray, .markers = {}, .words = {}, .accepted = !markers.empty()};
  std::vector<int> ids;
  for (const DetectedMarker& marker : markers) {
    overlay.markers.push_back({marker, {}});
    ids.push_back(marker.id);
  }
  overlay.words.push_back(
      markers.empty() ? "No marker read"
                      : fmt::format("Read: marker{} {}", ids.size() == 1 ? "" : "s", fmt::join(ids, ", ")));
  overlay.words.push_back(fmt::format("{}   {:.3f} s", frame.name, seconds(frame.stamp)));
  return overlay;
}

ExitCode detect(const DetectArguments& arguments) {
  std::optional<CameraModel> camera;
  if (!arguments.camera.empty()) camera = load_camera(arguments.camera);
  FrameInputs inputs = open_inputs(arguments.frames, camera);
  std::optional<OverlayFolder> overlays = open_overlays(arguments.frames, inputs);
  const bool csv = arguments.format == "csv";
  if (csv) fmt::print("file,id,confidence,o_u,o_v,x_u,x_v,y_u,y_v,dots\n");
  MarkerDetector detector(detector_options(arguments.frames));
  int frames = 0;
  int frames_with_markers = 0;
  while (const std::optional<SourceFrame> frame = inputs.next()) {
    const std::span<const DetectedMarker> markers = detector.detect(frame->gray);
    ++frames;
    if (!markers.empty()) ++frames_with_markers;
    if (csv) {
      for (const DetectedMarker& marker : markers) print_csv(frame->name, marker);
    } else {
      print_json(frame->name, markers);
    }
    if (inputs.live()) std::fflush(stdout);
    if (overlays) overlays->write(*frame, draw_overlay(overlay_of(*frame, markers)));
  }
  if (!arguments.frames.quiet)
    fmt::print(stderr, "markers in {} of {} frames\n", frames_with_markers, frames);
  return frames_with_markers > 0 ? done : job_failed;
}

}  // namespace

std::vector<Command> detect_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<DetectArguments>();
  CLI::App* command = lodestar.add_subcommand(
      "detect", "Decode the markers in images, videos or a camera's frames; exit 1 when there are none");
  command->add_option("--camera", arguments->camera, "camera_info YAML file: frames must be of its size");
  add_format_option(*command, arguments->format, {"csv", "json"},
                    "csv: one row a marker; json: one line a frame");
  add_frame_arguments(*command, arguments->frames);
  return {{command, [arguments] { return detect(*arguments); }}};
}

}  // namespace lodestar

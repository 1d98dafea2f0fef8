#include "app/frames/frame_inputs.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <glob.h>
#include <set>

#include "app/frames/image_files.hpp"
#include "app/frames/live_camera.hpp"
#include "app/frames/video_file.hpp"
#include "maps/input_error.hpp"
#include "maps/path_kind.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

constexpr const char* usable_inputs = "an image, a video, a folder of images or a camera device";

/// What the pattern matches, in the order taken; empty when it matches nothing.
std::vector<fs::path> matches_of(const std::string& pattern) {
  glob_t found{};
  std::vector<fs::path> paths;
  if (::glob(pattern.c_str(), 0, nullptr, &found) == 0)
    paths.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  ::globfree(&found);
  sort_as_taken(paths);
  return paths;
}

}  // namespace

FrameInputs::FrameInputs(const std::vector<std::string>& arguments, const FrameInputOptions& options)
    : options_(options) {
  for (const std::string& argument : arguments) {
    std::error_code ignored;  // what cannot be accessed counts as missing
    if (fs::exists(argument, ignored)) {
      add(argument);
      continue;
    }
    const bool pattern = argument.find_first_of("*?[") != std::string::npos;
    const std::vector<fs::path> paths = pattern ? matches_of(argument) : std::vector<fs::path>();
    if (paths.empty()) {
      throw InputError(argument, 0, pattern ? "no file that matches" : "no such file or folder",
                       usable_inputs);
    }
    for (const fs::path& path : paths) add(path);
  }
  if (inputs_.empty()) throw InputError(fmt::format("found no input, wanted {}", usable_inputs));
}

void FrameInputs::add(const fs::path& path) {
  if (is_folder(path)) {
    for (const fs::path& file : images_in(path)) add_image(file);
  } else if (fs::is_character_file(path)) {
    inputs_.push_back({.kind = Kind::device, .files = {path}});
  } else if (!is_file(path)) {
    throw InputError(path, 0, "no regular file", usable_inputs);
  } else if (fs::file_size(path) == 0) {
    throw InputError(path, 0, "an empty file", usable_inputs);
  } else if (is_image(path)) {
    add_image(path);
  } else {
    inputs_.push_back({.kind = Kind::video, .files = {path}});
  }
}

void FrameInputs::add_image(const fs::path& file) {
  if (inputs_.empty() || inputs_.back().kind != Kind::images)
    inputs_.push_back({.kind = Kind::images, .files = {}, .first_place = images_});
  inputs_.back().files.push_back(file);
  ++images_;
}

std::unique_ptr<FrameSource> FrameInputs::open(const Input& input) const {
  switch (input.kind) {
    case Kind::images:
      return std::make_unique<ImageFiles>(input.files, input.first_place);
    case Kind::video:
      return std::make_unique<VideoFile>(input.files.front());
    case Kind::device:
      return std::make_unique<LiveCamera>(input.files.front(), options_.camera);
  }
  return nullptr;
}

std::optional<SourceFrame> FrameInputs::next() {
  if (options_.most_frames && frames_ >= *options_.most_frames) return std::nullopt;
  for (;;) {
    if (!source_) {
      if (next_input_ == inputs_.size()) return std::nullopt;
      source_ = open(inputs_[next_input_++]);
    }
    if (std::optional<SourceFrame> frame = source_->next()) {
      require_camera_size(*frame);
      ++frames_;
      return frame;
    }
    source_.reset();
  }
}

void FrameInputs::require_camera_size(const SourceFrame& frame) const {
  const std::optional<CameraModel>& camera = options_.camera;
  if (!camera || (frame.gray.cols == camera->width_px && frame.gray.rows == camera->height_px)) return;
  throw InputError(frame.name, 0, fmt::format("{} x {} pixels", frame.gray.cols, frame.gray.rows),
                   fmt::format("the camera's {} x {}", camera->width_px, camera->height_px));
}

bool FrameInputs::live() const {
  return std::ranges::any_of(inputs_, [](const Input& input) { return input.kind == Kind::device; });
}

std::vector<fs::path> FrameInputs::image_folders() const {
  std::set<fs::path> folders;
  for (const Input& input : inputs_) {
    if (input.kind != Kind::images) continue;
    for (const fs::path& file : input.files) folders.insert(fs::absolute(file).parent_path());
  }
  return {folders.begin(), folders.end()};
}

}  // namespace lodestar

#pragma once

#include <deque>
#include <filesystem>
#include <memory>
#include <vector>

#include "app/frames/frame_source.hpp"
#include "maps/camera_model.hpp"

namespace lodestar {

struct FrameInputOptions {
  std::optional<CameraModel> camera;  ///< every frame must be of its size
  std::optional<int> most_frames;     ///< stop after this many in all
};

/// All that a command line names, one after another: image files, folders of images, patterns such as
/// 'shots/*.png' (for names that the shell has left alone), video files, camera devices.
class FrameInputs final : public FrameSource {
 public:
  /// Throws InputError for a path that does not exist, a pattern that matches nothing, a folder without
  /// images, or no argument at all. Videos and devices are opened when they are reached.
  FrameInputs(const std::vector<std::string>& arguments, const FrameInputOptions& options);

  /// Throws InputError for a frame that cannot be read or is not of the camera's size.
  std::optional<SourceFrame> next() override;

  /// Is one of the inputs a device, so that results must be flushed line by line?
  [[nodiscard]] bool live() const;

  /// The folders in which the image files lie: no drawing must be written there.
  [[nodiscard]] std::vector<std::filesystem::path> image_folders() const;

 private:
  enum class Kind { images, video, device };
  struct Input {
    Kind kind = Kind::images;
    std::vector<std::filesystem::path> files;  ///< one, but for images
    std::size_t first_place = 0;               ///< of these images among all
  };

  void add(const std::filesystem::path& path);
  void add_image(const std::filesystem::path& file);
  std::unique_ptr<FrameSource> open(const Input& input) const;
  void require_camera_size(const SourceFrame& frame) const;

  FrameInputOptions options_;
  std::vector<Input> inputs_;
  std::size_t next_input_ = 0;
  std::size_t images_ = 0;
  std::unique_ptr<FrameSource> source_;
  int frames_ = 0;
};

}  // namespace lodestar

#pragma once

#include <optional>
#include <string>

#include "maps/stamp.hpp"

namespace lodestar {

/// Do the images still come? They are missed when three of their usual periods have passed without one.
class ImageWatch {
 public:
  /// At every step, with what has arrived since the last one. What is new about the camera, in words for
  /// people; nothing when it is as before.
  std::optional<std::string> see(Stamp now, std::size_t frames);

  [[nodiscard]] bool is_silent() const { return is_silent_; }

 private:
  [[nodiscard]] Duration patience() const;

  std::optional<Stamp> last_;       ///< arrival of the newest
  std::optional<Duration> period_;  ///< smoothed
  bool is_silent_ = false;
};

}  // namespace lodestar

#pragma once

namespace lodestar {

/// While one of these lives, Ctrl-C and SIGTERM do not end the program but ask it to end: whoever reads a
/// camera stops after the frame at hand, and what was found is still reported. A second Ctrl-C ends it.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  [[nodiscard]] static bool asked();
};

}  // namespace lodestar

#pragma once

namespace lodestar {

/// While one of these lives, Ctrl-C and SIGTERM do not end the program but ask it to end: whoever drives,
/// serves or reads a camera stops after the step at hand, and what was found is still reported. A second one
/// ends the program at once; a robot that it drives is then stopped by its guard. One inside another adds
/// nothing. For one thread.
class Interruption {
 public:
  Interruption();
  /// When the outermost ends, signals do again what they did before.
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  [[nodiscard]] static bool asked();
};

}  // namespace lodestar

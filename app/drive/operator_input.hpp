#pragma once

#include <optional>
#include <string>

namespace lodestar {

enum class OperatorWord { resume, stop };

/// Whoever stands at the robot, by lines on standard input: "resume", "stop". Never blocks.
class OperatorInput {
 public:
  /// The next word; lines that say something else are skipped.
  std::optional<OperatorWord> poll();

  /// False once the input has ended: nobody is there to say anything.
  [[nodiscard]] bool is_there() const { return !ended_; }

 private:
  void read_more();

  std::string text_;
  bool ended_ = false;
};

}  // namespace lodestar

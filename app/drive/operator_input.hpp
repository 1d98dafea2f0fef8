#pragma once

#include <optional>
#include <string>

namespace lodestar {

enum class OperatorWord { resume, stop };

/// Commands of the operator at the terminal, as lines on standard input: "resume", "stop". Never blocks.
class OperatorInput {
 public:
  /// The next command; other lines are skipped.
  std::optional<OperatorWord> poll();

  /// False once standard input has ended: no operator is there.
  [[nodiscard]] bool is_there() const { return !ended_; }

 private:
  void read_more();

  std::string text_;
  bool ended_ = false;
};

}  // namespace lodestar

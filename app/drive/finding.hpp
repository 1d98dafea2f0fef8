#pragma once

#include <string>

namespace lodestar {

enum class Verdict { good, doubtful, bad };

/// One thing that must be right before the robot moves.
struct Finding {
  std::string what;
  Verdict verdict = Verdict::good;
  std::string found;   ///< in words
  std::string remedy;  ///< what to do about it; empty when there is nothing to do
  std::string
      commands;  ///< the remedy as lines for sh, where commands are all of it; `doctor --fix` prints them
};

}  // namespace lodestar

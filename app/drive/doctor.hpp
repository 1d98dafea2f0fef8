#pragma once

#include <string>
#include <vector>

#include "app/site/base_setup.hpp"

namespace lodestar {

enum class Verdict { good, doubtful, bad };

/// One thing that must be right before the robot moves.
struct Finding {
  std::string what;
  Verdict verdict = Verdict::good;
  std::string found;   ///< in words
  std::string remedy;  ///< what to do about it; empty when nothing is to be done
};

/// Why does it not move? Looks at a site, its interface, its base and its camera, listening for a second;
/// sends nothing, so it may be asked while somebody drives.
std::vector<Finding> examine(const Site& site, const BaseConnection& connection);

}  // namespace lodestar

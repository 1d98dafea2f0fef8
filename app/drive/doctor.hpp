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
  std::string remedy;  ///< what to do about it; empty when there is nothing to do
};

/// Diagnoses why a robot does not move: checks the site, the CAN interface, the base and the camera,
/// listening for one second. Sends nothing, so it may run during a drive.
std::vector<Finding> examine(const Site& site, const BaseConnection& connection);

}  // namespace lodestar

#pragma once

#include <functional>
#include <string>

#include "app/fleet/action_hooks.hpp"
#include "app/navigation/mission.hpp"
#include "app/site/site.hpp"

namespace lodestar {

/// Carries out the actions of a mission's stops by the programs of the site. A program gets the action as
/// JSON on its standard input, as one of a fleet manager does: its type, and the place as x, y and theta.
class StopActions {
 public:
  /// `waits`: for a world that can stand still while a program runs; a robot's loop must not. `tell`:
  /// receives each event, in words, for a log.
  StopActions(const Site& site, bool waits, std::function<void(const std::string&)> tell = {});

  /// Call after each step.
  void attend(Mission& mission);

 private:
  void begin(const std::string& type, Mission& mission);
  void hear(Mission& mission);

  ActionHooks hooks_;
  bool waits_;
  std::function<void(const std::string&)> tell_;
  std::string running_;  ///< its ID; empty for none
  std::string type_;     ///< of the one that runs
  int count_ = 0;
};

}  // namespace lodestar

#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "app/fleet/fleet_messages.hpp"
#include "app/site/fleet_settings.hpp"

namespace lodestar {

/// What has come of an action that a program carries out.
struct HookResult {
  std::string action_id;
  bool succeeded = false;
  std::string words;  ///< the first line that the program wrote, or why it failed
};

/// Carries out actions by programs of the site: an exit code of 0 is success. A program gets the action as
/// JSON on its standard input, and its whole process group is ended after its timeout, when nobody wants its
/// result any more, and with this object. No call waits for a program.
class ActionHooks {
 public:
  /// Programs run in `folder`, the site's.
  ActionHooks(std::vector<ActionHook> hooks, std::filesystem::path folder);
  /// Ends the programs that still run, and waits for that.
  ~ActionHooks();
  ActionHooks(const ActionHooks&) = delete;
  ActionHooks& operator=(const ActionHooks&) = delete;

  [[nodiscard]] bool carries_out(const std::string& type) const;
  /// Call only for a type that it carries out, once per action ID.
  void start(const FleetAction& action);
  /// Ends the programs of actions for which this is false.
  void keep(const std::function<bool(const std::string& action_id)>& is_wanted);
  /// Since the last call.
  [[nodiscard]] std::vector<HookResult> take_ended();

 private:
  struct Shared;

  std::vector<ActionHook> hooks_;
  std::filesystem::path folder_;
  std::shared_ptr<Shared> shared_;  ///< with the threads
  std::map<std::string, std::stop_source> running_;
};

}  // namespace lodestar

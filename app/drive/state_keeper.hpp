#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "app/common/background_writer.hpp"
#include "app/common/log.hpp"
#include "app/navigation/learned_state.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// Keeps what a robot learns in a state file: read at the start, written once a minute and at the end.
/// Writing does not hold up the thread that drives; a failure is told once, and the drive goes on.
class StateKeeper {
 public:
  StateKeeper(std::filesystem::path file, StateOwner owner,
              std::function<void(Severity, const std::string&)> tell);

  /// What the file holds for this robot, if anything; tells why a file is not used.
  [[nodiscard]] std::optional<LearnedState> load() const;

  /// Call at every step: `learned` is only asked when it is time to write.
  void step(Stamp now, const std::function<std::optional<LearnedState>()>& learned);

  /// Writes the last state. Call once, at the end.
  void end(const std::optional<LearnedState>& learned);

 private:
  void save(const LearnedState& state) const { save_state(state, owner_, file_); }

  std::filesystem::path file_;
  StateOwner owner_;
  std::function<void(Severity, const std::string&)> tell_;
  std::optional<Stamp> written_at_;
  BackgroundWriter<LearnedState> writer_;
};

}  // namespace lodestar

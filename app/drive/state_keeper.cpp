#include "app/drive/state_keeper.hpp"

#include <exception>
#include <utility>

namespace lodestar {
namespace {

constexpr Duration between_writes = std::chrono::minutes(1);

}  // namespace

StateKeeper::StateKeeper(std::filesystem::path file, StateOwner owner,
                         std::function<void(Severity, const std::string&)> tell)
    : file_(std::move(file)),
      owner_(std::move(owner)),
      tell_(std::move(tell)),
      writer_({.tell =
                   [this](const std::string& error) {
                     tell_(Severity::warning, "what the robot has learned is not kept: " + error);
                   }},
              [this](const LearnedState& state) { save(state); }) {}

std::optional<LearnedState> StateKeeper::load() const {
  StateFile file = load_state(file_, owner_);
  if (!file.warning.empty()) tell_(Severity::warning, file.warning);
  return std::move(file.state);
}

void StateKeeper::step(Stamp now, const std::function<std::optional<LearnedState>()>& learned) {
  if (!written_at_) written_at_ = now;
  if (now - *written_at_ < between_writes) return;
  written_at_ = now;
  if (std::optional<LearnedState> state = learned()) writer_.put(std::move(*state));
}

/// A state that still waits is older than the last one.
void StateKeeper::end(const std::optional<LearnedState>& learned) {
  const bool has_failed = !writer_.finish().error.empty();
  if (!learned || has_failed) return;
  try {
    save(*learned);
  } catch (const std::exception& error) {
    tell_(Severity::warning, std::string("what the robot has learned is not kept: ") + error.what());
  }
}

}  // namespace lodestar

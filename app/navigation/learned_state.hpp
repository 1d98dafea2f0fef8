#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "localization/filter/pose_filter_options.hpp"
#include "localization/integrity/marker_trust.hpp"
#include "localization/pose/variance_factor.hpp"
#include "maps/camera_model.hpp"
#include "maps/marker_registry.hpp"

namespace lodestar {

/// What a robot learns while it drives and keeps over a restart.
struct LearnedState {
  WheelScales wheel_scales;
  VarianceFactor variance_factor;
  double registry_variance = 1.0;            ///< as PoseFilterOptions::registry_variance
  std::vector<DistrustedMarker> distrusted;  ///< by ascending ID
};

/// Whom a learned state belongs to: it is of no use to another.
struct StateOwner {
  std::string robot;           ///< its name
  double track_width_m = 0.0;  ///< as built; the wheels' scales refer to it
  double wheel_step_m = 0.0;   ///< of the encoders
  std::uint64_t registry = 0;  ///< fingerprint of the markers as surveyed
  std::uint64_t camera = 0;    ///< fingerprint of the calibration

  bool operator==(const StateOwner&) const = default;
};

/// Fingerprints (FNV-1a) of all numbers; the same on every machine.
std::uint64_t fingerprint_of(const MarkerRegistry& registry);
std::uint64_t fingerprint_of(const CameraModel& camera);

/// A state file: `format: lodestar-state`, `version: 1`.
struct StateFile {
  std::optional<LearnedState> state;  ///< nothing: the drive begins as if nothing had been learned
  std::string warning;                ///< why a file that exists is not used; empty otherwise
};

/// Reads the state for its owner. Never throws: whatever is wrong with the file, the robot can learn anew.
/// The wheels' scales are less certain than they were written, as tyres and load may have changed.
StateFile load_state(const std::filesystem::path& file, const StateOwner& owner);

/// Replaces the file atomically. Throws InputError when the folder cannot be written.
void save_state(const LearnedState& state, const StateOwner& owner, const std::filesystem::path& file);

/// Removes these markers from the file's distrusted ones, whoever owns it, and returns those that were there.
/// Throws InputError, without any change, when the file cannot be read or written.
std::vector<int> trust_again(const std::filesystem::path& file, const std::vector<int>& ids);

}  // namespace lodestar

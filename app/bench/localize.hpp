#pragma once

#include <string>
#include <vector>

#include "app/bench/method.hpp"
#include "app/bench/scene.hpp"

// Localization measured on rendered frames: detection rate, time, and pose errors against the Cramér-Rao
// bound.
namespace lodestar {

/// Root mean squares over the frames that gave a pose.
struct PoseSpread {
  int poses = 0;
  double lateral_m = 0.0;  ///< distance in the plane
  double height_m = 0.0;
  double yaw_rad = 0.0;
};

/// One method at one scene.
struct ScenePoint {
  int markers = 0;  ///< in view, over all frames
  int read = 0;     ///< of these, with the right ID at the right position
  int wrong = 0;    ///< IDs read where no such marker is
  double median_us = 0.0;
  double threshold_us = 0.0;  ///< median of cv::threshold on the same frames, alternating with the method
  PoseSpread upright;
  PoseSpread free;
  /// Cramér-Rao bounds of an estimate from our marker's dots, on the frames that gave a pose.
  PoseSpread upright_bound;
  PoseSpread free_bound;

  [[nodiscard]] double share_read() const { return markers > 0 ? static_cast<double>(read) / markers : 0.0; }
};

/// Frames of a scene, each of its own view, through one method. Equal seeds give equal views, light and noise
/// to every method.
ScenePoint measure(const BenchScene& scene, const MethodChoice& choice, int trials, std::uint64_t seed);

struct Sweep {
  std::string name;
  std::string quantity;  ///< what is swept, with its unit
  std::vector<double> values;
  std::vector<std::vector<ScenePoint>> points;  ///< method by method, value by value
};

/// "noise", "blur", "height", "tilt", "light", "occlusion".
const std::vector<std::string>& sweep_names();

/// One sweep over all methods. `done` is called after every point.
Sweep run_sweep(const std::string& name, const std::vector<MethodChoice>& methods, int trials,
                std::uint64_t seed, const std::function<void()>& done);

/// Number of points of a sweep for each method.
std::size_t points_of(const std::string& name);

/// One setting of a peer, with its result.
struct TriedSettings {
  MethodChoice choice;
  ScenePoint point;
};

std::vector<TriedSettings> try_settings(const BenchScene& scene, const std::vector<MethodChoice>& choices,
                                        int trials, std::uint64_t seed);

/// The setting with most markers read; among equals, with the least lateral error of the upright pose.
const TriedSettings& best_of(const std::vector<TriedSettings>& tried);

}  // namespace lodestar

#pragma once

#include "app/bench/ceilings.hpp"
#include "app/bench/consistency.hpp"
#include "app/bench/counts.hpp"
#include "app/bench/localize.hpp"

// `bench localize` as a whole: settings tried, targets, sweeps and counts.
namespace lodestar {

struct BenchLocalizeOptions {
  int trials = 20;   ///< frames at each point; ten times as many for ours at the points with targets
  int frames = 200;  ///< of each kind of hard frames
  std::uint64_t seed = 1;
  std::vector<std::string> peers;   ///< "apriltag", "aruco"
  std::vector<std::string> sweeps;  ///< of sweep_names()
};

/// A figure with the limit that the project commits to.
struct Target {
  std::string name;
  double value = 0.0;
  double limit = 0.0;
  bool at_least = false;  ///< the limit is a minimum, not a maximum
  std::string unit;
  [[nodiscard]] bool reached() const { return at_least ? value >= limit : value <= limit; }
};

struct MethodCounts {
  std::string method;
  FrameCounts adverse;
  FrameCounts empty;
  FrameCounts direction_dot_lost;
};

struct BenchLocalizeResult {
  BenchLocalizeOptions options;
  std::vector<MethodChoice> methods;  ///< ours first, then the peers with their best settings
  std::vector<TriedSettings> tried;   ///< of the peers, off the axis
  std::vector<std::string> left_out;  ///< peers that the program was built without
  std::vector<ScenePoint> centred;    ///< by method: one marker above the camera
  std::vector<ScenePoint> off_axis;   ///< by method: the same 0.7 m aside
  std::vector<ScenePoint> three;      ///< by method: three markers in view
  std::vector<MethodCounts> counts;
  std::vector<CeilingCounts> ceilings;   ///< ours, kind by kind
  ScenePoint megapixel;                  ///< ours: three markers in an image of 1280 x 1024 pixels
  std::vector<Consistency> consistency;  ///< of our poses
  std::vector<Target> targets;
  std::vector<Sweep> sweeps;
};

/// `progress` is called with the completed share, from any thread.
BenchLocalizeResult bench_localize(const BenchLocalizeOptions& options,
                                   const std::function<void(double share)>& progress);

}  // namespace lodestar

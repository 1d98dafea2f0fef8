#pragma once

#include <cstdint>
#include <vector>

#include "localization/pose/pose_fix.hpp"

// The paper's three experiments, repeated with rendered frames of the paper's camera.
namespace lodestar {

/// Whose method measures the frames: ours, or the paper's, whole (paper_detection, then
/// fix_pose_as_in_paper). Equal seeds give both equal frames.
enum class MeasuredBy { lodestar, paper };

struct BenchPaperOptions {
  std::uint64_t seed = 1;
  MeasuredBy method = MeasuredBy::lodestar;
  int identification_trials = 200;
  double tilt_sigma_rad = radians(0.05);  ///< of the camera on its stand, true value and prior
  std::optional<PosePrior> prior;         ///< instead of that one; the paper's method has none
};

/// Table 1: trials (the paper's are 200) with 100 different IDs, which are registered, varied angle, light
/// and number of markers.
struct IdentificationResult {
  int trials = 0;
  int correct = 0;  ///< the optimal marker was found and its ID was right
  int wrong = 0;    ///< an ID was read that is not on the ceiling
  double mean_ms = 0.0;
};

/// Table 2: one heading of the turned camera.
struct AngleTrial {
  double real_deg = 0.0;
  double output_deg = 0.0;
  double confidence = 0.0;
  bool fixed = false;                          ///< a pose was found
  [[nodiscard]] double deviation_deg() const;  ///< real minus output, wrapped
};

/// Table 3: one position of the camera in the marker's frame (X along O->X, Y along O->Y, Z away from the
/// ceiling).
struct PositionTrial {
  Vec3 real_m = Vec3::Zero();
  Vec3 output_m = Vec3::Zero();
  double confidence = 0.0;
  bool fixed = false;
  [[nodiscard]] double distance_m() const;  ///< from real to output; infinite without a pose
};

struct PoseBenchResult {
  std::vector<AngleTrial> angles;
  std::vector<PositionTrial> positions;

  [[nodiscard]] std::size_t poses() const;  ///< trials that gave one
  [[nodiscard]] double mean_angle_deviation_deg()
      const;  ///< mean absolute, as in the paper; infinite without a pose
  [[nodiscard]] double mean_position_deviation_m() const;  ///< mean 3-D distance, as in the paper
};

IdentificationResult bench_identification(const BenchPaperOptions& options);
PoseBenchResult bench_poses(const BenchPaperOptions& options);

}  // namespace lodestar

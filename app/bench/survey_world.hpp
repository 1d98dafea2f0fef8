#pragma once

#include <cstdint>
#include <vector>

#include "localization/survey/marker_survey.hpp"
#include "maps/camera_model.hpp"
#include "maps/marker_registry.hpp"

// Drives under a ceiling of which everything is known, as dots and wheel readings: what frames would give,
// without rendering them.
namespace lodestar {

/// What hangs, and how the robot is; everything that a real site has and nobody knows.
struct SurveyWorldOptions {
  double lean_sigma_rad = radians(0.2);  ///< of the body, swaying
  double lean_time_s = 0.5;              ///< over which it changes
  double dot_sigma_px = 0.012;
  double dot_place_sigma_m = 5e-5;
  double marker_tilt_sigma_rad = radians(0.3);
  double incline_rad = radians(0.2);  ///< of the ceiling
  double roughness_m = 0.002;         ///< of its height, marker by marker
  double step_m = 0.0;                ///< half of the ceiling hangs lower by this
  double print_scale = 1.0;
  double k1_off = 0.0;
  double slip_sigma_per_sqrt_m = 0.003;
  double sideways_sigma_per_sqrt_m = 0.001;
  double encoder_step_m = 0.001;
  Vec2 wheel_scales = {1.01, 0.985};                                   ///< true over reported travel
  double track_scale = 1.02;                                           ///< true over believed track width
  Eigen::Isometry3d base_from_camera = Eigen::Isometry3d::Identity();  ///< the true mount
  Duration wheels_late{};  ///< stamps of wheel readings less the truth
  double frames_hz = 10.0;
  double focal_px = 320.0;
  bool follows_ceiling = false;  ///< between the frames, by its texture
  double ceiling_scale = 1.03;   ///< believed height of the ceiling over the true one
  double speed_mps = 0.4;
  double turn_radps = 0.6;
};

struct SurveyWorld {
  CameraModel camera;  ///< as it is believed
  SurveyBelief belief;
  SurveyWorldOptions options;
  std::vector<RegisteredMarker> markers;         ///< true
  Vec3 up = Vec3::UnitZ();                       ///< of the inclined ceiling
  std::vector<std::vector<Vec2>> dot_offsets_m;  ///< of each marker's 16 cells
  std::vector<Vec2> tilts_rad;                   ///< of each marker
};

/// The world of these markers (true places and yaws, heights above the floor), with what hangs badly drawn
/// from the seed. The lab's camera and robot.
SurveyWorld make_survey_world(std::vector<RegisteredMarker> markers, const SurveyWorldOptions& options,
                              std::uint64_t seed);

/// Rotates and drives from point to point; true poses are kept at the stamps of the frames.
struct SurveyDrive {
  SurveyLog log;
  std::vector<Pose2> map_from_base;  ///< true, at each frame
  std::vector<Vec2> leans_rad;       ///< of the body, likewise
  double length_m = 0.0;
};
SurveyDrive drive_survey(const SurveyWorld& world, const std::vector<Vec2>& way_m, std::uint64_t seed,
                         Stamp start = Stamp{});

/// From one frame to the other, for the same markers in the same order.
Pose2 best_rigid_motion(const std::vector<RegisteredMarker>& from, const std::vector<RegisteredMarker>& to);

/// Errors of a survey, after the best rigid motion where it has a frame of its own.
struct SurveyErrors {
  double rms_m = 0.0;  ///< of horizontal distances
  double worst_m = 0.0;
  double shape_m = 0.0;     ///< RMS with the best scale too: without what the print's own error makes of it
  double expected_m = 0.0;  ///< RMS by the survey's own covariance
  double nees = 0.0;  ///< normalized estimation error squared of all (x, y, yaw), with the joint covariance
  int freedom = 0;
};
SurveyErrors survey_errors(const MarkerSurvey& survey, const std::vector<RegisteredMarker>& truth);

/// Markers in a grid, `pitch_m` apart, with random yaws and IDs.
std::vector<RegisteredMarker> marker_grid(double width_m, double depth_m, double pitch_m, double height_m,
                                          std::uint64_t seed);
/// Lanes along x, `lane_m` apart, driven there and back.
std::vector<Vec2> mower_lanes(double width_m, double depth_m, double lane_m, double margin_m);
/// Lanes along y.
std::vector<Vec2> cross_lanes(double width_m, double depth_m, double lane_m, double margin_m);

}  // namespace lodestar

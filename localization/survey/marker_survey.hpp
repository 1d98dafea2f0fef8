#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "localization/survey/survey_log.hpp"
#include "localization/survey/survey_options.hpp"
#include "maps/anchors.hpp"
#include "maps/camera_model.hpp"
#include "maps/marker_registry.hpp"

namespace lodestar {

/// Why logs and anchors give no registry.
enum class SurveyFlaw {
  too_few_sightings,    ///< of a marker
  not_connected,        ///< parts that neither wheels nor markers join
  scale_unknown,        ///< how long a metre is
  orientation_unknown,  ///< how the registry is turned on the map
  weak,                 ///< a marker's position is known less well than asked for
  contradiction,        ///< dots, wheels and each other
  anchors_contradict,   ///< each other, or the dots
  same_id_twice,        ///< one ID at two places
  no_convergence
};

/// Name in results: `too-few-sightings`.
std::string_view to_string(SurveyFlaw flaw);

struct SurveyRefusal {
  SurveyFlaw flaw = SurveyFlaw::no_convergence;
  std::string found;          ///< in words, with the culprit
  std::optional<int> marker;  ///< that is seen too rarely
};

/// What a survey knows of the robot.
struct SurveyedMount {
  Eigen::Isometry3d base_from_camera = Eigen::Isometry3d::Identity();  ///< the height is the believed one
  Vec3 position_sigmas_m = Vec3::Zero();
  Vec3 angle_sigmas_rad = Vec3::Zero();  ///< about the base's axes
  double left_scale = 1.0;               ///< true travel over reported travel
  double right_scale = 1.0;
  double track_width_m = 0.0;
};

/// Two markers seen in one frame.
struct SurveyLink {
  int first = 0;
  int second = 0;
  int keyframes = 0;
};

/// How well a wrong anchor would show against the others.
struct AnchorCheck {
  std::string anchor;  ///< in words, with its line
  /// An error of this size in its worst direction is refused in 8 of 10 cases; infinite: in none.
  double noticeable_m = 0.0;
};

/// What is known of the registry's place on the map.
enum class SurveyGauge {
  free,     ///< no anchor holds it: it has a frame of its own
  anchored  ///< in the map's frame
};

struct MarkerSurvey {
  std::vector<RegisteredMarker> markers;  ///< ascending IDs, with their sigmas
  std::vector<int> sightings;             ///< keyframes of each
  std::vector<double> dots_fit;  ///< squared residuals of each one's dots over their number, in sigmas
  /// Joint covariance of (x, y, yaw) of each marker, in their order. Of a free registry it is that of the
  /// shape: no common motion or turn counts.
  Eigen::MatrixXd covariance;
  SurveyGauge gauge = SurveyGauge::free;
  SurveyedMount mount;
  double print_scale = 1.0;
  double print_scale_sigma = 0.0;
  std::vector<AnchorCheck> anchor_checks;
  /// Likewise of the print: infinite where no anchor shows the scale.
  double noticeable_print_scale = std::numeric_limits<double>::infinity();
  double k1_off = 0.0;
  double k1_sigma = 0.0;
  std::vector<SurveyLink> links;
  std::size_t keyframes = 0;
  double dots_factor = 1.0;     ///< variance factor of the dots' residuals
  double wheels_factor = 1.0;   ///< and of the wheels'
  double ceiling_factor = 1.0;  ///< and of the ceiling's own motion's
  double gauge_factor = 1.0;    ///< and of what anchors and print leave
  std::vector<Pose2> path;      ///< of the robot, keyframe by keyframe

  std::vector<SurveyRefusal> flaws;  ///< the registry may be used when there are none
};

/// Surveys every marker that the logs see, registered or not, from no guess but the camera's model, the
/// mount's and the base's: chain, linear start, least squares. Refuses what it cannot vouch for.
MarkerSurvey survey_markers(std::span<const SurveyLog> logs, const CameraModel& camera,
                            const SurveyBelief& belief, const Anchors& anchors = {},
                            const SurveyOptions& options = {});

}  // namespace lodestar

#include "app/viewers/drive_messages.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <fmt/format.h>

#include "app/common/json_text.hpp"
#include "app/common/rounding.hpp"
#include "app/report/run_statistics.hpp"
#include "app/viewers/foxglove_schemas.hpp"
#include "app/viewers/scanner_messages.hpp"

namespace lodestar {
namespace {

enum DriveChannel : std::size_t {
  transform,
  map,
  markers,
  path,
  robot,
  pose,
  drive,
  fix,
  log,
  camera,
  calibration,
  truth,
  error,
  static_transform,
  scan,
  obstacles
};

constexpr Duration message_period = std::chrono::milliseconds(50);  ///< of poses, at most

Message message(DriveChannel channel, Stamp stamp, const MessageJson& json) {
  return {.channel = channel, .stamp = stamp, .content = json_text(json)};
}

/// Six decimals are enough for plots.
double short_number(double value) {
  return rounded(value, 1e6);
}

double largest_sigma_m(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance.topLeftCorner<2, 2>(),
                                                              Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(solver.eigenvalues()[1], 0.0));
}

double yaw_sigma_rad(const PoseEstimate& estimate) {
  return std::sqrt(std::max(estimate.covariance(2, 2), 0.0));
}

MessageJson drive_json(const EstimateMoment& moment) {
  const PoseEstimate& estimate = moment.estimate;
  const BodyVelocity measured = moment.measured.value_or(BodyVelocity{});
  const Pose2& at = estimate.map_from_base;
  return {{"timestamp", time_json(estimate.stamp)},
          {"x_m", short_number(at.position_m.x())},
          {"y_m", short_number(at.position_m.y())},
          {"yaw_deg", short_number(degrees(at.yaw_rad))},
          {"position_sigma_mm", short_number(mm_per_m * largest_sigma_m(estimate.covariance))},
          {"yaw_sigma_deg", short_number(degrees(yaw_sigma_rad(estimate)))},
          {"commanded_mps", short_number(moment.commanded.forward_mps)},
          {"commanded_degps", short_number(degrees(moment.commanded.turn_radps))},
          {"measured_mps", short_number(measured.forward_mps)},
          {"measured_degps", short_number(degrees(measured.turn_radps))},
          {"base", in_words(moment.base, moment.fault)},
          {"stop", moment.stop ? std::string(to_string(*moment.stop)) : ""},
          {"slowed_by", moment.slowed_by ? std::string(to_string(*moment.slowed_by)) : ""}};
}

MessageJson fix_json(const FixAttempt& used) {
  const bool accepted = used.outcome != FixOutcome::refused_gate && used.outcome != FixOutcome::refused_late;
  const Pose2& at = used.planar.map_from_base;
  return {{"timestamp", time_json(used.fix.stamp)},
          {"x_m", short_number(at.position_m.x())},
          {"y_m", short_number(at.position_m.y())},
          {"yaw_deg", short_number(degrees(at.yaw_rad))},
          {"ids", used.fix.ids},
          {"confidence", short_number(used.fix.confidence)},
          {"dots", used.fix.dots},
          {"residual_px", short_number(used.fix.residual_px)},
          {"accepted", accepted}};
}

bool is_due(const std::optional<Stamp>& last, Stamp now, Duration period) {
  return !last || now - *last >= period;
}

Channel channel(const char* topic, const char* schema) {
  return {.topic = topic, .schema_name = schema, .schema = viewer_schema(schema)};
}

Channel recorded(const char* topic, const char* schema) {
  Channel made = channel(topic, schema);
  made.is_live = false;
  return made;
}

Channel events(const char* topic, const char* schema) {
  Channel made = channel(topic, schema);
  made.every_message = true;
  return made;
}

Message error_message(Stamp stamp, const EstimateError& off) {
  return message(error, stamp,
                 {{"timestamp", time_json(stamp)},
                  {"position_mm", short_number(mm_per_m * off.position_m)},
                  {"yaw_deg", short_number(degrees(off.heading_rad))},
                  {"position_sigma_mm", short_number(mm_per_m * off.position_sigma_m)},
                  {"yaw_sigma_deg", short_number(degrees(off.heading_sigma_rad))}});
}

}  // namespace

const std::size_t camera_channel = DriveChannel::camera;

const std::vector<Channel>& drive_channels() {
  static const std::vector<Channel> channels{channel("/tf", "foxglove.FrameTransform"),
                                             channel("/map", "foxglove.Grid"),
                                             channel("/markers", "foxglove.SceneUpdate"),
                                             channel("/path", "foxglove.PosesInFrame"),
                                             channel("/robot", "foxglove.SceneUpdate"),
                                             channel("/pose", "foxglove.PoseInFrame"),
                                             channel("/drive", "lodestar.Drive"),
                                             recorded("/fix", "lodestar.Fix"),
                                             events("/log", "foxglove.Log"),
                                             channel("/camera", "foxglove.CompressedImage"),
                                             channel("/camera/calibration", "foxglove.CameraCalibration"),
                                             recorded("/truth", "foxglove.PoseInFrame"),
                                             channel("/error", "lodestar.EstimateError"),
                                             channel("/tf_static", "foxglove.FrameTransform"),
                                             channel("/scan", "foxglove.PointCloud"),
                                             channel("/obstacles", "foxglove.Grid")};
  return channels;
}

RobotBody body_of(const Robot& robot) {
  RobotBody body{.radius_m = robot.radius_m, .outline_m = {}};
  if (robot.footprint) body.outline_m = robot.footprint->corners_m();
  return body;
}

std::vector<Message> scene_messages(const KnownWorld& world, Stamp stamp) {
  return {message(map, stamp, grid_message(stamp, world.map)),
          message(markers, stamp, markers_message(stamp, world.registry, {})),
          message(static_transform, stamp,
                  transform_message(stamp, "base_link", "camera", world.base_from_camera)),
          message(calibration, stamp, calibration_message(stamp, world.camera))};
}

std::vector<Message> estimate_messages(const EstimateMoment& moment, const RobotBody& body) {
  const Stamp stamp = moment.estimate.stamp;
  const Eigen::Isometry3d map_from_base = lifted(moment.estimate.map_from_base);
  return {message(transform, stamp, transform_message(stamp, "map", "base_link", map_from_base)),
          message(pose, stamp, pose_message(stamp, map_from_base)),
          message(robot, stamp, robot_message(moment.estimate, body)),
          message(drive, stamp, drive_json(moment))};
}

Message planned_message(Stamp stamp, const Path& planned) {
  return message(path, stamp, path_message(stamp, planned));
}

Message ceiling_message(Stamp stamp, const MarkerRegistry& registry, const std::vector<int>& distrusted) {
  return message(markers, stamp, markers_message(stamp, registry, distrusted));
}

Message words_message(Stamp stamp, LogLevel level, const std::string& words) {
  return message(log, stamp, log_message(stamp, level, words));
}

Message camera_message(Stamp stamp, const std::string& jpeg) {
  return message(camera, stamp, picture_message(stamp, jpeg));
}

std::vector<Message> seen_messages(Stamp stamp, const SeenSurroundings& seen) {
  return {message(scan, stamp, scan_message(stamp, seen)),
          message(obstacles, stamp, memory_message(stamp, seen))};
}

Message error_message(const PoseEstimate& estimate, const TrueError& off) {
  return error_message(estimate.stamp, {.position_m = off.position_m,
                                        .heading_rad = off.heading_rad,
                                        .position_sigma_m = largest_sigma_m(estimate.covariance),
                                        .heading_sigma_rad = yaw_sigma_rad(estimate)});
}

std::vector<int> ids_of(const std::vector<DistrustedMarker>& distrusted) {
  std::vector<int> ids;
  for (const DistrustedMarker& marker : distrusted) ids.push_back(marker.id);
  return ids;
}

DriveMessages::DriveMessages(const KnownWorld& world, RobotBody body)
    : world_(world), body_(std::move(body)) {}

std::vector<Message> DriveMessages::of(const DriveMoment& moment) {
  const Stamp now = moment.input.now;
  std::vector<Message> messages = has_begun_ ? std::vector<Message>{} : scene_messages(world_, now);
  has_begun_ = true;
  say_estimate(moment, messages);
  for (const FixAttempt& used : moment.step.navigation.fixes)
    messages.push_back(message(fix, used.fix.stamp, fix_json(used)));
  say_seen(moment, messages);
  say_distrust(moment, messages);
  say_base(moment, messages);
  if (const std::string words = in_words(moment.mission, moment.step.event); !words.empty()) {
    const bool bad = moment.step.event == MissionEvent::goal_failed;
    messages.push_back(words_message(now, bad ? LogLevel::error : LogLevel::info, words));
  }
  if (moment.step.event == MissionEvent::path_planned)
    messages.push_back(planned_message(now, moment.mission.path()));
  return messages;
}

void DriveMessages::say_estimate(const DriveMoment& moment, std::vector<Message>& messages) {
  const NavigationStep& step = moment.step.navigation;
  if (!step.estimate || !is_due(last_pose_, step.estimate->stamp, message_period)) return;
  last_pose_ = step.estimate->stamp;
  const BaseFeedback& base = moment.input.base;
  for (Message& said : estimate_messages({.estimate = *step.estimate,
                                          .commanded = step.command,
                                          .measured = base.measured,
                                          .base = base.state,
                                          .fault = base.fault,
                                          .stop = step.stop,
                                          .slowed_by = step.slowed_by},
                                         body_))
    messages.push_back(std::move(said));
}

void DriveMessages::say_seen(const DriveMoment& moment, std::vector<Message>& messages) {
  constexpr Duration scan_period = std::chrono::milliseconds(100);  // scanners turn about so often
  const Stamp now = moment.input.now;
  if (!is_due(last_scan_, now, scan_period)) return;
  last_scan_ = now;
  if (const auto seen = moment.mission.seen(now))
    for (Message& said : seen_messages(now, *seen)) messages.push_back(std::move(said));
}

void DriveMessages::say_distrust(const DriveMoment& moment, std::vector<Message>& messages) {
  const Stamp now = moment.input.now;
  const std::vector<int> ids = ids_of(moment.step.navigation.distrusted);
  if (ids == distrusted_) return;
  distrusted_ = ids;
  messages.push_back(ceiling_message(now, world_.registry, ids));
  const std::string words = ids.empty() ? "all markers are trusted again"
                                        : fmt::format("not trusted: marker {}", fmt::join(ids, ", "));
  messages.push_back(words_message(now, LogLevel::warning, words));
}

void DriveMessages::say_base(const DriveMoment& moment, std::vector<Message>& messages) {
  const BaseFeedback& base = moment.input.base;
  const std::string words = "base: " + in_words(base.state, base.fault, base.details);
  if (words == base_said_) return;
  base_said_ = words;
  const bool bad = base.state == BaseState::fault;
  messages.push_back(words_message(moment.input.now, bad ? LogLevel::error : LogLevel::info, words));
}

std::vector<Message> truth_messages(const RunRecord& record) {
  std::vector<Message> messages;
  std::optional<Stamp> last;
  for (const TruePose& at : record.truth) {
    if (!is_due(last, at.stamp, message_period)) continue;
    messages.push_back(message(truth, at.stamp, pose_message(at.stamp, lifted(at.map_from_base))));
    last = at.stamp;
  }
  last.reset();
  for (const EstimateError& off : estimate_errors(record)) {
    const Stamp stamp(from_seconds(off.time_s));
    if (!is_due(last, stamp, message_period)) continue;
    messages.push_back(error_message(stamp, off));
    last = stamp;
  }
  return messages;
}

}  // namespace lodestar

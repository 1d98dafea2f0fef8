#include "app/placement/survey_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace lodestar {
namespace {

constexpr double percent = 100.0;

const char* advice(SurveyFlaw flaw) {
  switch (flaw) {
    case SurveyFlaw::too_few_sightings:
      return "drive under it again, slowly, or leave it out with --without ID";
    case SurveyFlaw::not_connected:
      return "drive from one part to the other with wheels recorded, or so that a marker is seen from both";
    case SurveyFlaw::scale_unknown:
      return "measure the print, or the distance of two markers that are far apart, and write it into the "
             "anchors";
    case SurveyFlaw::orientation_unknown:
      return "anchor a second marker, far from the first, or give the first one's yaw_deg with sigma_deg";
    case SurveyFlaw::weak:
      return "drive lanes across those driven, there; or ask for less with --max-sigma-mm";
    case SurveyFlaw::contradiction:
      return "was a marker moved during the drive, is the camera file this camera's, do both clocks agree?";
    case SurveyFlaw::anchors_contradict:
      return "measure the named one again; if all seem right, the print's scale is not what the anchors say";
    case SurveyFlaw::same_id_twice:
      return "take one of them down, or print another ID";
    case SurveyFlaw::no_convergence:
      return "is the camera file this camera's, and left and right in wheels.csv what they say?";
  }
  return "";
}

double worst_sigma_m(const MarkerSurvey& survey) {
  double worst = 0.0;
  for (const RegisteredMarker& marker : survey.markers)
    if (marker.sigma) worst = std::max(worst, marker.sigma->position_m);
  return worst;
}

std::string off_by(double noticeable, double unit, const char* name) {
  return std::isfinite(noticeable) ? fmt::format("off by {:.3g} {} or more", noticeable * unit, name)
                                   : "never: nothing else was measured that shows it";
}

/// What nobody could have noticed: errors of what people measured show against each other only.
std::string noticeable_errors(const MarkerSurvey& survey) {
  std::string text = "errors that would have been noticed, 8 of 10 times:\n";
  text += "  print scale: " + off_by(survey.noticeable_print_scale, percent, "%") + "\n";
  for (const AnchorCheck& check : survey.anchor_checks)
    text += "  " + check.anchor + ": " + off_by(check.noticeable_m, mm_per_m, "mm") + "\n";
  return text;
}

std::string yaml_number(double value) {
  return std::isfinite(value) ? fmt::format("{:.7f}", value) : ".inf";
}

/// Null for what cannot be noticed.
nlohmann::ordered_json finite(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nullptr;
}

/// To whole steps, of which there are so many to one, so that a file has no digits that say nothing.
double tidy(double value, double steps) {
  return std::round(value * steps) / steps;
}

nlohmann::ordered_json as_json(const RegisteredMarker& marker, int sightings) {
  return {{"id", marker.id},
          {"x_m", marker.position_m.x()},
          {"y_m", marker.position_m.y()},
          {"z_m", marker.position_m.z()},
          {"yaw_deg", degrees(marker.yaw_rad)},
          {"sigma_m", marker.sigma ? nlohmann::ordered_json(marker.sigma->position_m) : nullptr},
          {"sigma_deg", marker.sigma ? nlohmann::ordered_json(degrees(marker.sigma->yaw_rad)) : nullptr},
          {"keyframes", sightings}};
}

}  // namespace

SurveyBelief survey_belief_of(const Robot& robot) {
  SurveyBelief belief{.base_from_camera = robot.base_from_camera, .track_width_m = robot.track_width_m};
  constexpr double least_lean_rad = radians(0.02);  // no floor is flatter
  belief.lean_sigma_rad = std::max(robot.mount_tilt_sigma_rad, least_lean_rad);
  if (robot.wheel_noise_m_per_sqrt_m) belief.wheels.slip_sigma_per_sqrt_m = *robot.wheel_noise_m_per_sqrt_m;
  if (robot.encoder_step_m) belief.wheels.encoder_sigma_m = *robot.encoder_step_m;
  return belief;
}

std::string text_report(const MarkerSurvey& survey) {
  if (survey.markers.empty()) return "no registry\n";
  std::string text = fmt::format("{} markers from {} places; worst sigma {:.2f} mm\n", survey.markers.size(),
                                 survey.keyframes, mm_per_m * worst_sigma_m(survey));
  text +=
      survey.gauge == SurveyGauge::anchored
          ? std::string("in the map's frame, by anchors\n")
          : std::string(
                "in a frame of its own: where it lies on the map and how it is turned is not known; anchors "
                "would say it\n");
  text +=
      fmt::format("print scale {:.5f} +- {:.3f} %\n", survey.print_scale, percent * survey.print_scale_sigma);
  text += noticeable_errors(survey);
  const RollPitchYaw angles = angles_of(survey.mount.base_from_camera.linear());
  const Vec3& at = survey.mount.base_from_camera.translation();
  const Vec3& off = survey.mount.position_sigmas_m;
  text += fmt::format(
      "camera on the base: x {:.4f} +- {:.4f} m, y {:.4f} +- {:.4f} m, roll {:.3f}, pitch {:.3f}, "
      "yaw {:.3f} deg (height as in the robot file)\n",
      at.x(), off.x(), at.y(), off.y(), degrees(angles.roll_rad), degrees(angles.pitch_rad),
      degrees(angles.yaw_rad));
  text += fmt::format("wheels: left {:.4f}, right {:.4f} of what they report; track {:.4f} m\n",
                      survey.mount.left_scale, survey.mount.right_scale, survey.mount.track_width_m);
  text += fmt::format(
      "residuals over sigmas squared: dots {:.2f}, wheels {:.2f}, ceiling {:.2f}, anchors {:.2f}\n\n",
      survey.dots_factor, survey.wheels_factor, survey.ceiling_factor, survey.gauge_factor);
  text += "  ID       x m       y m      z m   yaw deg  sigma mm   deg  places\n";
  for (std::size_t m = 0; m < survey.markers.size(); ++m) {
    const RegisteredMarker& marker = survey.markers[m];
    const MarkerSigma sigma = marker.sigma.value_or(MarkerSigma{});
    text += fmt::format("{:4} {:9.4f} {:9.4f} {:8.4f} {:9.3f} {:9.2f} {:5.3f} {:7}\n", marker.id,
                        marker.position_m.x(), marker.position_m.y(), marker.position_m.z(),
                        degrees(marker.yaw_rad), mm_per_m * sigma.position_m, degrees(sigma.yaw_rad),
                        survey.sightings[m]);
  }
  return text;
}

nlohmann::ordered_json json_report(const MarkerSurvey& survey) {
  auto markers = nlohmann::ordered_json::array();
  for (std::size_t m = 0; m < survey.markers.size(); ++m)
    markers.push_back(as_json(survey.markers[m], survey.sightings[m]));
  auto flaws = nlohmann::ordered_json::array();
  for (const SurveyRefusal& flaw : survey.flaws)
    flaws.push_back({{"flaw", to_string(flaw.flaw)}, {"found", flaw.found}, {"advice", advice(flaw.flaw)}});
  auto anchors = nlohmann::ordered_json::array();
  for (const AnchorCheck& check : survey.anchor_checks)
    anchors.push_back({{"anchor", check.anchor}, {"noticeable_m", finite(check.noticeable_m)}});
  const RollPitchYaw angles = angles_of(survey.mount.base_from_camera.linear());
  const Vec3& at = survey.mount.base_from_camera.translation();
  return {{"flaws", flaws},
          {"gauge", survey.gauge == SurveyGauge::anchored ? "anchored" : "free"},
          {"keyframes", survey.keyframes},
          {"worst_sigma_m", worst_sigma_m(survey)},
          {"dots_factor", survey.dots_factor},
          {"wheels_factor", survey.wheels_factor},
          {"ceiling_factor", survey.ceiling_factor},
          {"gauge_factor", survey.gauge_factor},
          {"print_scale", survey.print_scale},
          {"print_scale_sigma", survey.print_scale_sigma},
          {"noticeable_print_scale", finite(survey.noticeable_print_scale)},
          {"anchors", anchors},
          {"k1_off", survey.k1_off},
          {"k1_sigma", survey.k1_sigma},
          {"mount",
           {{"x_m", at.x()},
            {"y_m", at.y()},
            {"roll_deg", degrees(angles.roll_rad)},
            {"pitch_deg", degrees(angles.pitch_rad)},
            {"yaw_deg", degrees(angles.yaw_rad)},
            {"sigma_x_m", survey.mount.position_sigmas_m.x()},
            {"sigma_y_m", survey.mount.position_sigmas_m.y()},
            {"sigma_yaw_deg", degrees(survey.mount.angle_sigmas_rad.z())}}},
          {"wheels",
           {{"left_scale", survey.mount.left_scale},
            {"right_scale", survey.mount.right_scale},
            {"track_width_m", survey.mount.track_width_m}}},
          {"markers", markers}};
}

std::vector<std::string> complaints(const MarkerSurvey& survey) {
  std::vector<std::string> lines;
  for (const SurveyRefusal& flaw : survey.flaws)
    lines.push_back(fmt::format("{}: {}; {}", to_string(flaw.flaw), flaw.found, advice(flaw.flaw)));
  return lines;
}

MarkerRegistry registry_of(const MarkerSurvey& survey) {
  constexpr double steps_per_m = 1e6;
  constexpr double steps_per_rad = 1.0 / radians(1e-5);
  MarkerRegistry registry{.markers = survey.markers};
  for (RegisteredMarker& marker : registry.markers) {
    for (double& coordinate : marker.position_m) coordinate = tidy(coordinate, steps_per_m);
    marker.yaw_rad = tidy(marker.yaw_rad, steps_per_rad);
    if (marker.sigma)
      marker.sigma = MarkerSigma{tidy(marker.sigma->position_m, steps_per_m),
                                 tidy(marker.sigma->yaw_rad, steps_per_rad)};
  }
  return registry;
}

std::string provenance_yaml(const MarkerSurvey& survey, std::span<const SurveyLog> logs,
                            const std::filesystem::path& anchors, const std::string& date) {
  std::string text = fmt::format("format: lodestar-survey\nversion: 1\ndate: '{}'\nlogs:\n", date);
  for (const SurveyLog& log : logs)
    text += fmt::format("  - {{name: '{}', frames: {}, wheel_readings: {}}}\n", log.name, log.frames.size(),
                        log.wheels.size());
  if (!anchors.empty()) text += fmt::format("anchors: '{}'\n", anchors.filename().string());
  text += fmt::format(
      "gauge: {}\nkeyframes: {}\ndots_factor: {:.4f}\nwheels_factor: {:.4f}\n"
      "ceiling_factor: {:.4f}\ngauge_factor: {:.4f}\n",
      survey.gauge == SurveyGauge::anchored ? "anchored" : "free", survey.keyframes, survey.dots_factor,
      survey.wheels_factor, survey.ceiling_factor, survey.gauge_factor);
  text +=
      fmt::format("print_scale: {{scale: {:.7f}, sigma: {:.7f}}}\nk1_off: {{value: {:.6f}, sigma: {:.6f}}}\n",
                  survey.print_scale, survey.print_scale_sigma, survey.k1_off, survey.k1_sigma);
  text += fmt::format(
      "noticeable:  # errors that would have been noticed, 8 of 10 times; .inf: never\n  print_scale: {}\n",
      yaml_number(survey.noticeable_print_scale));
  for (const AnchorCheck& check : survey.anchor_checks)
    text += fmt::format("  '{}': {}  # m\n", check.anchor, yaml_number(check.noticeable_m));
  text += "links:  # markers seen in one frame, and from how many places\n";
  for (const SurveyLink& link : survey.links)
    text +=
        fmt::format("  - {{between: [{}, {}], keyframes: {}}}\n", link.first, link.second, link.keyframes);
  text += "covariances:  # of (x_m, y_m, yaw_rad): xx, xy, yy, x yaw, y yaw, yaw yaw\n";
  for (std::size_t m = 0; m < survey.markers.size(); ++m) {
    const Eigen::Matrix3d c =
        survey.covariance.block<3, 3>(3 * static_cast<Eigen::Index>(m), 3 * static_cast<Eigen::Index>(m));
    text += fmt::format(
        "  - {{id: {}, keyframes: {}, covariance: [{:.4e}, {:.4e}, {:.4e}, {:.4e}, {:.4e}, {:.4e}]}}\n",
        survey.markers[m].id, survey.sightings[m], c(0, 0), c(0, 1), c(1, 1), c(0, 2), c(1, 2), c(2, 2));
  }
  return text;
}

std::string covariance_npy(const Eigen::MatrixXd& covariance) {
  std::string header = fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, {}), }}",
                                   covariance.rows(), covariance.cols());
  constexpr std::size_t before = 10;  // magic, version, length
  constexpr std::size_t aligned = 64;
  header.append(aligned - 1 - (before + header.size()) % aligned, ' ');
  header += '\n';
  const auto length = static_cast<std::uint16_t>(header.size());
  std::string file("\x93NUMPY\x01\x00", 8);
  file += static_cast<char>(length & 0xffU);
  file += static_cast<char>(length >> 8U);
  file += header;
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = covariance;
  file.append(reinterpret_cast<const char*>(rows.data()),
              sizeof(double) * static_cast<std::size_t>(rows.size()));
  return file;
}

std::string csv_report(const SurveyDifference& difference) {
  std::string text = "id,change,dx_m,dy_m,dyaw_deg,sigma_xy_m,sigma_yaw_deg\n";
  for (const MarkerProposal& p : difference.proposals)
    text += fmt::format("{},{},{:.5f},{:.5f},{:.4f},{:.5f},{:.4f}\n", p.id, to_string(p.change),
                        p.offset_m.x(), p.offset_m.y(), degrees(p.turn_rad), p.sigma_m, degrees(p.sigma_rad));
  return text;
}

std::string text_report(const SurveyDifference& difference) {
  std::string text = fmt::format("{} markers hang where they are registered\n", difference.unchanged);
  constexpr double worth_saying = 1e-3;
  if (std::abs(difference.scale - 1.0) > worth_saying)
    text +=
        fmt::format("the registry's distances are {:.5f} of the drive's: one of the two has a wrong scale\n",
                    difference.scale);
  for (const MarkerProposal& p : difference.proposals) {
    if (p.change == MarkerChange::gone) {
      text += fmt::format("{:4} gone: not seen where it should be\n", p.id);
    } else if (p.change == MarkerChange::appeared) {
      text += fmt::format("{:4} new: at {:.4f}, {:.4f} m, {:.2f} deg, +- {:.1f} mm\n", p.id,
                          p.proposed.position_m.x(), p.proposed.position_m.y(), degrees(p.proposed.yaw_rad),
                          mm_per_m * p.sigma_m);
    } else {
      text += fmt::format("{:4} {}: by {:.1f}, {:.1f} mm and {:.2f} deg, +- {:.1f} mm and {:.2f} deg\n", p.id,
                          to_string(p.change), mm_per_m * p.offset_m.x(), mm_per_m * p.offset_m.y(),
                          degrees(p.turn_rad), mm_per_m * p.sigma_m, degrees(p.sigma_rad));
    }
  }
  return text;
}

nlohmann::ordered_json json_report(const SurveyDifference& difference) {
  auto proposals = nlohmann::ordered_json::array();
  for (const MarkerProposal& p : difference.proposals)
    proposals.push_back({{"id", p.id},
                         {"change", to_string(p.change)},
                         {"dx_m", p.offset_m.x()},
                         {"dy_m", p.offset_m.y()},
                         {"dyaw_deg", degrees(p.turn_rad)},
                         {"sigma_xy_m", p.sigma_m},
                         {"sigma_yaw_deg", degrees(p.sigma_rad)},
                         {"x_m", p.proposed.position_m.x()},
                         {"y_m", p.proposed.position_m.y()},
                         {"z_m", p.proposed.position_m.z()},
                         {"yaw_deg", degrees(p.proposed.yaw_rad)}});
  return {
      {"unchanged", difference.unchanged}, {"registry_scale", difference.scale}, {"proposals", proposals}};
}

MarkerRegistry with_proposals(MarkerRegistry registry, const SurveyDifference& difference) {
  for (const MarkerProposal& p : difference.proposals) {
    const auto known = std::ranges::find(registry.markers, p.id, &RegisteredMarker::id);
    if (p.change == MarkerChange::appeared) {
      registry.markers.push_back(p.proposed);
    } else if (p.change == MarkerChange::gone) {
      registry.markers.erase(known);
    } else {
      *known = p.proposed;
    }
  }
  MarkerSurvey rounded;
  rounded.markers = std::move(registry.markers);
  registry.markers = registry_of(rounded).markers;
  return registry;
}

}  // namespace lodestar

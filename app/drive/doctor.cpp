#include "app/drive/doctor.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

#include "app/drive/base_findings.hpp"
#include "app/drive/camera_findings.hpp"
#include "app/drive/camera_setup.hpp"
#include "app/drive/range_findings.hpp"
#include "app/drive/service_findings.hpp"
#include "app/navigation/navigation_setup.hpp"
#include "app/placement/places_check.hpp"
#include "app/placement/registry_check.hpp"
#include "drivers/can/can_interface.hpp"
#include "drivers/can/socketcan_bus.hpp"
#include "drivers/system/clock.hpp"
#include "localization/detection/marker_detector.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

constexpr Duration listening = std::chrono::seconds(1);

Finding look_at_map(const Site& site) {
  const OccupancyMap& map = site.map.map;
  Finding finding{.what = "map",
                  .found = fmt::format("{} x {} cells of {} m", map.columns, map.rows, map.resolution_m)};
  if (!site.map.warnings.empty()) {
    finding.verdict = Verdict::doubtful;
    finding.found += "; " + site.map.warnings.front();
    finding.remedy = "see `lodestar map info`";
  }
  return finding;
}

Finding look_at_registry(const Site& site) {
  Finding finding{.what = "registry", .found = fmt::format("{} markers", site.registry.markers.size())};
  const std::vector<RegistryIssue> issues = check_registry(site.registry, site.map.map);
  const auto error = std::ranges::find_if(issues, &RegistryIssue::error);
  if (error == issues.end() && !site.registry.markers.empty()) return finding;
  finding.verdict = Verdict::bad;
  if (error != issues.end()) finding.found += "; " + error->words;
  finding.remedy = "see `lodestar markers check`";
  return finding;
}

Finding look_at_places(const Site& site) {
  const Places& places = site.places;
  Finding finding{.what = "places",
                  .found = fmt::format("{} places, {} keep-outs, {} speed zones", places.places.size(),
                                       places.keep_out.size(), places.speed_zones.size())};
  const std::vector<PlacesIssue> issues = check_places(site);
  if (issues.empty()) return finding;
  finding.verdict = issues.front().error ? Verdict::bad : Verdict::doubtful;
  finding.found += "; " + issues.front().words;
  finding.remedy = "see `lodestar places check`";
  return finding;
}

Finding look_at_calibration(const Site& site) {
  const CameraModel& camera = site.cameras.at(site.default_camera);
  Finding finding{.what = "calibration",
                  .found = fmt::format(
                      "camera '{}': {} x {} pixels, focal length {:.1f} pixels, {:.2f} m above the floor",
                      site.default_camera, camera.width_px, camera.height_px, camera.fx_px,
                      site.robot.base_from_camera.translation().z())};
  const bool is_level = site.robot.camera_mount.roll_rad == 0.0 && site.robot.camera_mount.pitch_rad == 0.0;
  if (!is_level) return finding;
  finding.verdict = Verdict::doubtful;
  finding.found += "; its mount is given as exactly level";
  finding.remedy = "calibrate the mount: no mount is";
  return finding;
}

std::vector<Finding> look_at_interface(const std::string& name) {
  const CanInterface seen = look_at_can_interface(name);
  Finding interface{.what = "interface", .found = name + " is up"};
  if (const auto problem = problem_of(name, seen)) {
    interface.verdict = Verdict::bad;
    interface.found = problem->found;
    interface.remedy = problem->remedy;
    return {interface};
  }
  if (seen.is_virtual) return {interface, {.what = "bit rate", .found = "none: the interface is virtual"}};

  Finding rate{.what = "bit rate", .found = "not reported by this interface"};
  if (seen.bit_rate_bps) rate.found = fmt::format("{} bit/s", *seen.bit_rate_bps);
  if (!seen.bit_rate_bps || *seen.bit_rate_bps != usual_can_bit_rate_bps) {
    rate.verdict = Verdict::doubtful;
    rate.remedy = fmt::format("bases use {} bit/s: sudo ip link set {} type can bitrate {}",
                              usual_can_bit_rate_bps, name, usual_can_bit_rate_bps);
  }
  Finding controller{.what = "controller",
                     .found = seen.controller.value_or("not reported by this interface")};
  if (seen.transmit_errors) {
    controller.found +=
        fmt::format(", {} errors in sending, {} in receiving", *seen.transmit_errors, *seen.receive_errors);
  }
  if (seen.controller && *seen.controller != "error-active") {
    controller.verdict = *seen.controller == "bus-off" ? Verdict::bad : Verdict::doubtful;
    controller.remedy = fmt::format(
        "check wiring, termination (60 ohm) and bit rate; then sudo ip link set {0} down; "
        "sudo ip link set {0} up",
        name);
  }
  return {interface, rate, controller};
}

/// CAN frames, images, markers and scans received within a second.
struct Heard {
  HeardBase base;
  SeenImages images;
  SeenRanges ranges;
};

Heard listen(const Site& site, const BaseConnection& connection, BaseProtocol& protocol) {
  SocketCanBus bus(connection.interface, {.identifiers = protocol.identifiers()});
  Heard heard;
  std::unique_ptr<Camera> camera;
  try {
    camera = open_camera(site, connection, 1);
  } catch (const InputError& error) {
    heard.images.no_camera = error.what();
  }
  std::unique_ptr<Scanner> scanner;
  std::unique_ptr<DepthCamera> depth_camera;
  try {
    scanner = scanner_of(site);
  } catch (const InputError& error) {
    heard.ranges.no_scanner = error.what();
  }
  try {
    depth_camera = depth_camera_of(site);
  } catch (const InputError& error) {
    heard.ranges.no_depth_camera = error.what();
  }
  MarkerDetector detector(navigation_options(site.robot).detector);
  for (const Stamp end = monotonic_now() + listening; monotonic_now() < end;) {
    while (const auto received = bus.poll()) heard.base.take(*received, protocol.decode(*received));
    while (const auto frame = camera ? camera->poll() : std::nullopt) {
      heard.images.take(frame->stamp, monotonic_now());
      for (const DetectedMarker& marker : detector.detect(frame->gray))
        heard.images.markers.insert(marker.id);
    }
    while (const auto scan = scanner ? scanner->poll() : std::nullopt)
      heard.ranges.take(*scan, monotonic_now());
    while (const auto image = depth_camera ? depth_camera->poll() : std::nullopt) heard.ranges.take(*image);
    sleep_until(monotonic_now() + std::chrono::milliseconds(5));
  }
  if (scanner) {
    heard.ranges.packets = scanner->packets();
    heard.ranges.description = scanner->description();
  }
  if (depth_camera) heard.ranges.depth_description = depth_camera->description();
  if (camera) heard.images.description = camera->description();
  return heard;
}

ServiceSite service_site(const Site& site, const BaseConnection& connection) {
  const fs::path folder = fs::weakly_canonical(site.folder);
  const bool is_virtual =
      look_at_can_interface(connection.interface).is_virtual || connection.interface.starts_with("vcan");
  return {.name = folder.filename(),
          .folder = folder,
          .interface = connection.interface,
          .is_virtual_interface = is_virtual,
          .bit_rate_bps = usual_can_bit_rate_bps};
}

}  // namespace

std::vector<Finding> examine(const Site& site, const BaseConnection& connection) {
  std::vector<Finding> findings{look_at_map(site), look_at_registry(site), look_at_places(site),
                                look_at_calibration(site)};
  const auto add = [&findings](std::vector<Finding> more) {
    std::ranges::move(more, std::back_inserter(findings));
  };
  add(look_at_interface(connection.interface));
  const bool is_usable = findings.back().what != "interface" || findings.back().verdict == Verdict::good;
  add(look_at_service(service_site(site, connection)));
  if (!is_usable) return findings;
  const std::unique_ptr<BaseProtocol> protocol = make_protocol(connection, site.robot);
  const Heard heard = listen(site, connection, *protocol);
  add(look_at_base(heard.base, *protocol, base_driver_options(site.robot, *protocol).ignored_fault_bits));
  add(look_at_images(site, heard.images));
  add(look_at_ranges(site.robot, heard.ranges));
  return findings;
}

}  // namespace lodestar

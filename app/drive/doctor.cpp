#include "app/drive/doctor.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <set>

#include "app/drive/camera_setup.hpp"
#include "app/navigation/navigation_setup.hpp"
#include "app/placement/registry_check.hpp"
#include "drivers/can/can_interface.hpp"
#include "drivers/can/socketcan_bus.hpp"
#include "drivers/system/clock.hpp"
#include "localization/detection/marker_detector.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

constexpr Duration listening = std::chrono::seconds(1);
constexpr std::uint32_t usual_bit_rate_bps = 500'000;

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
  const bool wants_virtual = name.starts_with("vcan");
  if (!seen.exists || !seen.is_up) {
    interface.verdict = Verdict::bad;
    interface.found = name + (seen.exists ? " is down" : " does not exist");
    interface.remedy =
        wants_virtual && !seen.exists ? fmt::format("sudo ip link add dev {} type vcan", name)
        : !seen.exists                ? "plug in the CAN adapter, or name another interface: ip link"
        : wants_virtual               ? fmt::format("sudo ip link set {} up", name)
                        : fmt::format("sudo ip link set {} up type can bitrate {}", name, usual_bit_rate_bps);
    return {interface};
  }
  if (seen.is_virtual) return {interface, {.what = "bit rate", .found = "none: the interface is virtual"}};

  Finding rate{.what = "bit rate", .found = "not reported by this interface"};
  if (seen.bit_rate_bps) rate.found = fmt::format("{} bit/s", *seen.bit_rate_bps);
  if (!seen.bit_rate_bps || *seen.bit_rate_bps != usual_bit_rate_bps) {
    rate.verdict = Verdict::doubtful;
    rate.remedy = fmt::format("bases use {} bit/s: sudo ip link set {} type can bitrate {}",
                              usual_bit_rate_bps, name, usual_bit_rate_bps);
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

/// CAN frames, images and markers received within a second.
struct Heard {
  struct Kind {
    int count = 0;
    Stamp newest;
  };
  std::map<std::uint32_t, Kind> kinds;  ///< by identifier
  std::optional<Stamp> newest;
  std::optional<SystemState> system;
  int other_masters = 0;
  int odd = 0;
  std::string no_camera;  ///< why it could not be opened
  int images = 0;
  std::set<int> markers;
};

Heard listen(const Site& site, const BaseConnection& connection, BaseProtocol& protocol) {
  SocketCanBus bus(connection.interface, {.identifiers = protocol.identifiers()});
  Heard heard;
  std::unique_ptr<Camera> camera;
  try {
    camera = open_camera(site, connection, 1);
  } catch (const InputError& error) {
    heard.no_camera = error.what();
  }
  MarkerDetector detector(navigation_options(site.robot).detector);
  for (const Stamp end = monotonic_now() + listening; monotonic_now() < end;) {
    while (const auto received = bus.poll()) {
      const HeardFrame said = protocol.decode(*received);
      Heard::Kind& kind = heard.kinds[received->frame.id];
      ++kind.count;
      kind.newest = received->stamp;
      heard.odd += said.odd ? 1 : 0;
      heard.other_masters += said.command ? 1 : 0;
      if (said.from_base) heard.newest = received->stamp;
      if (said.system) heard.system = said.system;
    }
    while (const auto frame = camera ? camera->poll() : std::nullopt) {
      ++heard.images;
      for (const DetectedMarker& marker : detector.detect(frame->gray)) heard.markers.insert(marker.id);
    }
    sleep_until(monotonic_now() + std::chrono::milliseconds(5));
  }
  return heard;
}

Finding look_at_frames(const Heard& heard) {
  if (!heard.newest) {
    return {.what = "base",
            .verdict = Verdict::bad,
            .found = heard.kinds.empty() ? "silent: no frame in a second"
                                         : "none of the frames heard is the base's",
            .remedy = "switch the base on; check the plug, the bit rate and the protocol in site.yaml"};
  }
  const Stamp now = monotonic_now();
  std::string kinds;
  for (const auto& [id, kind] : heard.kinds)
    kinds += fmt::format(" {:03X} x {} ({:.0f} ms)", id, kind.count, 1e3 * seconds(now - kind.newest));
  Finding finding{.what = "base", .found = "heard in a second (the newest so long ago):" + kinds};
  if (heard.odd > 0) {
    finding.verdict = Verdict::doubtful;
    finding.found += fmt::format("; {} frames are odd", heard.odd);
    finding.remedy = "check the protocol in site.yaml and what else is on the bus";
  }
  return finding;
}

std::vector<Finding> look_at_state(const Heard& heard, const BaseProtocol& protocol) {
  if (!heard.system) {
    return {{.what = "mode",
             .verdict = Verdict::bad,
             .found = "the base does not report its state",
             .remedy = "check the protocol in site.yaml; of two axes, both must send"}};
  }
  const SystemState& system = *heard.system;
  Finding mode{.what = "mode", .found = "takes commands from CAN"};
  if (system.mode == ControlMode::standby) mode.found = "standby; a run requests CAN mode";
  if (system.mode == ControlMode::remote) {
    mode = {.what = "mode",
            .verdict = Verdict::bad,
            .found = "the remote control drives",
            .remedy = "switch the remote control to CAN mode, or off"};
  }
  if (system.mode == ControlMode::uart || system.mode == ControlMode::unknown) {
    mode = {.what = "mode",
            .verdict = Verdict::doubtful,
            .found = "another controller has the base",
            .remedy = "end what commands it over the serial line"};
  }
  Finding stop{.what = "e-stop", .found = "released"};
  if (system.vehicle == VehicleState::emergency_stop) {
    stop = {
        .what = "e-stop", .verdict = Verdict::bad, .found = "pressed", .remedy = "release it, then resume"};
  }
  Finding faults{.what = "faults", .found = "none"};
  if (system.fault_bits != 0) {
    faults = {.what = "faults",
              .verdict = Verdict::bad,
              .found = fmt::format("{}", fmt::join(protocol.fault_names(system.fault_bits), ", ")),
              .remedy = "find the cause; `resume` asks the base to clear them"};
  }
  Finding masters{.what = "masters", .found = "no motion commands"};
  if (heard.other_masters > 0) {
    masters = {.what = "masters",
               .verdict = Verdict::doubtful,
               .found = fmt::format("{} motion commands of another program", heard.other_masters),
               .remedy = "end it before a run: two masters stop each other"};
  }
  return {mode, stop, faults, masters};
}

std::vector<Finding> look_at_images(const Site& site, const Heard& heard) {
  if (heard.images == 0) {
    return {{.what = "camera",
             .verdict = Verdict::bad,
             .found = heard.no_camera.empty() ? "no image in a second" : heard.no_camera,
             .remedy = site.camera == "simulated" ? "start the simulated world: lodestar base --can ..."
                                                  : "plug the camera in; check its device in site.yaml"}};
  }
  Finding camera{.what = "camera", .found = fmt::format("{} images in a second", heard.images)};
  Finding markers{.what = "markers", .found = fmt::format("seen: {}", fmt::join(heard.markers, " "))};
  const bool knows_one = std::ranges::any_of(heard.markers, [&](int id) {
    return std::ranges::find(site.registry.markers, id, &RegisteredMarker::id) != site.registry.markers.end();
  });
  if (!knows_one) {
    markers.verdict = Verdict::bad;
    markers.found = heard.markers.empty() ? "none seen" : markers.found + "; none of them is in the registry";
    markers.remedy = "move the robot under a marker; check the infrared light and the registry";
  }
  return {camera, markers};
}

}  // namespace

std::vector<Finding> examine(const Site& site, const BaseConnection& connection) {
  std::vector<Finding> findings{look_at_map(site), look_at_registry(site), look_at_calibration(site)};
  const auto add = [&findings](std::vector<Finding> more) {
    std::ranges::move(more, std::back_inserter(findings));
  };
  add(look_at_interface(connection.interface));
  const bool is_usable = findings.back().what != "interface" || findings.back().verdict == Verdict::good;
  if (!is_usable) return findings;
  const std::unique_ptr<BaseProtocol> protocol = make_protocol(connection, site.robot);
  const Heard heard = listen(site, connection, *protocol);
  findings.push_back(look_at_frames(heard));
  if (heard.newest) add(look_at_state(heard, *protocol));
  add(look_at_images(site, heard));
  return findings;
}

}  // namespace lodestar

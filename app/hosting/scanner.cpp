#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "app/common/interruption.hpp"
#include "app/common/log.hpp"
#include "app/hosting/hosting.hpp"
#include "app/site/site.hpp"
#include "app/site/site_folder.hpp"
#include "drivers/scanner/hosted_scanner.hpp"
#include "drivers/scanner/ld19_stand_in.hpp"
#include "drivers/scanner/nanoscan_stand_in.hpp"
#include "drivers/scanner/rplidar_stand_in.hpp"
#include "drivers/scanner/scip_stand_in.hpp"
#include "maps/input_error.hpp"
#include "maps/ray_casting.hpp"

namespace lodestar {
namespace {

struct ScannerArguments {
  std::string site;
  std::string pty;
  std::string tcp;
  std::string udp;
  std::string protocol = "rplidar";
};

/// Without a site: the scanner stands in the middle of a square room, its x axis square to a wall.
constexpr double room_half_m = 2.0;
constexpr double longest_range_m = 64.0;

std::optional<double> range_in_room_m(double angle_rad) {
  return room_half_m / std::max(std::abs(std::cos(angle_rad)), std::abs(std::sin(angle_rad)));
}

RangeOfAngle surroundings_of(const ScannerArguments& arguments) {
  if (arguments.site.empty()) return range_in_room_m;
  const Site site = open_site(arguments.site);
  const Pose2 base_from_scanner = site.robot.scanner ? site.robot.scanner->mount.base_from_scanner : Pose2();
  const Pose2 map_from_scanner = site.start * base_from_scanner;
  return [map = site.map.map, map_from_scanner](double angle_rad) {
    return range_to_obstacle_m(map, map_from_scanner.position_m, map_from_scanner.yaw_rad + angle_rad,
                               longest_range_m);
  };
}

std::unique_ptr<ScannerStandIn> stand_in_of(const std::string& protocol) {
  if (protocol == "ld19") return std::make_unique<Ld19StandIn>();
  if (protocol == "scip") return std::make_unique<ScipStandIn>();
  if (protocol == "nanoscan") return std::make_unique<NanoscanStandIn>();
  return std::make_unique<RplidarStandIn>();
}

struct HostAndPort {
  std::string host = "127.0.0.1";
  unsigned port = 0;
};

HostAndPort host_and_port(const std::string& option, const std::string& text) {
  const std::size_t colon = text.rfind(':');
  HostAndPort place;
  if (colon != std::string::npos) place.host = text.substr(0, colon);
  const char* const begin = text.data() + (colon == std::string::npos ? 0 : colon + 1);
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(begin, end, place.port);
  constexpr unsigned most_port = 65535;
  if (error == std::errc() && stop == end && place.port > 0 && place.port <= most_port) return place;
  throw InputError(fmt::format("{}: found '{}', wanted [HOST:]PORT such as 127.0.0.1:10940", option, text));
}

std::unique_ptr<ServedLink> link_of(const ScannerArguments& arguments) {
  const bool is_datagrams = arguments.protocol == "nanoscan";
  if (is_datagrams != !arguments.udp.empty())
    throw InputError(
        fmt::format("scanner: found protocol {} with{} --udp, wanted --udp with nanoscan, and --pty "
                    "or --tcp with the others",
                    arguments.protocol, arguments.udp.empty() ? "out" : ""));
  if (!arguments.udp.empty()) {
    const HostAndPort place = host_and_port("--udp", arguments.udp);
    return serve_udp(place.host, place.port);
  }
  if (!arguments.tcp.empty()) {
    const HostAndPort place = host_and_port("--tcp", arguments.tcp);
    return serve_tcp(place.host, place.port);
  }
  if (!arguments.pty.empty()) return serve_pty(arguments.pty);
  throw InputError("scanner: found nothing to serve it at, wanted --pty, --tcp or --udp");
}

ExitCode scanner_command(const ScannerArguments& arguments) {
  const RangeOfAngle surroundings = surroundings_of(arguments);
  HostedScanner scanner(stand_in_of(arguments.protocol), link_of(arguments), surroundings);
  const Interruption interruption;
  log_info(fmt::format("a simulated scanner speaks {}; Ctrl-C ends it", arguments.protocol));
  host(scanner, [] { return Interruption::asked(); });
  return done;
}

}  // namespace

std::vector<Command> scanner_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<ScannerArguments>();
  CLI::App* command = lodestar.add_subcommand(
      "scanner", "A simulated laser scanner at rest, in real time and in a maker's protocol, for any client");
  command->add_option(
      "site", arguments->site,
      "Site folder at whose start it stands; default: the middle of an empty room of 4 x 4 m");
  auto* const pty = command->add_option("--pty", arguments->pty, "Serve a pseudo terminal with this name");
  auto* const tcp = command->add_option("--tcp", arguments->tcp, "Serve TCP at [HOST:]PORT; host 127.0.0.1");
  auto* const udp = command->add_option("--udp", arguments->udp, "Send UDP to [HOST:]PORT; host 127.0.0.1");
  pty->excludes(tcp)->excludes(udp);
  tcp->excludes(udp);
  command->add_option("--protocol", arguments->protocol, "rplidar, ld19, scip (Hokuyo) or nanoscan (SICK)")
      ->check(CLI::IsMember({"rplidar", "ld19", "scip", "nanoscan"}))
      ->capture_default_str();
  return {{command, [arguments] { return scanner_command(*arguments); }}};
}

}  // namespace lodestar

#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>

#include "app/fleet/fleet_session.hpp"
#include "app/fleet/fleet_transport.hpp"
#include "app/site/site.hpp"

namespace lodestar {

/// `--fleet [URL]`: present or not, and the broker that it names instead of the site's.
struct FleetArguments {
  bool is_wanted = false;
  std::string broker;
};
/// Fills the arguments, which must outlive the application.
CLI::Option* add_fleet_option(CLI::App& command, FleetArguments& arguments);

/// The settings of the site with the broker of the command line. Throws InputError where there are none;
/// a simulated robot of a site without any is `lodestar` / the site's name.
FleetSettings fleet_settings(const Site& site, const FleetArguments& arguments, bool is_simulated);

/// A robot in a fleet: what carries out its orders, and the connection to the broker.
class FleetService {
 public:
  /// `name` goes before what it says, where several robots speak.
  FleetService(const Site& site, const FleetSettings& settings, const std::string& name = {});

  [[nodiscard]] FleetSession& session() { return session_; }

 private:
  FleetLink link_;
  FleetSession session_;
  FleetTransport transport_;  ///< ends first: it uses the link
};

}  // namespace lodestar

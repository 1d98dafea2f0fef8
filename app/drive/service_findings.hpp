#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "app/drive/finding.hpp"

namespace lodestar {

/// Where systemd and the packages keep things; a test has a tree of its own.
struct ServicePlaces {
  std::filesystem::path root = "/";
};

/// What the service of a site needs to know of it.
struct ServiceSite {
  std::string name;                   ///< of its folder: lodestar@NAME
  std::filesystem::path folder;       ///< absolute
  std::string interface;              ///< of CAN
  bool is_virtual_interface = false;  ///< has no controller: nobody brings it up at boot
  std::uint32_t bit_rate_bps = 500'000;
};

/// Whether lodestar@NAME would run after a restart of the machine: the unit, the site's folder and who may
/// write it, the state folder, and CAN. Nothing where there is no systemd.
std::vector<Finding> look_at_service(const ServiceSite& site, const ServicePlaces& places = {});

/// The findings' commands as a script for sh, with what each is for; empty when there are none. They are
/// printed for the operator, never run.
std::string fix_script(const std::vector<Finding>& findings);

}  // namespace lodestar

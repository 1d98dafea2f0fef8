#include "app/commands/charge_option.hpp"

#include <fmt/core.h>

#include "app/common/log.hpp"
#include "maps/input_error.hpp"

namespace lodestar {

CLI::Option* add_charge_option(CLI::App& command, bool& is_wanted) {
  return command.add_flag("--charge", is_wanted,
                          "After the goals, if any are given, drive onto the dock that site.yaml names, and "
                          "stay until the battery is full");
}

std::optional<Charging> charging_of(const Site& site, bool goes_by_itself) {
  if (!site.charging) return std::nullopt;
  ChargingSettings settings = *site.charging;
  if (!goes_by_itself) settings.low_v.reset();
  return Charging(std::move(settings), log_info);
}

Charging charging_after(std::vector<Goal>& goals, const Site& site) {
  std::optional<Charging> charging = charging_of(site, false);
  if (!charging)
    throw InputError(site.folder / "site.yaml", 0, "no charging", "charging: {place, full_v} for --charge");
  const std::vector<Goal> way = charging->goals();
  goals.insert(goals.end(), way.begin(), way.end());
  charging->expect(goals.size() - 1);
  return *charging;
}

bool print_charge(const Charging& charging) {
  const bool is_full = charging.state() == ChargingState::full;
  fmt::print("{}\n", is_full ? "charged" : "not charged: " + charging.failure());
  return is_full;
}

}  // namespace lodestar

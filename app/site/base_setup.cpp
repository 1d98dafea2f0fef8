#include "app/site/base_setup.hpp"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

/// "0x0400"; nothing for other texts.
std::optional<std::uint32_t> bits_in(const std::string& text) {
  constexpr std::size_t prefix = 2;
  if (!text.starts_with("0x")) return std::nullopt;
  std::uint32_t bits = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + prefix, end, bits, 16);
  return error == std::errc() && stop == end ? std::optional(bits) : std::nullopt;
}

std::uint32_t ignored_bits(const BaseSettings& settings, const BaseProtocol& protocol) {
  const std::span<const FaultBit> known = protocol.known_fault_bits();
  std::uint32_t ignored = 0;
  for (const std::string& fault : settings.ignored_faults) {
    const auto named = std::ranges::find(known, fault, &FaultBit::name);
    if (named != known.end()) {
      ignored |= named->bit;
    } else if (const auto bits = bits_in(fault)) {
      ignored |= *bits;
    } else {
      std::vector<std::string_view> names;
      for (const FaultBit& bit : known) names.push_back(bit.name);
      throw InputError(
          settings.file, settings.line, fmt::format("ignored_faults: '{}'", fault),
          fmt::format("the number of a bit, such as 0x0800, or one of: {}", fmt::join(names, ", ")));
    }
  }
  return ignored;
}

}  // namespace

BaseConnection connection_of(const Site& site, const std::string& interface) {
  BaseConnection base = site.base.value_or(BaseConnection{});
  if (!interface.empty()) base.interface = interface;
  if (!base.interface.empty()) return base;
  throw InputError(site.folder / "site.yaml", 0, "no key base",
                   "base: {bus: socketcan:can0, protocol: agilex}");
}

std::unique_ptr<BaseProtocol> make_protocol(const BaseConnection& connection, const Robot& robot) {
  // Pushed by hand or driven by remote control the base may exceed the navigator's limits.
  const double max_plausible_wheel_mps = 2.0 * robot.max_wheel_mps;
  std::unique_ptr<BaseProtocol> protocol;
  if (connection.protocol == "agilex") {
    const BaseModel model = connection.model == "hunter"  ? BaseModel::hunter
                            : connection.model == "scout" ? BaseModel::scout
                                                          : BaseModel::tracer;
    protocol = make_agilex_protocol(model, max_plausible_wheel_mps, robot.base.modes);
  } else {
    if (!robot.base.modes.empty())
      throw InputError(robot.base.file, robot.base.line, "modes, of a base that has none",
                       "them only for protocol agilex");
    OdriveOptions options;
    options.track_width_m = robot.track_width_m;
    options.wheel_diameter_m = connection.wheel_diameter_m;
    options.left_node = static_cast<std::uint32_t>(connection.left_node);
    options.right_node = static_cast<std::uint32_t>(connection.right_node);
    options.right_is_mirrored = connection.right_is_mirrored;
    options.max_plausible_wheel_mps = max_plausible_wheel_mps;
    protocol = make_odrive_protocol(options);
  }
  (void)ignored_bits(robot.base, *protocol);
  return protocol;
}

BaseDriverOptions base_driver_options(const Robot& robot) {
  BaseDriverOptions options;
  options.max_forward_mps = robot.max_forward_mps;
  options.max_turn_radps = robot.max_turn_radps;
  options.max_wheel_mps = robot.max_wheel_mps;
  options.track_width_m = robot.track_width_m;
  return options;
}

BaseDriverOptions base_driver_options(const Robot& robot, const BaseProtocol& protocol) {
  BaseDriverOptions options = base_driver_options(robot);
  options.ignored_fault_bits = ignored_bits(robot.base, protocol);
  return options;
}

}  // namespace lodestar

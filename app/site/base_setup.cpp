#include "app/site/base_setup.hpp"

#include "maps/input_error.hpp"

namespace lodestar {

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
  if (connection.protocol == "agilex") {
    const BaseModel model = connection.model == "hunter"  ? BaseModel::hunter
                            : connection.model == "scout" ? BaseModel::scout
                                                          : BaseModel::tracer;
    return make_agilex_protocol(model, max_plausible_wheel_mps);
  }
  OdriveOptions options;
  options.track_width_m = robot.track_width_m;
  options.wheel_diameter_m = connection.wheel_diameter_m;
  options.left_node = static_cast<std::uint32_t>(connection.left_node);
  options.right_node = static_cast<std::uint32_t>(connection.right_node);
  options.right_is_mirrored = connection.right_is_mirrored;
  options.max_plausible_wheel_mps = max_plausible_wheel_mps;
  return make_odrive_protocol(options);
}

}  // namespace lodestar

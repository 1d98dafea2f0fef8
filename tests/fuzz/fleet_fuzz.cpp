#include <string>

#include "app/fleet/message_reader.hpp"
#include "app/fleet/message_writer.hpp"
#include "app/fleet/order_book.hpp"

// Whatever a master sends is read or refused, an order book takes it, and what it then says is JSON.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lodestar;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  OrderBook book({.map = "lab",
                  .positions = {},
                  .node_actions = {"wait"},
                  .instant_actions = {"initPosition", "stateRequest", "factsheetRequest"}});
  for (const FleetMessage& message : {read_order(text), read_instant_actions(text)}) {
    Pose2 map_from_base;
    const auto* order = std::get_if<FleetOrder>(&message);
    if (order != nullptr && order->nodes.front().at)
      map_from_base.position_m = order->nodes.front().at->position_m;
    book.take(message, map_from_base);
    (void)book.start_actions();
    const auto targets = book.targets();
    if (!targets.empty()) book.reached(targets.back().sequence);
  }
  FleetReport report{.order_id = book.order_id(),
                     .last_node_id = book.last_node_id(),
                     .nodes = book.nodes(),
                     .edges = book.edges(),
                     .actions = book.actions(),
                     .errors = book.errors(),
                     .map_from_base = {},
                     .map = "lab",
                     .battery_v = {}};
  for (const VdaVersion version : {VdaVersion::v2_0_0, VdaVersion::v2_1_0})
    if (!nlohmann::json::accept(state_text({.version = version}, report))) __builtin_trap();
  return 0;
}

#include <fmt/format.h>

#include "app/console/live_json.hpp"
#include "app/console/live_view.hpp"
#include "app/site/arguments.hpp"
#include "maps/input_error.hpp"

// The orders of the page's clients to the robot.
namespace lodestar {

using nlohmann::json;

std::string in_words(int client, const std::string& name) {
  return name.empty() ? fmt::format("client {}", client) : fmt::format("client {} ({})", client, name);
}

std::optional<std::string> LiveView::give_order(const Client& client, const std::string& type,
                                                const json& message) {
  Order order{.by = in_words(client.number, client.name), .what = PauseOrder{}};
  if (type == "hold") return std::nullopt;
  if (type == "go") {
    order.what = go_order(message);
  } else if (type == "charge") {
    if (!site_.charging) return "found no charging in site.yaml: the robot has no dock";
    order.what = ChargeOrder{};
  } else if (type == "resume") {
    order.what = ResumeOrder{};
  } else if (type == "clear_fault") {
    order.what = ClearFaultOrder{};
  } else if (type == "place") {
    order.what = PlaceOrder{pose_from_json(message.at("pose"))};
  } else if (type == "steer") {
    order.what = SteerOrder{velocity_from_json(message)};
  } else if (type != "pause") {
    return "found an unknown message type";
  }
  if (link_->give(std::move(order))) return std::nullopt;
  return "too many orders are still waiting for the robot";
}

LiveView::Wish LiveView::wish_from(const json& message) {
  return {.goals = goals_from_json(message.at("goals")), .along_routes = message.value("routes", false)};
}

/// Throws InputError for a mission that nobody has saved.
LiveView::Wish LiveView::order_from(const json& message) const {
  if (!message.contains("mission")) return wish_from(message);
  return {.goals = goals_in({}, message.at("mission").get<std::string>(), places_),
          .along_routes = message.value("routes", false)};
}

/// Throws InputError where no edges lead there.
GoOrder LiveView::go_order(const json& message) const {
  const Wish wish = order_from(message);
  const bool is_more = message.value("more", false);
  if (!wish.along_routes) return {.goals = wish.goals, .is_more = is_more};
  if (!estimate_) throw InputError("the robot does not know where it is");
  const Vec2 from_m = is_more ? last_goal_m_.value_or(estimate_->map_from_base.position_m)
                              : estimate_->map_from_base.position_m;
  return {.goals = routes_.over_edges(from_m, wish.goals), .is_more = is_more};
}

}  // namespace lodestar

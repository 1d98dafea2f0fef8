#include "app/site/route_graph.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <queue>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

/// A goal so near to a point of the graph is there; the robot so near need not drive there first.
constexpr double same_m = 0.05;

}  // namespace

RouteGraph::RouteGraph(const Places& places, double max_mps) {
  for (const Place& place : places.places)
    points_.push_back({.name = place.name, .position_m = place.position_m, .ways = {}});
  for (const RouteNode& node : places.nodes)
    points_.push_back({.name = node.name, .position_m = node.position_m, .ways = {}});
  const auto index_of = [&](const std::string& name) {
    return static_cast<std::size_t>(std::ranges::find(points_, name, &Point::name) - points_.begin());
  };
  for (const RouteEdge& edge : places.edges) {
    const std::size_t from = index_of(edge.from);
    const std::size_t to = index_of(edge.to);
    const double length_m = (points_[to].position_m - points_[from].position_m).norm();
    const double time_s = length_m / std::min(edge.max_mps.value_or(max_mps), max_mps);
    points_[from].ways.push_back({to, edge.max_mps, time_s});
    if (!edge.one_way) points_[to].ways.push_back({from, edge.max_mps, time_s});
    points_[from].is_on_edge = points_[to].is_on_edge = true;
  }
}

std::optional<std::size_t> RouteGraph::nearest(const Vec2& position_m) const {
  std::optional<std::size_t> nearest;
  const auto distance_m = [&](std::size_t i) { return (points_[i].position_m - position_m).norm(); };
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (points_[i].is_on_edge && (!nearest || distance_m(i) < distance_m(*nearest))) nearest = i;
  return nearest;
}

/// Dijkstra's search; of equal times the point that was named first.
std::vector<std::optional<RouteGraph::Reached>> RouteGraph::reached_from(std::size_t start) const {
  using Candidate = std::pair<double, std::size_t>;
  std::vector<std::optional<Reached>> reached(points_.size());
  std::vector<bool> is_final(points_.size(), false);
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> open;
  reached[start] = Reached{};
  open.emplace(0.0, start);
  while (!open.empty()) {
    const auto [time_s, here] = open.top();
    open.pop();
    if (is_final[here]) continue;
    is_final[here] = true;
    for (const Way& way : points_[here].ways) {
      const double then_s = time_s + way.time_s;
      if (reached[way.to] && reached[way.to]->time_s <= then_s) continue;
      reached[way.to] = Reached{.time_s = then_s, .before = here, .max_mps = way.max_mps};
      open.emplace(then_s, way.to);
    }
  }
  return reached;
}

std::optional<std::vector<Goal>> RouteGraph::over_edges(const Vec2& from_m, const Goal& to) const {
  const std::optional<std::size_t> start = nearest(from_m);
  const std::optional<std::size_t> end = nearest(to.position_m);
  if (!start || !end) return std::nullopt;
  const std::vector<std::optional<Reached>> reached = reached_from(*start);
  if (!reached[*end]) return std::nullopt;
  std::vector<Goal> goals;
  std::optional<std::size_t> at = end;
  for (; reached[*at]->before; at = reached[*at]->before)
    goals.push_back({.position_m = points_[*at].position_m,
                     .passes = true,
                     .max_mps = reached[*at]->max_mps,
                     .on_line = true});
  if ((points_[*start].position_m - from_m).norm() > same_m)
    goals.push_back({.position_m = points_[*start].position_m, .passes = true});
  std::ranges::reverse(goals);
  const bool ends_there = !goals.empty() && (points_[*end].position_m - to.position_m).norm() <= same_m;
  if (!ends_there) goals.push_back(to);
  goals.back().position_m = to.position_m;
  goals.back().heading_rad = to.heading_rad;
  goals.back().passes = to.passes;
  goals.back().wait = to.wait;
  goals.back().action = to.action;
  return goals;
}

std::vector<Goal> RouteGraph::over_edges(const Vec2& from_m, const std::vector<Goal>& goals) const {
  std::vector<Goal> all;
  Vec2 here_m = from_m;
  for (const Goal& goal : goals) {
    const std::optional<std::vector<Goal>> way = over_edges(here_m, goal);
    if (!way)
      throw InputError(
          fmt::format("--routes: found no way along the edges of places.yaml from {:.2f},{:.2f} "
                      "to {:.2f},{:.2f}",
                      here_m.x(), here_m.y(), goal.position_m.x(), goal.position_m.y()));
    all.insert(all.end(), way->begin(), way->end());
    here_m = goal.position_m;
  }
  return all;
}

bool RouteGraph::has_edge(const std::string& name) const {
  const auto point = std::ranges::find(points_, name, &Point::name);
  return point != points_.end() && point->is_on_edge;
}

std::vector<std::string> RouteGraph::unreachable_from(const std::string& place) const {
  const auto start = std::ranges::find(points_, place, &Point::name);
  if (!has_edge(place)) return {};
  const auto reached = reached_from(static_cast<std::size_t>(start - points_.begin()));
  std::vector<std::string> names;
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (points_[i].is_on_edge && !reached[i]) names.push_back(points_[i].name);
  return names;
}

}  // namespace lodestar

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/site/goal.hpp"
#include "maps/places.hpp"

namespace lodestar {

/// The places, nodes and edges of a site as a directed graph, over which goals are reached.
class RouteGraph {
 public:
  /// `max_mps` is the robot's own limit, along edges that have none.
  RouteGraph(const Places& places, double max_mps);

  /// The goals that lead from here to a goal along edges, in the least time at the edges' speeds: freely to
  /// the point of the graph that is nearest by air, along the edges in straight lines to the point nearest to
  /// the goal, and freely from there. A goal at a point of the graph is that point. Nothing where no edges
  /// lead there, or without a graph.
  [[nodiscard]] std::optional<std::vector<Goal>> over_edges(const Vec2& from_m, const Goal& to) const;

  /// The same for goals in turn. Throws InputError naming the goal to which no edges lead.
  [[nodiscard]] std::vector<Goal> over_edges(const Vec2& from_m, const std::vector<Goal>& goals) const;

  /// Whether an edge begins or ends at the point of this name.
  [[nodiscard]] bool has_edge(const std::string& name) const;

  /// Names of the points on edges to which no edges lead from the one named.
  [[nodiscard]] std::vector<std::string> unreachable_from(const std::string& place) const;

 private:
  struct Way {
    std::size_t to = 0;
    std::optional<double> max_mps;
    double time_s = 0.0;
  };
  struct Point {
    std::string name;
    Vec2 position_m;
    std::vector<Way> ways;
    bool is_on_edge = false;
  };
  /// How a point is reached from the beginning of a search.
  struct Reached {
    double time_s = 0.0;
    std::optional<std::size_t> before;  ///< nothing at the beginning
    std::optional<double> max_mps;      ///< from there
  };

  [[nodiscard]] std::optional<std::size_t> nearest(const Vec2& position_m) const;
  [[nodiscard]] std::vector<std::optional<Reached>> reached_from(std::size_t start) const;

  std::vector<Point> points_;
};

}  // namespace lodestar

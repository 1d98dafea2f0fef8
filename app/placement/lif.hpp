#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "maps/places.hpp"

// The Layout Interchange Format of the VDMA, version 1.0.0 (March 2024): the route graph as fleet managers
// read and write it. A node where a station is worked at is a place, under its node's ID; all others are
// nodes. Zones and missions are not in the format.
namespace lodestar {

/// What the format needs besides the graph.
struct LifHeader {
  std::string project;
  std::string vehicle_type;
  std::string exported_at;  ///< ISO 8601, UTC
};

/// One layout with all places, nodes and edges; an edge that may be driven both ways is two.
nlohmann::ordered_json lif_of(const Places& places, const LifHeader& header);

/// Which part of a file to read; empty: the only layout, the first vehicle type of each node and edge.
struct LifChoice {
  std::string layout;
  std::string vehicle_type;
};

struct ImportedLif {
  Places places;  ///< places, nodes and edges only
  /// What was left out or simplified: curves, edges to other layouts, ways of other vehicle types.
  std::vector<std::string> warnings;
};

/// Throws InputError for a file that is no LIF, and for what places.yaml cannot hold.
ImportedLif read_lif(const std::string& text, const std::filesystem::path& file,
                     const LifChoice& choice = {});

}  // namespace lodestar

#pragma once

#include "app/navigation/seen_surroundings.hpp"
#include "app/viewers/foxglove_messages.hpp"

// What the scanner sees, by Foxglove's schemas, in the frame of the base.
namespace lodestar {

/// Where the beams of the newest scan ended. The field `presence` tells what is known of each point: 0 on the
/// map, 1 stands, 2 a person (or anything else that moves), 3 someone may be hidden there.
MessageJson scan_message(Stamp stamp, const SeenSurroundings& seen);

/// The obstacle memory as far as the map lacks it: a grid along the axes of the odometry frame, 0 free or not
/// seen, 50 moving, 100 standing.
MessageJson memory_message(Stamp stamp, const SeenSurroundings& seen);

}  // namespace lodestar

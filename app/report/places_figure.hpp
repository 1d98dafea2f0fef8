#pragma once

#include "app/report/canvas.hpp"
#include "maps/places.hpp"

namespace lodestar {

/// Keep-outs hatched and outlined, speed zones outlined with their speed, edges with an arrow where they are
/// one-way, places with their names.
void draw_places(Canvas& canvas, const Places& places);

}  // namespace lodestar

#pragma once

namespace lodestar {

/// One, two or five times a power of ten, so that about `count` ticks fit on an axis.
double tick_spacing(double extent, double count);

}  // namespace lodestar

#pragma once

#include "app/bench/evidence.hpp"

namespace lodestar {

/// All that `bench all` runs, in the order of the page.
std::vector<EvidencePart> evidence_parts();

}  // namespace lodestar

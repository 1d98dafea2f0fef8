#pragma once

#include "app/bench/evidence.hpp"

namespace lodestar {

/// One self-contained page: machine and build, how many promises stand how, then each command with its
/// figures, its peers, and what may be concluded.
std::string evidence_html(const Evidence& evidence);

/// The counts and the rows that are not kept, for a terminal.
std::string evidence_text(const Evidence& evidence);

}  // namespace lodestar

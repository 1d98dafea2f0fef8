#pragma once

#include "app/campaign/campaign.hpp"

namespace lodestar {

/// Counts, and for each kind of fault how its missions ended and how soon it was noticed.
nlohmann::ordered_json campaign_json(const std::vector<MissionOutcome>& outcomes);

/// The same as a self-contained page, with the command that repeats each failure.
std::string campaign_html(const std::vector<MissionOutcome>& outcomes);

/// The command that runs one mission again and leaves its run folder.
std::string repeat_command(const MissionOutcome& outcome);

}  // namespace lodestar

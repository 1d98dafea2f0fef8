#pragma once

#include <optional>
#include <string>

#include "app/report/run_record.hpp"
#include "app/site/site.hpp"

namespace lodestar {

/// Why nothing on board could have kept the robot off the obstacle that it touched first, in words (the list
/// of docs/safety.md, "What is not guaranteed"). Nothing where something could, and where it touched none.
/// Judged by the true poses, and by what an ideal camera would have seen from there.
std::optional<std::string> excuse_for_contact(const RunRecord& record, const Site& site);

}  // namespace lodestar

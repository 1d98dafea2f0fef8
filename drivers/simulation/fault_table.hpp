#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "drivers/simulation/fault.hpp"

namespace lodestar {

/// One parameter of a fault in a file: its key with the unit, its limits, and the member that it sets.
struct FaultParameter {
  std::string_view key;
  double low = 0.0;
  double high = 0.0;
  double Fault::* value = nullptr;
  double unit_factor = 1.0;  ///< conversion factor to the member's unit
};

struct FaultRow {
  FaultKind kind = FaultKind::markers_occluded;
  std::string_view name;
  std::span<const FaultParameter> parameters;
  bool concerns_a_marker = false;
  bool is_instantaneous = false;  ///< has no duration
  bool concerns_scanner = false;
};

/// One row per kind, in the order of the enumeration.
std::span<const FaultRow> fault_table();

}  // namespace lodestar

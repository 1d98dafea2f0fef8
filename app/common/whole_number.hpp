#pragma once

#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "maps/input_error.hpp"

namespace lodestar {

/// A JSON value from outside, as a whole number in 0..`most`. Throws InputError for anything else: get<int>()
/// would make one of true and of 1.5, wrap what does not fit, and has no defined result for 1e20.
inline std::uint32_t whole_number(const nlohmann::json& value, std::uint32_t most) {
  const double number = value.is_number() ? value.get<double>() : -1.0;
  if (!(number >= 0.0 && number <= most) || number != std::floor(number)) {
    throw InputError(
        fmt::format("found '{}', wanted a whole number in 0..{}", value.dump().substr(0, 60), most));
  }
  return static_cast<std::uint32_t>(number);
}

}  // namespace lodestar

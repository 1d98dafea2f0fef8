#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "app/site/site.hpp"

namespace lodestar {

/// A zone or an edge with a speed that its robot cannot drive at.
struct TooSlow {
  std::string list;       ///< its key in places.yaml
  std::size_t index = 0;  ///< in the list
  std::string found;      ///< in words
  std::string wanted;
};

/// The first of them: the motors cannot drive slower than their dead band, so nobody would obey it.
std::optional<TooSlow> first_too_slow(const Places& places, const Robot& robot);

}  // namespace lodestar

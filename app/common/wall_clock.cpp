#include "app/common/wall_clock.hpp"

#include <fmt/chrono.h>

namespace lodestar {

std::string utc_text(std::chrono::system_clock::time_point time) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", std::chrono::floor<std::chrono::seconds>(time));
}

}  // namespace lodestar

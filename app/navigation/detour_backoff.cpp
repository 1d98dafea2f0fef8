#include "app/navigation/detour_backoff.hpp"

#include <algorithm>

namespace lodestar {

void DetourBackoff::changed(Stamp now, const Vec2& robot_m) {
  const bool has_come_on = !from_m_ || (robot_m - *from_m_).norm() > options_.comes_on_m;
  wait_ = has_come_on ? options_.least : std::min(2 * wait_, options_.most);
  if (has_come_on) from_m_ = robot_m;
  last_ = now;
}

}  // namespace lodestar

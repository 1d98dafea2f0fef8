#include "app/image_watch.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace lodestar {
namespace {

constexpr int missed_frames = 3;
constexpr Duration least_patience = std::chrono::milliseconds(100);  ///< frames may come in pairs
constexpr Duration first_patience = std::chrono::seconds(2);         ///< until the first one

}  // namespace

Duration ImageWatch::patience() const {
  return period_ ? std::max(missed_frames * *period_, least_patience) : first_patience;
}

std::optional<std::string> ImageWatch::see(Stamp now, std::size_t frames) {
  if (!last_) last_ = now;
  const Duration since = now - *last_;
  if (frames > 0) {
    const Duration period = since / static_cast<Duration::rep>(frames);
    // A gap is no period.
    if (!is_silent_ && since > Duration::zero())
      period_ = period_ ? *period_ + (period - *period_) / 8 : period;
    last_ = now;
    if (!std::exchange(is_silent_, false)) return std::nullopt;
    return "camera: images come again";
  }
  if (is_silent_ || since <= patience()) return std::nullopt;
  is_silent_ = true;
  return fmt::format("camera: no image for {:.1f} s; is it plugged in?", seconds(since));
}

}  // namespace lodestar

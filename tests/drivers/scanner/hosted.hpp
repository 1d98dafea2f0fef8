#pragma once

#include <atomic>
#include <cmath>
#include <thread>

#include "drivers/scanner/hosted_scanner.hpp"

namespace lodestar {

/// A room that looks different in each direction, so that a turned or mirrored scan is found.
inline std::optional<double> uneven_room_m(double angle_rad) {
  return 2.0 + 0.3 * std::sin(angle_rad) + 0.2 * std::cos(2.0 * angle_rad + 0.5);
}

/// A stand-in that serves in a thread of its own.
class Hosted {
 public:
  Hosted(std::unique_ptr<ScannerStandIn> stand_in, std::unique_ptr<ServedLink> link,
         RangeOfAngle range_m = uneven_room_m)
      : scanner_(std::move(stand_in), std::move(link), std::move(range_m)),
        thread_([this] { host(scanner_, [this] { return stops_.load(); }); }) {}
  ~Hosted() {
    stops_ = true;
    thread_.join();
  }

 private:
  HostedScanner scanner_;
  std::atomic<bool> stops_ = false;
  std::thread thread_;
};

}  // namespace lodestar

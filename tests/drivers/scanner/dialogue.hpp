#pragma once

#include <gtest/gtest.h>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "drivers/scanner/hosted_scanner.hpp"
#include "drivers/scanner/ld19_protocol.hpp"
#include "drivers/scanner/ld19_stand_in.hpp"
#include "drivers/scanner/nanoscan_protocol.hpp"
#include "drivers/scanner/nanoscan_stand_in.hpp"
#include "drivers/scanner/rplidar_protocol.hpp"
#include "drivers/scanner/rplidar_stand_in.hpp"
#include "drivers/scanner/scip_protocol.hpp"
#include "drivers/scanner/scip_stand_in.hpp"
#include "maps/random.hpp"

namespace lodestar {

enum class Kind { ld19, rplidar_standard, rplidar_express, rplidar_dense, rplidar_hq, scip, nanoscan };

inline const char* name_of(Kind kind) {
  constexpr const char* names[] = {
      "ld19", "rplidar_standard", "rplidar_express", "rplidar_dense", "rplidar_hq", "scip", "nanoscan"};
  return names[static_cast<std::size_t>(kind)];
}
inline void PrintTo(Kind kind, std::ostream* out) {
  *out << name_of(kind);
}

inline const auto all_kinds =
    testing::Values(Kind::ld19, Kind::rplidar_standard, Kind::rplidar_express, Kind::rplidar_dense,
                    Kind::rplidar_hq, Kind::scip, Kind::nanoscan);

/// Not in datagrams, which are never cut.
inline const auto stream_kinds = testing::Values(Kind::ld19, Kind::rplidar_standard, Kind::rplidar_express,
                                                 Kind::rplidar_dense, Kind::rplidar_hq, Kind::scip);
/// With a checksum of their own.
inline const auto checked_kinds =
    testing::Values(Kind::ld19, Kind::rplidar_express, Kind::rplidar_dense, Kind::rplidar_hq, Kind::scip);

inline double unit_of(Kind kind) {
  return kind == Kind::rplidar_standard || kind == Kind::rplidar_hq ? 0.00025 : 0.001;
}
/// Whether the protocol tells free space from a lost reading.
inline bool tells_nothing(Kind kind) {
  return kind == Kind::scip || kind == Kind::nanoscan;
}

/// A protocol and a stand-in that talk to each other on the test's clock.
struct Dialogue {
  explicit Dialogue(Kind chosen) : kind(chosen) {
    switch (kind) {
      case Kind::ld19:
        protocol = std::make_unique<Ld19Protocol>();
        stand_in = std::make_unique<Ld19StandIn>();
        break;
      case Kind::scip:
        protocol = std::make_unique<ScipProtocol>();
        stand_in = std::make_unique<ScipStandIn>();
        break;
      case Kind::nanoscan:
        protocol = std::make_unique<NanoscanProtocol>();
        stand_in = std::make_unique<NanoscanStandIn>();
        break;
      default:
        protocol = std::make_unique<RplidarProtocol>();
        stand_in = std::make_unique<RplidarStandIn>(
            static_cast<std::uint16_t>(static_cast<int>(kind) - static_cast<int>(Kind::rplidar_standard)));
    }
    protocol->connect(now);
    for (int i = 0; i < 40; ++i) exchange();
  }

  void exchange() {
    protocol->take(stand_in->answer(protocol->step(now), now), now);
    now += std::chrono::milliseconds(10);
  }

  /// A turn of random echoes that begins now; the clock moves to its end.
  Scan turn(Random& random) {
    const BeamPattern pattern = stand_in->pattern();
    Scan scan = measured_turn(pattern, now, [&](double) { return random.uniform(0.5, 11.9); });
    for (Beam& beam : scan.beams) {
      const std::uint64_t draw = random.below(20);
      if (draw < 3) beam.echo = draw == 0 ? Echo::nothing : draw == 1 ? Echo::too_near : Echo::invalid;
      beam.intensity = static_cast<float>(random.uniform());
    }
    now += pattern.turn;
    return scan;
  }

  std::vector<Scan> all_scans() {
    std::vector<Scan> scans;
    while (std::optional<Scan> scan = protocol->next()) scans.push_back(std::move(*scan));
    return scans;
  }

  Kind kind;
  Stamp now{std::chrono::seconds(100)};
  std::unique_ptr<ScannerProtocol> protocol;
  std::unique_ptr<ScannerStandIn> stand_in;
};

/// What a reader can know of a beam.
inline Echo readable(Kind kind, Echo echo) {
  return echo == Echo::nothing && !tells_nothing(kind) ? Echo::invalid : echo;
}

}  // namespace lodestar

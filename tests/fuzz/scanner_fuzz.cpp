#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "drivers/scanner/ld19_protocol.hpp"
#include "drivers/scanner/ld19_stand_in.hpp"
#include "drivers/scanner/nanoscan_protocol.hpp"
#include "drivers/scanner/nanoscan_stand_in.hpp"
#include "drivers/scanner/rplidar_protocol.hpp"
#include "drivers/scanner/rplidar_stand_in.hpp"
#include "drivers/scanner/scip_protocol.hpp"
#include "drivers/scanner/scip_stand_in.hpp"

namespace lodestar {
namespace {

void check(const Scan& scan, Stamp now) {
  if (scan.beams.size() > TurnAssembler::most_beams) __builtin_trap();
  for (const Beam& beam : scan.beams) {
    if (!(std::abs(beam.angle_rad) <= std::numbers::pi + 1e-9) || beam.stamp > now) __builtin_trap();
    const bool is_measurable = beam.range_m >= scan.min_range_m && beam.range_m <= scan.max_range_m;
    if (beam.echo == Echo::hit && !is_measurable) __builtin_trap();
  }
}

/// Talks first, where the first byte says so, so that the bytes meet a stream that runs.
void feed(ScannerProtocol& protocol, ScannerStandIn& stand_in, bool talks, ByteView bytes) {
  Stamp now{std::chrono::seconds(10)};
  protocol.connect(now);
  for (int i = 0; talks && i < 40; ++i) {
    protocol.take(stand_in.answer(protocol.step(now), now), now);
    now += std::chrono::milliseconds(10);
  }
  // In pieces as if read at a line, and once more, so that what begins in the bytes may end.
  for (int round = 0; round < 2; ++round) {
    for (std::size_t at = 0; at < bytes.size();) {
      const std::size_t part = std::min<std::size_t>(1 + bytes[at], bytes.size() - at);
      protocol.take(bytes.subspan(at, part), now);
      stand_in.answer(protocol.step(now), now);
      at += part;
      now += std::chrono::milliseconds(1);
    }
  }
  protocol.take(bytes, now);  // as one datagram
  while (const std::optional<Scan> scan = protocol.next()) check(*scan, now);
  stand_in.answer(bytes, now);  // as the words of a client
  if (protocol.description().empty()) __builtin_trap();
}

}  // namespace
}  // namespace lodestar

// Any bytes from any scanner, or any client of a stand-in: nothing breaks, and what is read is possible.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lodestar;
  if (size == 0) return 0;
  const ByteView bytes = ByteView(data, size).subspan(1);
  const bool talks = (data[0] & 8U) != 0;
  switch (data[0] % 8) {
    case 0: {
      Ld19Protocol protocol;
      Ld19StandIn stand_in;
      feed(protocol, stand_in, talks, bytes);
      break;
    }
    case 1: {
      ScipProtocol protocol;
      ScipStandIn stand_in;
      feed(protocol, stand_in, talks, bytes);
      break;
    }
    case 2: {
      NanoscanProtocol protocol;
      NanoscanStandIn stand_in;
      feed(protocol, stand_in, talks, bytes);
      break;
    }
    default: {
      RplidarProtocol protocol;
      RplidarStandIn stand_in(static_cast<std::uint16_t>(data[0] % 8 - 3));
      feed(protocol, stand_in, talks, bytes);
    }
  }
  return 0;
}

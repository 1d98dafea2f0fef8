#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "drivers/scanner/bytes.hpp"
#include "maps/scan.hpp"

namespace lodestar {

/// What became of a device's bytes, since the beginning.
struct ProtocolCounts {
  std::uint64_t frames = 0;           ///< understood
  std::uint64_t checksum_errors = 0;  ///< frames refused for their checksum or for impossible content
  std::uint64_t skipped_bytes = 0;    ///< that belonged to no frame
};

/// The language of a scanner: bytes in, scans out. It knows no device and no clock. Any bytes at all leave it
/// in a state from which it understands the next whole frame; a scan of which frames were lost lacks their
/// beams.
class ScannerProtocol {
 public:
  ScannerProtocol() = default;
  ScannerProtocol(const ScannerProtocol&) = delete;
  ScannerProtocol& operator=(const ScannerProtocol&) = delete;
  virtual ~ScannerProtocol() = default;

  /// The device was just connected: all that is known of it is forgotten.
  virtual void connect(Stamp now) = 0;
  /// What is to be sent to the device now, most often nothing: questions, and the order to scan.
  virtual Bytes step(Stamp /*now*/) { return {}; }
  /// What makes it stop scanning.
  [[nodiscard]] virtual Bytes farewell() const { return {}; }

  /// Bytes that arrived at this time. Of a datagram protocol, one whole datagram.
  virtual void take(ByteView bytes, Stamp arrival) = 0;
  /// The oldest complete scan not yet taken.
  virtual std::optional<Scan> next() = 0;

  /// What the device says of itself, in words.
  [[nodiscard]] virtual std::string description() const = 0;
  [[nodiscard]] virtual ProtocolCounts counts() const = 0;
};

}  // namespace lodestar

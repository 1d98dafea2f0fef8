#pragma once

#include <string>

#include "drivers/scanner/bytes.hpp"
#include "drivers/system/file_descriptor.hpp"

namespace lodestar {

/// A connection to a device: a serial line, a TCP connection or a UDP socket. Nothing here blocks.
class ByteLink {
 public:
  explicit ByteLink(FileDescriptor descriptor) : descriptor_(std::move(descriptor)), buffer_(1U << 16U) {}

  /// What has arrived, or one datagram; empty when there is nothing. Valid until the next call.
  ByteView receive();
  /// What the device does not take now is kept for the next call, up to 4 kB.
  void send(ByteView bytes);
  /// Unplugged, or closed by the other end.
  [[nodiscard]] bool is_lost() const { return lost_; }

 private:
  FileDescriptor descriptor_;
  Bytes buffer_;
  Bytes unsent_;
  bool lost_ = false;
};

/// They throw InputError with what was found and wanted.
/// Opens a serial line, raw, at any speed that it supports. RPLIDAR A1's motor turns while DTR is off.
ByteLink open_serial(const std::string& device, unsigned baud, bool dtr_is_on = true);
/// Waits for at most two seconds.
ByteLink open_tcp(const std::string& host, unsigned port);
/// Receives what is sent to this port of any of the computer's addresses.
ByteLink open_udp(unsigned port);

}  // namespace lodestar

#pragma once

#include <filesystem>
#include <memory>

#include "drivers/scanner/bytes.hpp"

namespace lodestar {

/// The device's end of a connection, for clients that come and go. Nothing here blocks: what a client does
/// not read in time is lost, whole packets at a time.
class ServedLink {
 public:
  ServedLink() = default;
  ServedLink(const ServedLink&) = delete;
  ServedLink& operator=(const ServedLink&) = delete;
  virtual ~ServedLink() = default;

  /// What the client sent; empty when nothing.
  virtual Bytes receive() = 0;
  virtual void send(ByteView packet) = 0;
  /// True once after each change of the client.
  virtual bool client_changed() = 0;
};

/// A pseudo terminal, under this name (a symbolic link, which replaces an old one).
std::unique_ptr<ServedLink> serve_pty(const std::filesystem::path& link);
/// One TCP client at a time; the newest takes the place of the one before.
std::unique_ptr<ServedLink> serve_tcp(const std::string& host, unsigned port);
/// Datagrams to this address.
std::unique_ptr<ServedLink> serve_udp(const std::string& host, unsigned port);

}  // namespace lodestar

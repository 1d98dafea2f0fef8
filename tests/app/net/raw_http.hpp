#pragma once

#include <chrono>
#include <string>

namespace lodestar {

/// The response to some bytes, and whether the server closed the connection.
struct RawAnswer {
  std::string bytes;
  bool ended_by_server = false;
};

/// Sends raw bytes over loopback and receives until the server closes or nothing arrives for this time.
RawAnswer exchange(unsigned short port, const std::string& bytes, std::chrono::seconds patience);

/// A socket connected over loopback, to be closed by the caller.
int connected(unsigned short port, std::chrono::seconds patience);

}  // namespace lodestar

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/simulation/scoring.hpp"
#include "drivers/system/file_descriptor.hpp"

// Sends the robot's true pose from the simulated world in one process to the simulated camera in another.
// Only drivers/ may use it. The socket is abstract (it has no file): it is found by the name of the CAN
// interface, within the same network namespace.
namespace lodestar {

class TruthServer {
 public:
  /// Throws InputError when this interface already has a simulated world.
  explicit TruthServer(const std::string& interface);

  /// Sends to all listeners; a slow listener misses poses.
  void tell(const TruePose& pose);

 private:
  FileDescriptor listening_;
  std::vector<FileDescriptor> listeners_;
};

class TruthListener {
 public:
  explicit TruthListener(std::string interface) : interface_(std::move(interface)) {}

  /// The oldest pose not yet polled; empty when there is none or no world (which is then looked for again
  /// from time to time).
  std::optional<TruePose> poll();

 private:
  void connect();

  std::string interface_;
  FileDescriptor socket_;
  std::optional<Stamp> tried_;
};

}  // namespace lodestar

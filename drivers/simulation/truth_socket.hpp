#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/simulation/scoring.hpp"
#include "drivers/system/file_descriptor.hpp"

// How the simulated world in one process tells the simulated camera in another where the robot truly is. Only
// drivers/ may listen. The socket has no file: it is found by the name of the CAN interface, within the same
// network namespace as that.
namespace lodestar {

class TruthServer {
 public:
  /// Throws InputError when another world is already simulated on this interface.
  explicit TruthServer(const std::string& interface);

  /// To all who listen; one that does not keep up misses poses.
  void tell(const TruePose& pose);

 private:
  FileDescriptor listening_;
  std::vector<FileDescriptor> listeners_;
};

class TruthListener {
 public:
  explicit TruthListener(std::string interface) : interface_(std::move(interface)) {}

  /// The next pose, oldest first; nothing when there is none, or no world (then it is looked for again now
  /// and then).
  std::optional<TruePose> poll();

 private:
  void connect();

  std::string interface_;
  FileDescriptor socket_;
  std::optional<Stamp> tried_;
};

}  // namespace lodestar

#pragma once

#include <deque>
#include <string>
#include <vector>

#include "drivers/can/can_bus.hpp"
#include "drivers/system/file_descriptor.hpp"

struct can_frame;

namespace lodestar {

struct SocketCanOptions {
  std::vector<std::uint32_t>
      identifiers;  ///< to hear, and those to be sent (else none is confirmed); all when empty
  bool takes_remote_requests = false;                      ///< as frames without data; else they are left out
  Duration check_period = std::chrono::milliseconds(200);  ///< of the interface: there, up, still the same?
  Duration stalled_after = std::chrono::milliseconds(100);  ///< without the confirmation of a frame
  int stalled_after_refusals = 3;                           ///< in a row
  /// A bus-off is not believed any more when frames still arrive so long after it was told.
  Duration disbelieve_bus_off_after = std::chrono::seconds(5);
  Duration forget_after =
      std::chrono::seconds(1);  ///< a frame never confirmed no longer holds its successors up
};

/// A CAN interface of Linux. Frames are stamped by the kernel on reception, on the monotonic clock. Of each
/// identifier at most one frame waits to be sent: a newer command must not queue up behind an older one. The
/// interface may be switched off, vanish and come back; it is found again by its name.
class SocketCanBus final : public CanBus {
 public:
  /// Throws InputError for a name that cannot be one, and when this kernel has no CAN. An interface that is
  /// not there yet is waited for.
  explicit SocketCanBus(std::string interface, const SocketCanOptions& options = {});

  bool send(const CanFrame& frame) override;
  std::optional<StampedCanFrame> poll() override;
  [[nodiscard]] BusHealth health() const override;

  /// To wait on with poll(2).
  [[nodiscard]] int descriptor() const { return socket_.get(); }

 private:
  struct Waiting {
    std::uint32_t id = 0;
    Stamp sent;
  };

  void check_interface();
  void read_all();
  void bind_to(unsigned index);
  void take_in_failure(int error);
  void take_in_error_frame(const can_frame& frame);
  void confirm(std::uint32_t id);
  void recover_from_bus_off();
  void refuse();

  std::string interface_;
  SocketCanOptions options_;
  FileDescriptor socket_;
  unsigned bound_index_ = 0;
  BusState state_ = BusState::missing;
  BusCounts counts_;
  std::optional<Stamp> checked_;
  Stamp newest_;                         ///< of the frames received
  std::deque<StampedCanFrame> arrived_;  ///< not yet polled
  std::optional<Stamp> disturbed_;       ///< last word of the controller about being passive or off
  int refused_in_a_row_ = 0;
  Stamp refused_;                ///< the newest of them
  std::deque<Waiting> waiting_;  ///< handed over, not yet confirmed
  bool waits_long_ = false;      ///< for the oldest of them, when all that had arrived was read
};

}  // namespace lodestar

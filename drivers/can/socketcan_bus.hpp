#pragma once

#include <deque>
#include <string>
#include <vector>

#include "drivers/can/can_bus.hpp"
#include "drivers/system/file_descriptor.hpp"

struct can_frame;

namespace lodestar {

struct SocketCanOptions {
  /// Receive filter; must include the identifiers that are sent, or their frames are never confirmed. Empty:
  /// all identifiers.
  std::vector<std::uint32_t> identifiers;
  bool takes_remote_requests = false;  ///< received as frames without data; otherwise ignored
  /// How often to check that the interface exists, is up, and is still the same one.
  Duration check_period = std::chrono::milliseconds(200);
  Duration stalled_after = std::chrono::milliseconds(100);  ///< time without the confirmation of a frame
  int stalled_after_refusals = 3;                           ///< consecutive frames refused by the kernel
  /// A reported bus-off is dropped when frames still arrive this long after the report: longer than any that
  /// came before it wait to be read, shorter than an operator waits before trying again.
  Duration bus_off_expires_after = std::chrono::seconds(2);
  /// A frame that is never confirmed blocks its successors no longer than this.
  Duration forget_after = std::chrono::seconds(1);
};

/// A Linux CAN interface. Frames are stamped by the kernel on reception, converted to the monotonic clock. At
/// most one frame per identifier waits to be sent: a newer command must not queue behind an older one. The
/// interface may be switched off, disappear and come back; it is found again by its name.
class SocketCanBus final : public CanBus {
 public:
  /// Throws InputError for an invalid interface name, and when this kernel has no CAN. An interface that does
  /// not exist yet is waited for.
  explicit SocketCanBus(std::string interface, const SocketCanOptions& options = {});

  bool send(const CanFrame& frame) override;
  std::optional<StampedCanFrame> poll() override;
  [[nodiscard]] BusHealth health() const override;

  /// For poll(2).
  [[nodiscard]] int descriptor() const { return socket_.get(); }

 private:
  struct Waiting {
    std::uint32_t id = 0;
    Stamp sent;
  };

  void check_interface();
  void read_all();
  void bind_to(unsigned index);
  void handle_failure(int error);
  void handle_error_frame(const can_frame& frame);
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
  Stamp newest_;                         ///< of the received frames
  std::deque<StampedCanFrame> arrived_;  ///< not yet polled
  std::optional<Stamp> disturbed_;       ///< last report of the controller being error-passive or bus-off
  int refused_in_a_row_ = 0;
  Stamp refused_;                   ///< time of the newest refusal
  std::deque<Waiting> waiting_;     ///< accepted by the kernel, not yet confirmed
  bool oldest_is_overdue_ = false;  ///< the oldest waited too long when everything received had been read
};

}  // namespace lodestar

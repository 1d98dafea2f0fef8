#include "drivers/base/guard_loop.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <poll.h>
#include <sys/socket.h>

#include "drivers/system/clock.hpp"

namespace lodestar {
namespace {

constexpr Duration report_period = std::chrono::milliseconds(10);
constexpr int longest_wait_ms = 5;
constexpr Duration longest_pass = std::chrono::milliseconds(20);

}  // namespace

GuardLoop::GuardLoop(SocketCanBus& bus, int navigator_socket, const GuardOptions& options)
    : bus_(bus), navigator_(navigator_socket), options_(options), moves_(options.stop.size(), false) {}

void GuardLoop::run() {
  while (navigator_is_there_ || repeats_left_ > 0) {
    wait_for_input();
    // If the whole machine stalled, the navigator did not hang: each pass counts at most `longest_pass`.
    const Stamp now = monotonic_now();
    silence_ += std::min(now - now_, longest_pass);
    now_ = now;
    take_requests();
    watch_navigator();
    repeat_stop();
    pass_on_frames();
  }
}

void GuardLoop::wait_for_input() const {
  std::array<pollfd, 2> sockets{{{.fd = bus_.descriptor(), .events = POLLIN, .revents = 0},
                                 {.fd = navigator_, .events = POLLIN, .revents = 0}}};
  (void)::poll(sockets.data(), navigator_is_there_ ? 2 : 1, longest_wait_ms);
}

void GuardLoop::take_requests() {
  while (navigator_is_there_) {
    GuardRequest request;
    const ssize_t size = ::recv(navigator_, &request, sizeof(request), MSG_DONTWAIT);
    if (size == static_cast<ssize_t>(sizeof(request))) {
      take(request);
      continue;
    }
    if (size < 0 && (errno == EAGAIN || errno == EINTR)) return;
    // The navigator has ended: stop the base, whatever was commanded last.
    navigator_is_there_ = false;
    stop_base();
  }
}

void GuardLoop::take(const GuardRequest& request) {
  if (request.kind != GuardRequest::Kind::send) {
    released_ = request.kind == GuardRequest::Kind::release;
    if (!released_) holds_ = false;
    repeats_left_ = 0;
    moves_.assign(moves_.size(), false);
    return;
  }
  for (std::size_t i = 0; i < moves_.size(); ++i) {
    if (request.frame.id != options_.stop[i].id) continue;
    if (holds_) return;
    released_ = false;
    silence_ = Duration::zero();
    moves_[i] = request.frame != options_.stop[i];
  }
  (void)bus_.send(request.frame);
}

/// A navigator whose last command was zero may be silent for any time.
void GuardLoop::watch_navigator() {
  const bool told_to_move = std::ranges::find(moves_, true) != moves_.end();
  if (!navigator_is_there_ || holds_ || !told_to_move) return;
  if (silence_ > options_.max_silence) stop_base();
}

void GuardLoop::stop_base() {
  holds_ = true;
  moves_.assign(moves_.size(), false);
  repeats_left_ = released_ ? 0 : options_.repeats;
  last_stop_ = Stamp{};
}

void GuardLoop::repeat_stop() {
  if (repeats_left_ == 0 || now_ - last_stop_ < options_.repeat_period) return;
  --repeats_left_;
  last_stop_ = now_;
  for (const CanFrame& frame : options_.stop) (void)bus_.send(frame);
}

void GuardLoop::pass_on_frames() {
  while (const auto frame = bus_.poll()) report(frame);
  if (now_ - last_report_ >= report_period) report(std::nullopt);
}

/// Does not wait for a navigator that does not read: it misses reports.
void GuardLoop::report(const std::optional<StampedCanFrame>& frame) {
  if (!navigator_is_there_) return;
  last_report_ = now_;
  GuardReport report{
      .health = bus_.health(), .has_frame = frame.has_value(), .frame = frame.value_or(StampedCanFrame{})};
  const bool carries = report.health.state == BusState::up || report.health.state == BusState::error_passive;
  if (holds_ && carries) report.health.state = BusState::held;
  (void)::send(navigator_, &report, sizeof(report), MSG_DONTWAIT | MSG_NOSIGNAL);
}

}  // namespace lodestar

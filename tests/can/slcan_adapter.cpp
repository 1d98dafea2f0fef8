#include "tests/can/slcan_adapter.hpp"

#include <array>
#include <cstdlib>
#include <fcntl.h>
#include <fmt/format.h>
#include <net/if.h>
#include <poll.h>
#include <stdexcept>
#include <sys/ioctl.h>
#include <termios.h>

namespace lodestar {
namespace {

constexpr int slcan_line_discipline = 17;

FileDescriptor open_controller() {
  FileDescriptor controller(::open("/dev/pts/ptmx", O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (::unlockpt(controller.get()) != 0) throw std::runtime_error("no terminal");
  return controller;
}

FileDescriptor open_terminal(int controller) {
  FileDescriptor terminal(::open(::ptsname(controller), O_RDWR | O_NOCTTY));
  termios settings{};
  ::tcgetattr(terminal.get(), &settings);
  ::cfmakeraw(&settings);
  ::tcsetattr(terminal.get(), TCSANOW, &settings);
  const int discipline = slcan_line_discipline;
  if (::ioctl(terminal.get(), TIOCSETD, &discipline) != 0) throw std::runtime_error("no slcan");
  return terminal;
}

std::string interface_of(int terminal) {
  ifreq request{};
  if (::ioctl(terminal, SIOCGIFNAME, &request) != 0) throw std::runtime_error("slcan has no name");
  return request.ifr_name;
}

}  // namespace

SlcanAdapter::SlcanAdapter(const std::string& base_end)
    : controller_(open_controller()),
      terminal_(open_terminal(controller_.get())),
      interface_(interface_of(terminal_.get())),
      base_(base_end),
      thread_([this] { work(); }) {}

SlcanAdapter::~SlcanAdapter() = default;

void SlcanAdapter::bus_off() {
  const std::lock_guard lock(mutex_);
  is_off_ = true;
  say("sb000256");
}

void SlcanAdapter::back_on_bus() {
  const std::lock_guard lock(mutex_);
  is_off_ = false;
}

void SlcanAdapter::work() {
  const std::stop_token stop = thread_.get_stop_token();
  while (!stop.stop_requested()) {
    std::array<pollfd, 2> ends{{{.fd = controller_.get(), .events = POLLIN, .revents = 0},
                                {.fd = base_.descriptor(), .events = POLLIN, .revents = 0}}};
    (void)::poll(ends.data(), ends.size(), 20);
    const std::lock_guard lock(mutex_);
    std::array<char, 512> bytes{};
    const ssize_t size = ::read(controller_.get(), bytes.data(), bytes.size());
    if (size > 0) text_.append(bytes.data(), static_cast<std::size_t>(size));
    for (std::size_t end = text_.find('\r'); end != std::string::npos; end = text_.find('\r')) {
      handle(text_.substr(0, end));
      text_.erase(0, end + 1);
    }
    while (const auto heard = base_.poll()) {
      std::string line = fmt::format("t{:03X}{}", heard->frame.id, heard->frame.length);
      for (std::size_t i = 0; i < heard->frame.length; ++i)
        line += fmt::format("{:02X}", heard->frame.data.at(i));
      if (!is_off_) say(line);
    }
  }
}

/// "t1118" and the data: a frame to send. Other commands (speed, open, close) are ignored.
void SlcanAdapter::handle(const std::string& line) {
  if (is_off_ || line.size() < 5 || line.front() != 't') return;
  CanFrame frame{static_cast<std::uint32_t>(std::stoul(line.substr(1, 3), nullptr, 16)),
                 static_cast<std::uint8_t>(line[4] - '0'),
                 {}};
  for (std::size_t i = 0; i < frame.length && 6 + 2 * i < line.size(); ++i) {
    frame.data.at(i) = static_cast<std::uint8_t>(std::stoul(line.substr(5 + 2 * i, 2), nullptr, 16));
  }
  (void)base_.send(frame);
}

void SlcanAdapter::say(const std::string& line) {
  const std::string text = line + "\r";
  (void)!::write(controller_.get(), text.data(), text.size());
}

}  // namespace lodestar

// Apart, as the kernel's termios2, which alone knows any speed, clashes with the C library's termios.
#include <asm/termbits.h>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <linux/serial.h>
#include <sys/file.h>
#include <sys/ioctl.h>

#include "drivers/scanner/byte_link.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

/// Eight bits, no parity, no flow control, nothing translated.
bool make_raw(int descriptor, unsigned baud) {
  termios2 settings{};
  if (::ioctl(descriptor, TCGETS2, &settings) != 0) return false;
  settings.c_iflag = 0;
  settings.c_oflag = 0;
  settings.c_lflag = 0;
  settings.c_cflag = CS8 | CREAD | CLOCAL | BOTHER;
  settings.c_ispeed = settings.c_ospeed = baud;
  settings.c_cc[VMIN] = 1;
  settings.c_cc[VTIME] = 0;
  if (::ioctl(descriptor, TCSETS2, &settings) != 0) return false;
  return ::ioctl(descriptor, TCFLSH, TCIOFLUSH) == 0;
}

}  // namespace

ByteLink open_serial(const std::string& device, unsigned baud, bool dtr_is_on) {
  constexpr int dtr = 0x002;  // TIOCM_DTR
  FileDescriptor line(::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!line.is_open())
    throw InputError(fmt::format("scanner {}: found no usable device ({}), wanted a serial line", device,
                                 std::strerror(errno)));
  // Two readers would each get a part of the bytes: the second is refused, as by other programs that keep to
  // this.
  if (::flock(line.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw InputError(
        fmt::format("scanner {}: found a line that another program uses, wanted a free one", device));
  if (!make_raw(line.get(), baud))
    throw InputError(fmt::format("scanner {}: found no serial line ({}), wanted one of {} baud", device,
                                 std::strerror(errno), baud));
  // A pseudo terminal has no such wire, and refuses.
  ::ioctl(line.get(), dtr_is_on ? TIOCMBIS : TIOCMBIC, &dtr);
  return ByteLink(std::move(line));
}

}  // namespace lodestar

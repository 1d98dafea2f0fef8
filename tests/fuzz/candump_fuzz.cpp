#include <sstream>

#include "drivers/can/candump.hpp"
#include "maps/input_error.hpp"

// A log is refused with an InputError, or its frames are written and read again as they were.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lodestar;
  std::istringstream log(std::string(reinterpret_cast<const char*>(data), size));
  std::vector<LoggedCanFrame> read;
  try {
    read = read_candump(log, "fuzz.log");
  } catch (const InputError&) {
    return 0;
  }
  for (const LoggedCanFrame& logged : read) {
    std::istringstream line(candump_line(logged.received, logged.interface) + "\n");
    const std::vector<LoggedCanFrame> again = read_candump(line, "again.log");
    if (again.size() != 1 || again.front().received.frame != logged.received.frame) __builtin_trap();
  }
  return 0;
}

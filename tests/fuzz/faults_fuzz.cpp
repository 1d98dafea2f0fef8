#include <cmath>

#include "drivers/simulation/fault_file.hpp"
#include "maps/input_error.hpp"

#include "tests/fuzz/scratch_file.hpp"

// A file of faults is refused with an InputError, or has finite numbers and valid times.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lodestar;
  try {
    for (const Fault& fault : load_faults(scratch_file("faults.yaml", data, size))) {
      for (const double value :
           {fault.shift_m, fault.direction_rad, fault.turn_rad, fault.count, fault.delay_s, fault.share,
            fault.left_share, fault.right_share, fault.blur_sigma_px}) {
        if (!std::isfinite(value)) __builtin_trap();
      }
      if (fault.begin < Duration::zero() || fault.latest_begin.value_or(fault.begin) < fault.begin) {
        __builtin_trap();
      }
    }
  } catch (const InputError&) {
  }
  return 0;
}

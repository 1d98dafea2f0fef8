#include "app/recording/scan_file.hpp"
#include "maps/input_error.hpp"

#include "tests/fuzz/scratch_file.hpp"

// A file is refused with an InputError, or its scans are written and read again as they were. What follows
// the first byte is a whole file, or, where that byte is even, records behind a good header.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lodestar;
  if (size == 0) return 0;
  std::string bytes = data[0] % 2 == 0 ? scan_file_header({}) : std::string();
  bytes.append(reinterpret_cast<const char*>(data + 1), size - 1);
  const auto file =
      scratch_file("scans.bin", reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  try {
    ScanFileReader reader(file);
    std::string again = scan_file_header(reader.mount());
    while (const std::optional<LoggedScan> logged = reader.next()) again += scan_file_record(*logged);
    if (again.size() + reader.bytes_cut_off() != bytes.size()) __builtin_trap();
    if (!bytes.starts_with(again)) __builtin_trap();
  } catch (const InputError&) {
    return 0;
  }
  return 0;
}

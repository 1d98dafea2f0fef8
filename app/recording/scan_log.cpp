#include "app/recording/scan_log.hpp"

#include "maps/input_error.hpp"

namespace lodestar {

ScanLog::ScanLog(const std::filesystem::path& folder, const ScannerMount& mount,
                 const ScanLogOptions& options)
    : file_(folder / "scans.bin"),
      out_(file_, std::ios::binary | std::ios::trunc),
      writer_(
          {.most_waiting = options.most_waiting,
           .can_wait = options.can_wait,
           .collect = std::chrono::milliseconds(100),
           .tell = options.tell,
           .disk = options.disk},
          [this](const LoggedScan& logged) {
            check();
            const std::string bytes = scan_file_record(logged);
            out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
          },
          [this] {
            out_.flush();
            check();
          }) {
  out_ << scan_file_header(mount) << std::flush;
  check();
}

void ScanLog::take(const SensorInput& input) {
  for (const Scan& scan : input.scans) writer_.put({input.now, scan}, scan.beams.size() + 1);
}

void ScanLog::check() const {
  if (!out_) throw InputError(file_, 0, "a file that cannot be written", "one that can");
}

}  // namespace lodestar

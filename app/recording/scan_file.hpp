#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "maps/scan.hpp"

// scans.bin, the scans of a drive. docs/scans.md has it byte by byte.
namespace lodestar {

/// A scan, and when the navigation was given it.
struct LoggedScan {
  Stamp arrival;
  Scan scan;
};

/// How a file begins: what it is, and where the scanner sits.
std::string scan_file_header(const ScannerMount& mount);

/// A scan as the file has it. Every value is kept to the bit.
std::string scan_file_record(const LoggedScan& logged);

/// Reads scans.bin one scan at a time: hours of them are larger than memory.
class ScanFileReader {
 public:
  /// Throws InputError where the file is not one.
  explicit ScanFileReader(const std::filesystem::path& file);

  [[nodiscard]] const ScannerMount& mount() const { return mount_; }

  /// The next scan; nothing at the end. A last record that is cut off, as by a crash, is left out (see
  /// bytes_cut_off()). Throws InputError with file and offset for bytes that are no record.
  std::optional<LoggedScan> next();

  /// Of the last record, once next() has reached the end; 0 where the file is whole.
  [[nodiscard]] std::size_t bytes_cut_off() const { return cut_off_; }

 private:
  std::string read(std::size_t count);
  [[noreturn]] void refuse(const std::string& found, const std::string& wanted) const;

  std::filesystem::path file_;
  std::ifstream in_;
  ScannerMount mount_;
  std::uint64_t offset_ = 0;  ///< of the record being read
  std::size_t cut_off_ = 0;
};

}  // namespace lodestar

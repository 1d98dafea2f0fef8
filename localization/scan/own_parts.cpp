#include "localization/scan/own_parts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lodestar {

OwnParts::OwnParts(const OwnPartsOptions& options)
    : options_(options),
      bins_(static_cast<std::size_t>(std::ceil(2.0 * std::numbers::pi / options.bin_rad))) {}

std::size_t OwnParts::bin_of(double angle_rad) const {
  const double from_zero = wrap_angle(angle_rad) + std::numbers::pi;
  return std::min(static_cast<std::size_t>(from_zero / options_.bin_rad), bins_.size() - 1);
}

void OwnParts::add(const Scan& scan, const ScannerMount& mount, const OwnOutline& outline) {
  std::vector<bool> is_seen(bins_.size(), false);
  for (const Beam& beam : scan.beams) {
    if (beam.echo != Echo::hit && beam.echo != Echo::too_near) continue;
    if (outline.holds(end_in_base(beam, scan, mount))) is_seen[bin_of(beam.angle_rad)] = true;
  }
  ++scans_;
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    Bin& bin = bins_[i];
    if (scans_ <= options_.learning_scans) bin.seen += is_seen[i] ? 1 : 0;
    if (scans_ == options_.learning_scans)
      bin.is_own = bin.seen >= options_.seen_share * options_.learning_scans;
    bin.missing = is_seen[i] ? 0 : bin.missing + 1;
    if (bin.missing >= options_.gone_after) bin.is_own = false;
  }
}

/// Its edge may lie in one bin or in the next.
bool OwnParts::has(double angle_rad) const {
  const std::size_t middle = bin_of(angle_rad);
  const std::size_t count = bins_.size();
  return bins_[middle].is_own || bins_[(middle + 1) % count].is_own ||
         bins_[(middle + count - 1) % count].is_own;
}

}  // namespace lodestar

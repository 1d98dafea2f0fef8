#include "localization/integrity/scanner_watch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "maps/percentile.hpp"

namespace lodestar {
namespace {

bool is_blind(Echo echo) {
  return echo == Echo::invalid || echo == Echo::too_near;
}

std::vector<double> ranges_of(const Scan& scan) {
  std::vector<double> ranges_m;
  for (const Beam& beam : scan.beams)
    ranges_m.push_back(beam.echo == Echo::hit ? beam.range_m : -1.0 - static_cast<double>(beam.echo));
  return ranges_m;
}

/// Turns a second, by the beams of one scan; nothing where they bear one stamp.
std::optional<double> speed_of(const Scan& scan) {
  if (scan.beams.size() < 10) return std::nullopt;
  double turned_rad = 0.0;
  for (std::size_t i = 1; i < scan.beams.size(); ++i)
    turned_rad += wrap_angle(scan.beams[i].angle_rad - scan.beams[i - 1].angle_rad);
  const double taken_s = seconds(scan.beams.back().stamp - scan.beams.front().stamp);
  if (!(taken_s > 0.0)) return std::nullopt;
  return std::abs(turned_rad) / (2.0 * std::numbers::pi) / taken_s;
}

}  // namespace

std::string_view to_string(ScannerFault fault) {
  switch (fault) {
    case ScannerFault::silent:
      return "the scanner sends no scans";
    case ScannerFault::other_clock:
      return "the scanner's clock is not the robot's";
    case ScannerFault::late:
      return "the scanner's scans come too late";
    case ScannerFault::frozen:
      return "the scanner repeats the same scan";
    case ScannerFault::checksums:
      return "much of what the scanner sends is damaged";
    case ScannerFault::motor:
      return "the scanner turns at the wrong speed";
    case ScannerFault::dirty:
      return "the scanner's window is dirty";
    case ScannerFault::beams_lost:
      return "the scanner loses many of its beams";
    case ScannerFault::turned:
      return "the scanner is turned on its mount";
  }
  return "";
}

void ScannerWatch::add_travel(const WheelTravel& travel) {
  const std::optional<WheelTravel> before = std::exchange(last_travel_, travel);
  if (!before) return;
  const double left_m = travel.left_m - before->left_m;
  const double right_m = travel.right_m - before->right_m;
  motion_.driven_m += std::abs(0.5 * (left_m + right_m));
  motion_.turned_rad += std::abs(right_m - left_m) / options_.track_width_m;
}

std::optional<ScannerFault> ScannerWatch::update(const Scan& scan, Stamp now) {
  last_arrival_ = now;
  if (scan.beams.empty()) return scan_fault_;
  scan_fault_ = clock_fault(scan, now);
  last_beam_ = scan.beams.back().stamp;
  judge_repeats(scan, now);
  judge_motor(scan);
  judge_window(scan);
  judge_lost(scan, now);
  return scan_fault_;
}

std::optional<ScannerFault> ScannerWatch::clock_fault(const Scan& scan, Stamp now) const {
  const auto [first, last] = std::ranges::minmax(scan.beams, {}, &Beam::stamp);
  const Duration age = now - last.stamp;
  const bool is_out_of_order = last_beam_ && first.stamp < *last_beam_ - options_.max_overlap;
  if (age < -options_.max_ahead || age > options_.another_age || is_out_of_order)
    return ScannerFault::other_clock;
  if (age > options_.max_age) return ScannerFault::late;
  return std::nullopt;
}

/// A scanner with noise never measures the same twice; one without does so only where nothing moves.
void ScannerWatch::judge_repeats(const Scan& scan, Stamp now) {
  if (!first_scan_) first_scan_ = now;
  const std::vector<double> before = std::exchange(last_ranges_m_, ranges_of(scan));
  const Motion then = std::exchange(previous_motion_, motion_);
  const auto hits = std::ranges::count(scan.beams, Echo::hit, &Beam::echo);
  if (std::cmp_less(hits, options_.least_hits) || before.size() != last_ranges_m_.size()) {
    repeats_ = 0;
    last_motion_ = motion_;
    return;
  }
  std::size_t differ = 0;
  for (std::size_t i = 0; i < before.size(); ++i) differ += before[i] != last_ranges_m_[i] ? 1 : 0;
  if (differ > 0) {
    const bool stood = motion_.driven_m == then.driven_m && motion_.turned_rad == then.turned_rad;
    if (stood && last_travel_ &&
        static_cast<double>(differ) > options_.noisy_share * static_cast<double>(hits))
      has_noise_ = true;
    has_changed_ = true;
    repeats_ = 0;
    last_motion_ = motion_;
    return;
  }
  ++repeats_;
  const bool moved = motion_.driven_m - last_motion_.driven_m >= options_.moved_m ||
                     motion_.turned_rad - last_motion_.turned_rad >= options_.turned_rad;
  const bool is_unproven = !has_changed_ && now - *first_scan_ < options_.unproven_for;
  if (repeats_ >= 2 && (moved || has_noise_ || is_unproven) && !scan_fault_)
    scan_fault_ = ScannerFault::frozen;
}

void ScannerWatch::judge_motor(const Scan& scan) {
  constexpr std::size_t to_learn = 20;
  const std::optional<double> speed = speed_of(scan);
  if (!speed) return;
  if (!turns_per_second_) turns_per_second_ = options_.turns_per_second;
  if (!turns_per_second_) {
    first_speeds_.push_back(*speed);
    if (first_speeds_.size() >= to_learn) turns_per_second_ = percentile(first_speeds_, 0.5);
    return;
  }
  const bool is_wrong = std::abs(*speed / *turns_per_second_ - 1.0) > options_.max_motor_error;
  motor_wrong_ = is_wrong ? motor_wrong_ + 1 : 0;
}

/// Dirt turns with the scanner: what is blind at the same angle wherever the robot looks is not the world's.
void ScannerWatch::judge_window(const Scan& scan) {
  std::array<int, bins> beams{};
  std::array<int, bins> seeing{};
  for (const Beam& beam : scan.beams) {
    const double turn = (wrap_angle(beam.angle_rad) + std::numbers::pi) / (2.0 * std::numbers::pi);
    const auto bin = std::min(static_cast<std::size_t>(turn * bins), bins - 1);
    ++beams[bin];
    if (!is_blind(beam.echo) || is_hidden(beam.angle_rad)) ++seeing[bin];
  }
  std::array<bool, bins> dirty{};
  for (std::size_t bin = 0; bin < bins; ++bin) {
    if (beams[bin] == 0) continue;  // none is aimed there
    std::optional<Motion>& since = blind_since_[bin];
    if (seeing[bin] > 0)
      since.reset();
    else if (!since)
      since = motion_;
    dirty[bin] = since && motion_.driven_m - since->driven_m >= options_.dirt_moved_m &&
                 motion_.turned_rad - since->turned_rad >= options_.dirt_turned_rad;
  }
  int run = 0;
  int longest = 0;
  for (std::size_t i = 0; i < 2 * bins; ++i) {
    run = dirty[i % bins] ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  is_dirty_ = longest >= options_.dirty_bins;
}

void ScannerWatch::judge_lost(const Scan& scan, Stamp now) {
  std::size_t aimed = 0;
  std::size_t lost = 0;
  for (const Beam& beam : scan.beams) {
    if (is_hidden(beam.angle_rad)) continue;
    ++aimed;
    lost += beam.echo == Echo::invalid ? 1 : 0;
  }
  const auto lasts = [&](double more_than, std::optional<Stamp>& since) {
    if (static_cast<double>(lost) <= more_than * static_cast<double>(aimed))
      since.reset();
    else if (!since)
      since = now;
    return since ? now - *since : Duration::zero();
  };
  const Duration lost_for = lasts(options_.max_lost_share, lost_since_);
  const Duration blind_for = lasts(options_.blind_share, blind_from_);
  is_losing_ = lost_for >= options_.lost_for || blind_for >= options_.max_silence;
}

bool ScannerWatch::is_hidden(double angle_rad) const {
  return std::ranges::any_of(options_.hidden_rad, [angle_rad](const auto& span) {
    return angle_rad >= span.first && angle_rad <= span.second;
  });
}

void ScannerWatch::add_packets(const ScanPackets& total, Stamp now) {
  const auto runs_backwards = [&](const ScanPackets& before) {
    return total.read < before.read || total.refused < before.refused;
  };
  if (!packets_.empty() && runs_backwards(packets_.back().total)) packets_.clear();
  packets_.push_back({now, total});
  while (packets_.size() > 2 && now - packets_[1].stamp >= options_.packets_kept) packets_.pop_front();
}

bool ScannerWatch::is_damaged() const {
  if (packets_.empty()) return false;
  const ScanPackets& now = packets_.back().total;
  const ScanPackets& then = packets_.front().total;
  const std::uint64_t refused = now.refused - then.refused;
  const std::uint64_t all = now.read - then.read + refused;
  return all >= options_.least_packets &&
         static_cast<double>(refused) > options_.max_refused_share * static_cast<double>(all);
}

std::optional<ScannerFault> ScannerWatch::fault(Stamp now) const {
  if (last_arrival_ && now - *last_arrival_ > options_.max_silence) return ScannerFault::silent;
  if (scan_fault_) return scan_fault_;
  if (is_damaged()) return ScannerFault::checksums;
  if (motor_wrong_ >= options_.motor_scans) return ScannerFault::motor;
  if (is_dirty_) return ScannerFault::dirty;
  if (is_losing_) return ScannerFault::beams_lost;
  if (mount_.is_turned()) return ScannerFault::turned;
  return std::nullopt;
}

}  // namespace lodestar

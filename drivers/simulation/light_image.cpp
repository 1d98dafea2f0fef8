#include "drivers/simulation/light_image.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

/// Indices from first to last, both included; empty when last < first.
struct Span {
  int first = 0;
  int last = -1;
};

Span indices_between(double low, double high, int count) {
  const double first = std::clamp(std::ceil(low), 0.0, static_cast<double>(count));
  const double last = std::clamp(std::floor(high), -1.0, static_cast<double>(count - 1));
  return {static_cast<int>(first), static_cast<int>(last)};
}

/// Blends light of `units` over the present value with opacity `share`.
void lay_over(std::int16_t& pixel, double units, double share) {
  pixel = static_cast<std::int16_t>(pixel + share * (units - pixel) + 0.5);  // never negative
}

double units_of(double gray) {
  return LightImage::units_per_gray * std::clamp(gray, 0.0, LightImage::brightest_gray);
}

/// Share of the ellipse's light at a point: the profile at its distance from the rim along the ray from the
/// centre.
double share_at(const Vec2& from_center_px, const ProjectedDisc& disc, double sigma_px,
                const DiscProfile::Row& profile) {
  const double distance_px = from_center_px.norm();
  const double in_unit = (disc.unit_from_px * from_center_px).norm();
  const double rim_px = in_unit > 1e-9 ? distance_px / in_unit : disc.radius_px;
  return profile.at((rim_px - distance_px) / sigma_px);
}

/// The part of the given range [low, high] of x in which low_value <= slope * x + offset <= high_value.
void narrow(double& low, double& high, double slope, double offset, double low_value, double high_value) {
  if (std::abs(slope) < 1e-9) {
    if (offset < low_value || offset > high_value) high = low - 1.0;
    return;
  }
  const double a = (low_value - offset) / slope;
  const double b = (high_value - offset) / slope;
  low = std::max(low, std::min(a, b));
  high = std::min(high, std::max(a, b));
}

/// Motion blur: the mean of copies less than a sigma apart, indistinguishable from a continuous one.
class Smear {
 public:
  Smear(const ProjectedDisc& disc, const Vec2& motion_px, double sigma_px)
      : motion_px_(motion_px), copies_(1 + static_cast<int>(std::ceil(motion_px.norm() / sigma_px))) {
    if (copies_ == 1) return;
    // The ellipse is within the diagonal of half its box: the squares of its semi-axes have the same sum.
    const double reach_px = disc.half_size_px.norm() + DiscProfile::reach * sigma_px;
    copies_per_px_ = copies_ / motion_px.squaredNorm() * motion_px;
    reach_copies_ = reach_px * copies_per_px_.norm() + 1.0;
  }

  [[nodiscard]] int copies() const { return copies_; }
  [[nodiscard]] Vec2 shift_px(int copy) const { return ((copy + 0.5) / copies_ - 0.5) * motion_px_; }
  /// All but those that have no light at all at a point: of a robot that was carried off while the shutter
  /// was open there are thousands.
  [[nodiscard]] Span copies_that_reach(const Vec2& from_center_px) const {
    if (copies_ == 1) return {0, 0};
    const double nearest = from_center_px.dot(copies_per_px_) + 0.5 * (copies_ - 1);
    return indices_between(nearest - reach_copies_, nearest + reach_copies_, copies_);
  }

 private:
  Vec2 motion_px_;
  int copies_ = 1;
  Vec2 copies_per_px_ = Vec2::Zero();  ///< along the motion
  double reach_copies_ = 0.0;
};

}  // namespace

LightImage::LightImage(int width_px, int height_px)
    : width_px_(width_px),
      height_px_(height_px),
      stride_(width_px + width_px % 2),
      values_(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height_px)) {}

void LightImage::paint(const ProjectedDisc& disc, const Vec2& motion_px, double gray, double sigma_px,
                       const DiscProfile& profile) {
  const Smear smear(disc, motion_px, sigma_px);
  const DiscProfile::Row row_profile = profile.of_radius(disc.radius_px / sigma_px);
  const Vec2 reach =
      disc.half_size_px + 0.5 * motion_px.cwiseAbs() + Vec2::Constant(DiscProfile::reach * sigma_px);
  const Span rows =
      indices_between(disc.center_px.y() - reach.y(), disc.center_px.y() + reach.y(), height_px_);
  const Span columns =
      indices_between(disc.center_px.x() - reach.x(), disc.center_px.x() + reach.x(), width_px_);
  const double units = units_of(gray);
  for (int v = rows.first; v <= rows.last; ++v) {
    std::int16_t* pixels = row(v);
    for (int u = columns.first; u <= columns.last; ++u) {
      const Vec2 from_center = Vec2(u, v) - disc.center_px;
      const Span copies = smear.copies_that_reach(from_center);
      double share = 0.0;
      for (int i = copies.first; i <= copies.last; ++i)
        share += share_at(from_center - smear.shift_px(i), disc, sigma_px, row_profile);
      lay_over(pixels[u], units, share / smear.copies());
    }
  }
}

void LightImage::paint(const Band& band, double gray, double sigma_px, const DiscProfile& profile) {
  const Vec2 chord = band.to_px - band.from_px;
  const double length = chord.norm();
  if (length < 1e-6) return;
  const Vec2 direction = chord / length;
  constexpr double far = 1e6;
  constexpr double just_before = -1e-9;  // a pixel exactly on a cut belongs to the segment that begins there
  const double reach = band.half_width_px + DiscProfile::reach * sigma_px;
  const DiscProfile::Row edge = profile.of_straight_edge();
  const double units = units_of(gray);
  const Span rows = indices_between(std::min(band.from_px.y(), band.to_px.y()) - reach,
                                    std::max(band.from_px.y(), band.to_px.y()) + reach, height_px_);
  for (int v = rows.first; v <= rows.last; ++v) {
    // Position along the band, across it, and relative to the cuts: all linear in u within a row.
    const double dv = v - band.from_px.y();
    const double along_0 = direction.y() * dv - direction.x() * band.from_px.x();
    const double across_0 = direction.x() * dv + direction.y() * band.from_px.x();
    double low = 0.0;
    double high = width_px_ - 1.0;
    narrow(low, high, -direction.y(), across_0, -reach, reach);
    narrow(low, high, direction.x(), along_0, -reach, length + reach);
    if (band.cut_from) {
      narrow(low, high, band.cut_from->x(), band.cut_from->dot(Vec2(0.0, v) - band.from_px), 0.0, far);
    }
    if (band.cut_to) {
      narrow(low, high, band.cut_to->x(), band.cut_to->dot(Vec2(0.0, v) - band.to_px), -far, just_before);
    }
    const Span columns = indices_between(low, high, width_px_);
    std::int16_t* pixels = row(v);
    for (int u = columns.first; u <= columns.last; ++u) {
      const double along = along_0 + direction.x() * u;
      const double across = across_0 - direction.y() * u;
      const double before = band.cut_from ? 0.0 : -along;
      const double after = band.cut_to ? 0.0 : along - length;
      const double beyond = std::max({before, after, 0.0});
      const double distance = std::sqrt(across * across + beyond * beyond);
      lay_over(pixels[u], units, edge.at((band.half_width_px - distance) / sigma_px));
    }
  }
}

}  // namespace lodestar

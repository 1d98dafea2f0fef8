#include "localization/detection/peaks.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace lodestar {
namespace {

/// Noise left by a mean of 3 x 3 pixels with weights 1 2 1 both ways.
constexpr double smoothed_noise = 0.375;

/// A part of the frame, each pixel the mean of 3 x 3 with those weights.
class SmoothedPart {
 public:
  /// `part` lies inside the frame by a pixel. `values` is its memory.
  SmoothedPart(const cv::Mat& gray, const cv::Rect& part, std::vector<float>& values)
      : part_(part), values_(values) {
    values_.resize(static_cast<std::size_t>(part.area()));
    auto value = values_.begin();
    for (int v = part.y; v < part.br().y; ++v) {
      const auto* const above = gray.ptr<std::uint8_t>(v - 1);
      const auto* const here = gray.ptr<std::uint8_t>(v);
      const auto* const below = gray.ptr<std::uint8_t>(v + 1);
      for (int u = part.x; u < part.br().x; ++u, ++value) {
        const auto column = [&](int at) { return above[at] + 2 * here[at] + below[at]; };
        *value = static_cast<float>(column(u - 1) + 2 * column(u) + column(u + 1)) / 16.0F;
      }
    }
  }
  [[nodiscard]] bool has(int u, int v, int margin) const {
    return u - margin >= part_.x && v - margin >= part_.y && u + margin < part_.br().x &&
           v + margin < part_.br().y;
  }
  [[nodiscard]] double at(int u, int v) const {
    return static_cast<double>(values_[static_cast<std::size_t>((v - part_.y) * part_.width + u - part_.x)]);
  }
  /// Is this pixel brighter than its eight neighbours? Of equal ones the last.
  [[nodiscard]] bool is_peak(int u, int v) const {
    const double here = at(u, v);
    for (int j = -1; j <= 1; ++j) {
      for (int i = -1; i <= 1; ++i) {
        if (i == 0 && j == 0) continue;
        const double beside = at(u + i, v + j);
        const bool before = j < 0 || (j == 0 && i < 0);
        if (before ? here < beside : here <= beside) return false;
      }
    }
    return true;
  }

 private:
  cv::Rect part_;
  std::vector<float>& values_;
};

constexpr int valley_px = 3;  // from a peak to where its prominence is measured

/// The pixels of an area and around it, as far as they are inside the frame.
cv::Rect part_about(const cv::Mat& gray, std::span<const Run> area) {
  int left = area.front().begin;
  int right = area.front().end;
  for (const Run& run : area) {
    left = std::min(left, run.begin);
    right = std::max(right, run.end);
  }
  const int top = area.front().row;
  const int bottom = area.back().row + 1;
  return cv::Rect(left - valley_px, top - valley_px, right - left + 2 * valley_px,
                  bottom - top + 2 * valley_px) &
         cv::Rect(1, 1, gray.cols - 2, gray.rows - 2);
}

/// Vertex of the parabola through three equidistant values, from the middle one.
double vertex(double before, double middle, double after) {
  const double curvature = before - 2.0 * middle + after;
  return curvature < 0.0 ? std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5) : 0.0;
}

}  // namespace

std::span<const Vec2> PeakFinder::find(const cv::Mat& gray, std::span<const Run> area, double background_gray,
                                       double noise_gray) {
  const SmoothedPart part(gray, part_about(gray, area), smoothed_);
  peaks_.clear();
  double highest = 0.0;
  for (const Run& run : area) {
    const int v = run.row;
    for (int u = run.begin; u < run.end; ++u) {
      if (!part.has(u, v, valley_px) || !part.is_peak(u, v)) continue;
      // Between touching dots the valley may be shallow, but it is not so all around.
      const double here = part.at(u, v);
      const double around = 0.25 * (part.at(u - valley_px, v) + part.at(u + valley_px, v) +
                                    part.at(u, v - valley_px) + part.at(u, v + valley_px));
      const Vec2 place(u + vertex(part.at(u - 1, v), here, part.at(u + 1, v)),
                       v + vertex(part.at(u, v - 1), here, part.at(u, v + 1)));
      highest = std::max(highest, here - background_gray);
      peaks_.push_back({place, here - around});
    }
  }
  const double least =
      std::max(options_.least_prominence * highest, options_.prominence_sigmas * smoothed_noise * noise_gray);
  places_.clear();
  for (const Peak& peak : peaks_)
    if (peak.prominence >= least) places_.push_back(peak.place_px);
  return places_;
}

}  // namespace lodestar

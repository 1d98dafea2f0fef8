#include "localization/dots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>

namespace lodestar {
namespace {

constexpr int smallest_part_px = 4;  // what erosion parts must each be so large to be a dot

int rounded(double value) {
  return static_cast<int>(std::lround(value));
}

bool is_inside(const cv::Mat& gray, const Vec2& center_px, double reach_px) {
  return center_px.x() - reach_px >= 0.0 && center_px.y() - reach_px >= 0.0 &&
         center_px.x() + reach_px <= gray.cols - 1 && center_px.y() + reach_px <= gray.rows - 1;
}

/// The lower third of the sides of a square around the dot: neighbouring dots may reach the other pixels.
double background_around(const cv::Mat& gray, const Vec2& center_px, double reach_px) {
  constexpr int most = 16;  // samples a side
  std::array<std::uint8_t, 4 * most> samples;
  const int u = rounded(center_px.x());
  const int v = rounded(center_px.y());
  const int reach = static_cast<int>(std::ceil(reach_px)) + 1;
  const int step = std::max(2, (2 * reach + most - 1) / most);
  const int left = std::max(u - reach, 0);
  const int right = std::min(u + reach, gray.cols - 1);
  const int top = std::max(v - reach, 0);
  const int bottom = std::min(v + reach, gray.rows - 1);
  auto end = samples.begin();
  const auto* above = gray.ptr<std::uint8_t>(top);
  const auto* below = gray.ptr<std::uint8_t>(bottom);
  for (int i = left; i < right; i += step) {
    *end++ = above[i];
    *end++ = below[i];
  }
  for (int j = top; j < bottom; j += step) {
    const auto* row = gray.ptr<std::uint8_t>(j);
    *end++ = row[left];
    *end++ = row[right];
  }
  const auto third = samples.begin() + (end - samples.begin()) / 3;
  std::nth_element(samples.begin(), third, end);
  return *third;
}

/// The dot's middle: the mean of the three brightest of the nine pixels there. Less noisy than the brightest
/// one, and unlike the mean of all nine not dimmed by the edge of a small dot.
double middle_gray(const cv::Mat& gray, const Vec2& center_px) {
  const int u = rounded(center_px.x());
  const int v = rounded(center_px.y());
  std::array<std::uint8_t, 9> pixels;
  auto end = pixels.begin();
  for (int j = v - 1; j <= v + 1; ++j) end = std::copy_n(gray.ptr<std::uint8_t>(j) + u - 1, 3, end);
  std::ranges::partial_sort(pixels, pixels.begin() + 3, std::greater{});
  return (pixels[0] + pixels[1] + pixels[2]) / 3.0;
}

/// Light above the background within a disc, and its centre. The disc's edge is soft (one pixel wide), so
/// that pixels do not jump in and out as the disc moves.
struct Light {
  double mass = 0.0;
  Vec2 center_px = Vec2::Zero();
};

Light light_within(const cv::Mat& gray, const Vec2& center_px, double radius_px, double background) {
  const int left = std::max(static_cast<int>(std::ceil(center_px.x() - radius_px - 0.5)), 0);
  const int right = std::min(static_cast<int>(center_px.x() + radius_px + 0.5), gray.cols - 1);
  const int top = std::max(static_cast<int>(std::ceil(center_px.y() - radius_px - 0.5)), 0);
  const int bottom = std::min(static_cast<int>(center_px.y() + radius_px + 0.5), gray.rows - 1);
  const auto background_gray = static_cast<float>(background);
  const double reach = radius_px + 0.5;
  const auto slope = static_cast<float>(0.5 / radius_px);  // weight 1 at radius - 1/2 and 0 at reach, by d^2
  const auto edge = static_cast<float>(reach * reach * 0.5 / radius_px);
  const auto first_x = static_cast<float>(left - center_px.x());
  Light light;
  for (int v = top; v <= bottom; ++v) {
    const auto* row = gray.ptr<std::uint8_t>(v);
    const auto y = static_cast<float>(v - center_px.y());
    float mass = 0.0F;
    float moment = 0.0F;
    for (int i = 0; i <= right - left; ++i) {
      const float x = first_x + static_cast<float>(i);
      const float weight = std::clamp(edge - (x * x + y * y) * slope, 0.0F, 1.0F);
      const float part = weight * (static_cast<float>(row[left + i]) - background_gray);
      mass += part;
      moment += part * x;
    }
    light.mass += mass;
    light.center_px += Vec2(moment, mass * y);
  }
  if (light.mass > 0.0) light.center_px = center_px + light.center_px / light.mass;
  return light;
}

/// The paper takes the centre of the binary dot, good to a few tenths of a pixel. Here that is only where the
/// measurement starts: the centroid of the gray values above the local background, first within a disc wide
/// enough to hold all of the dot's light, which tells its radius whatever the blur (light = pi r^2 contrast),
/// then within a disc that ends just beyond the dot's edge, which keeps the background's noise out.
std::optional<Dot> measured_dot(const cv::Mat& gray, const BrightArea& area, const DotOptions& options) {
  Dot dot;
  dot.center_px = {area.mean_u_px, area.mean_v_px};
  const double reach_px = std::sqrt(area.area_px / std::numbers::pi) + options.tail_px;
  if (!is_inside(gray, dot.center_px, 2.0)) return std::nullopt;
  dot.background_gray = background_around(gray, dot.center_px, reach_px);
  dot.contrast_gray = middle_gray(gray, dot.center_px) - dot.background_gray;
  const Light all = light_within(gray, dot.center_px, reach_px, dot.background_gray);
  if (!(all.mass > 0.0 && dot.contrast_gray > 0.0)) return std::nullopt;
  dot.radius_px = std::sqrt(all.mass / (std::numbers::pi * dot.contrast_gray));
  const double disc_px = dot.radius_px + options.center_margin_px;
  if (dot.radius_px < options.min_radius_px || !is_inside(gray, all.center_px, disc_px)) return std::nullopt;
  const Light near = light_within(gray, all.center_px, disc_px, dot.background_gray);
  if (!(near.mass > 0.0)) return std::nullopt;
  dot.center_px = near.center_px;
  return dot;
}

/// A faint dot may rise above the threshold in several specks, each of which finds the whole dot. One is
/// kept, with the eroded pixels of all. Areas come from top to bottom, so a dot's specks are not far apart.
void append_without_repeats(const Dot& dot, std::span<const Run> eroded_runs, DotImage& found) {
  constexpr std::size_t far = 64;
  const std::size_t size = found.dots.size();
  for (std::size_t back = 1; back <= std::min(far, size); ++back) {
    const Dot& other = found.dots[size - back];
    if ((other.center_px - dot.center_px).norm() >= 0.5 * other.radius_px) continue;
    auto& runs = found.eroded[size - back];
    runs.insert(runs.end(), eroded_runs.begin(), eroded_runs.end());
    return;
  }
  found.dots.push_back(dot);
  found.eroded.emplace_back(eroded_runs.begin(), eroded_runs.end());
}

void append_dot(const cv::Mat& gray, const BrightArea& area, std::span<const Run> eroded_runs,
                const DotOptions& options, DotImage& found) {
  if (area.aspect_ratio > options.max_aspect_ratio) return;
  const std::optional<Dot> dot = measured_dot(gray, area, options);
  if (dot) append_without_repeats(*dot, eroded_runs, found);
}

Run brightest_pixel(const cv::Mat& gray, std::span<const Run> runs) {
  Run brightest = runs.front();
  int most = -1;
  for (const Run& run : runs) {
    const auto* row = gray.ptr<std::uint8_t>(run.row);
    const auto* pixel = std::max_element(row + run.begin, row + run.end);
    if (*pixel <= most) continue;
    most = *pixel;
    brightest = {run.row, static_cast<int>(pixel - row), static_cast<int>(pixel - row) + 1};
  }
  return brightest;
}

/// One run a row, each touching the next: so nearly all dots look after erosion, and need no search for
/// parts.
bool is_plainly_one_piece(std::span<const Run> runs) {
  return std::ranges::adjacent_find(runs, [](const Run& above, const Run& below) {
           return below.row != above.row + 1 || below.begin > above.end || above.begin > below.end;
         }) == runs.end();
}

/// Erosion parts an area into the dots that touched in it. It never takes or tears a dot: of one that is too
/// small for the element its brightest pixel is left.
void append_dots_of_area(const cv::Mat& gray, std::span<const Run> runs, const BrightArea& area,
                         const DotOptions& options, DotImage& found) {
  std::vector<Run> left = eroded(runs, options.erosion_px);
  if (left.empty()) left.push_back(brightest_pixel(gray, runs));
  if (is_plainly_one_piece(left)) return append_dot(gray, area, left, options, found);
  const BrightAreas parts = connected_areas(left);
  const bool several = parts.areas.size() > 1 && std::ranges::all_of(parts.areas, [](const BrightArea& part) {
                         return part.area_px >= smallest_part_px;
                       });
  if (!several) return append_dot(gray, area, left, options, found);
  for (const BrightArea& part : parts.areas) append_dot(gray, part, parts.runs_of(part), options, found);
}

}  // namespace

DotImage find_dots(const cv::Mat& gray, const DotOptions& options) {
  const BrightAreas bright = connected_areas(bright_runs(gray, options.threshold));
  DotImage found;
  for (const BrightArea& area : bright.areas) {
    if (area.area_px < options.min_area_px || area.area_px > options.max_area_px) continue;
    append_dots_of_area(gray, bright.runs_of(area), area, options, found);
  }
  return found;
}

}  // namespace lodestar

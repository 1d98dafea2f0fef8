#include "localization/disc_light.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "localization/wide_registers.hpp"

namespace lodestar {
namespace {

constexpr int lanes = 8;
using Floats [[gnu::vector_size(lanes * sizeof(float))]] = float;
using Ints [[gnu::vector_size(lanes * sizeof(std::int32_t))]] = std::int32_t;
using Bytes [[gnu::vector_size(lanes)]] = std::uint8_t;

/// The pixels about a place, in blocks of lanes; all of them lie in the frame.
struct Patch {
  const std::uint8_t* first = nullptr;
  std::size_t stride = 0;
  int rows = 0;
  int blocks = 0;        ///< of a row
  float left_px = 0.0F;  ///< first pixel's place, from the middle of the disc
  float top_px = 0.0F;
};

/// Of a value that is not negative.
int whole_at_least(double value) {
  const int whole = static_cast<int>(value);
  return whole < value ? whole + 1 : whole;
}

/// Blocks may reach beyond the disc, where weights are zero, but not beyond the frame.
std::optional<Patch> patch_about(const cv::Mat& gray, const Vec2& center_px, double reach_px) {
  if (!(std::abs(center_px.x()) < 1e6 && std::abs(center_px.y()) < 1e6)) return std::nullopt;
  int left = whole_at_least(center_px.x() - reach_px);
  const int right = static_cast<int>(center_px.x() + reach_px);
  const int top = whole_at_least(center_px.y() - reach_px);
  const int bottom = static_cast<int>(center_px.y() + reach_px);
  if (center_px.x() < reach_px || center_px.y() < reach_px || right >= gray.cols || bottom >= gray.rows)
    return std::nullopt;
  Patch patch;
  patch.blocks = (right - left + lanes) / lanes;
  left = std::min(left, gray.cols - patch.blocks * lanes);
  if (left < 0) return std::nullopt;
  patch.first = gray.ptr<std::uint8_t>(top) + left;
  patch.stride = gray.step[0];
  patch.rows = bottom - top + 1;
  patch.left_px = static_cast<float>(left - center_px.x());
  patch.top_px = static_cast<float>(top - center_px.y());
  return patch;
}

/// Inlined, so that it is compiled for the processor that its caller is compiled for.
[[gnu::always_inline]] inline void load(const std::uint8_t* pixels, Floats& light) {
  Bytes bytes;
  std::memcpy(&bytes, pixels, lanes);
  light = __builtin_convertvector(__builtin_convertvector(bytes, Ints), Floats);
}

constexpr Floats steps{0.0F, 1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F, 7.0F};

/// In pairs, so that no addition waits for the one before it.
double sum_of(const Floats& v) {
  const float even = (v[0] + v[2]) + (v[4] + v[6]);
  const float odd = (v[1] + v[3]) + (v[5] + v[7]);
  return static_cast<double>(even + odd);
}

struct LightSums {
  Floats mass;
  Floats moment_x;
  Floats moment_y;
};

/// Adds to sums that are zero.
LODESTAR_WIDE_REGISTERS
void sum_light(const Patch& patch, float edge, float slope, float background, LightSums& sums) {
  const Floats zero{};
  const Floats one = zero + 1.0F;
  for (int block = 0; block < patch.blocks; ++block) {
    const Floats x = steps + (patch.left_px + static_cast<float>(block * lanes));
    const Floats squared_x = x * x;
    const std::uint8_t* pixels = patch.first + static_cast<std::ptrdiff_t>(block) * lanes;
    Floats columns{};
    Floats moment_y{};
    for (int v = 0; v < patch.rows; ++v, pixels += patch.stride) {
      const float y = patch.top_px + static_cast<float>(v);
      Floats weight = edge - (squared_x + y * y) * slope;
      weight = weight > zero ? weight : zero;
      weight = weight < one ? weight : one;
      Floats light;
      load(pixels, light);
      const Floats part = weight * (light - background);
      columns += part;
      moment_y += part * y;
    }
    sums.mass += columns;
    sums.moment_x += columns * x;
    sums.moment_y += moment_y;
  }
}

struct EdgeSums {
  Floats along_x;  ///< gray times the weight for x
  Floats along_y;  ///< and for y
  Floats gain;     ///< what both change by together, a pixel
  Floats squares;  ///< sum of both weights' squares
  Floats shots;    ///< and of their products with the gray values
};

/// Adds to sums that are zero.
LODESTAR_WIDE_REGISTERS
void sum_edge(const Patch& patch, float squared_radius, float per_width, EdgeSums& sums) {
  const Floats zero{};
  for (int block = 0; block < patch.blocks; ++block) {
    const Floats x = steps + (patch.left_px + static_cast<float>(block * lanes));
    const Floats squared_x = x * x;
    const std::uint8_t* pixels = patch.first + static_cast<std::ptrdiff_t>(block) * lanes;
    Floats columns{};
    Floats along_y{};
    Floats change{};
    Floats squares{};
    Floats shots{};
    for (int v = 0; v < patch.rows; ++v, pixels += patch.stride) {
      const float y = patch.top_px + static_cast<float>(v);
      Floats light;
      load(pixels, light);
      const Floats squared_distance = squared_x + y * y;
      const Floats t = (squared_distance - squared_radius) * per_width;
      Floats inside = 1.0F - t * t;
      inside = inside > zero ? inside : zero;
      const Floats cubed = inside * inside * inside;
      const Floats weight = cubed * inside;
      const Floats light_weight = light * weight;
      columns += light_weight;
      along_y += light_weight * y;
      change += (light * cubed) * (squared_distance * t);
      const Floats square = weight * weight * squared_distance;
      squares += square;
      shots += square * light;
    }
    sums.along_x += columns * x;
    sums.along_y += along_y;
    // d(w x)/dx + d(w y)/dy = 2 w + 2 d^2 dw/d(d^2), and dw/d(d^2) = -8 t (1 - t^2)^3 / width
    sums.gain += 2.0F * columns - (16.0F * per_width) * change;
    sums.squares += squares;
    sums.shots += shots;
  }
}

}  // namespace

std::optional<DiscLight> light_in_disc(const cv::Mat& gray, const Vec2& center_px, double radius_px,
                                       double background_gray) {
  const double reach = radius_px + 0.5;
  const std::optional<Patch> patch = patch_about(gray, center_px, reach);
  if (!patch) return std::nullopt;
  // Weight 1 at radius - 1/2 and 0 at radius + 1/2, linear in d^2.
  LightSums sums{};
  sum_light(*patch, static_cast<float>(reach * reach * 0.5 / radius_px), static_cast<float>(0.5 / radius_px),
            static_cast<float>(background_gray), sums);
  DiscLight light{.mass = sum_of(sums.mass), .center_px = center_px};
  if (light.mass > 0.0) light.center_px += Vec2(sum_of(sums.moment_x), sum_of(sums.moment_y)) / light.mass;
  return light;
}

std::optional<DiscCenter> center_by_edge(const cv::Mat& gray, const Vec2& start_px, double radius_px,
                                         const EdgeOptions& options) {
  const double width = 2.0 * radius_px * options.half_width_px;
  const double squared_radius = radius_px * radius_px;
  const double reach_px = std::sqrt(squared_radius + width);
  DiscCenter center{.center_px = start_px};
  for (int i = 0; i < options.most_steps; ++i) {
    const std::optional<Patch> patch = patch_about(gray, center.center_px, reach_px);
    if (!patch) return std::nullopt;
    EdgeSums sums{};
    sum_edge(*patch, static_cast<float>(squared_radius), static_cast<float>(1.0 / width), sums);
    // The sum weighted by w x falls by half the gain as the weight moves on by a pixel.
    const double gain = 0.5 * sum_of(sums.gain);
    const Vec2 step = Vec2(sum_of(sums.along_x), sum_of(sums.along_y)) / gain;
    if (!(gain > 0.0 && step.norm() < options.longest_step_px)) return std::nullopt;
    center.center_px += step;
    center.variance_per_variance_px2 = 0.5 * sum_of(sums.squares) / (gain * gain);
    center.variance_per_gray_px2 = 0.5 * sum_of(sums.shots) / (gain * gain);
    if (step.norm() < options.small_step_px) break;
  }
  return center;
}

}  // namespace lodestar

#include "localization/disc_light.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "localization/wide_registers.hpp"

namespace lodestar {
namespace {

constexpr int lanes = 16;
using Floats [[gnu::vector_size(lanes * sizeof(float))]] = float;
using Ints [[gnu::vector_size(lanes * sizeof(std::int32_t))]] = std::int32_t;
using Shorts [[gnu::vector_size(lanes * sizeof(std::uint16_t))]] = std::uint16_t;
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

// Inlined, so that they are compiled for the processor that their caller is compiled for.

[[gnu::always_inline]] inline void load(const std::uint8_t* pixels, Floats& light) {
  Bytes bytes;
  std::memcpy(&bytes, pixels, lanes);
  const Shorts shorts = __builtin_convertvector(bytes, Shorts);  // doubled at each step, as instructions do
  light = __builtin_convertvector(__builtin_convertvector(shorts, Ints), Floats);
}

/// Zero instead of what is negative, by the sign bit: a register wider than the processor's has no other way.
[[gnu::always_inline]] inline void cut_at_zero(Floats& v) {
  constexpr int sign_bit = 31;
  Ints bits;
  std::memcpy(&bits, &v, sizeof(v));
  bits &= ~(bits >> sign_bit);
  std::memcpy(&v, &bits, sizeof(v));
}

/// Half of the lanes onto the other half, and so on.
[[gnu::always_inline]] inline float sum_of(const Floats& v) {
  using Four [[gnu::vector_size(4 * sizeof(float))]] = float;
  std::array<Four, lanes / 4> parts;
  std::memcpy(parts.data(), &v, sizeof(v));
  const Four sum = (parts[0] + parts[2]) + (parts[1] + parts[3]);
  return (sum[0] + sum[2]) + (sum[1] + sum[3]);
}

constexpr Floats steps{0.0F, 1.0F, 2.0F,  3.0F,  4.0F,  5.0F,  6.0F,  7.0F,
                       8.0F, 9.0F, 10.0F, 11.0F, 12.0F, 13.0F, 14.0F, 15.0F};

struct LightSums {
  float mass = 0.0F;
  float moment_x = 0.0F;
  float moment_y = 0.0F;
};

LODESTAR_WIDE_REGISTERS
void sum_light(const Patch& patch, float edge, float slope, float background, LightSums& sums) {
  for (int block = 0; block < patch.blocks; ++block) {
    const Floats x = steps + (patch.left_px + static_cast<float>(block * lanes));
    const Floats squared_x = x * x;
    const std::uint8_t* pixels = patch.first + static_cast<std::ptrdiff_t>(block) * lanes;
    Floats columns{};
    Floats moment_y{};
    for (int v = 0; v < patch.rows; ++v, pixels += patch.stride) {
      const float y = patch.top_px + static_cast<float>(v);
      Floats missing = (squared_x + y * y) * slope - (edge - 1.0F);  // to the full weight of one
      cut_at_zero(missing);
      Floats weight = 1.0F - missing;
      cut_at_zero(weight);
      Floats light;
      load(pixels, light);
      const Floats part = weight * (light - background);
      columns += part;
      moment_y += part * y;
    }
    sums.mass += sum_of(columns);
    sums.moment_x += sum_of(columns * x);
    sums.moment_y += sum_of(moment_y);
  }
}

struct EdgeSums {
  float along_x = 0.0F;  ///< gray times the weight for x
  float along_y = 0.0F;  ///< and for y
  float gain = 0.0F;     ///< what both change by together, a pixel
  float squares = 0.0F;  ///< sum of both weights' squares
  float shots = 0.0F;    ///< and of their products with the gray values
};

LODESTAR_WIDE_REGISTERS
void sum_edge(const Patch& patch, float squared_radius, float per_width, EdgeSums& sums) {
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
      cut_at_zero(inside);
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
    sums.along_x += sum_of(columns * x);
    sums.along_y += sum_of(along_y);
    // d(w x)/dx + d(w y)/dy = 2 w + 2 d^2 dw/d(d^2), and dw/d(d^2) = -8 t (1 - t^2)^3 / width
    sums.gain += sum_of(2.0F * columns - (16.0F * per_width) * change);
    sums.squares += sum_of(squares);
    sums.shots += sum_of(shots);
  }
}

}  // namespace

std::optional<DiscLight> light_in_disc(const cv::Mat& gray, const Vec2& center_px, double radius_px,
                                       double background_gray) {
  const double reach = radius_px + 0.5;
  const std::optional<Patch> patch = patch_about(gray, center_px, reach);
  if (!patch) return std::nullopt;
  // Weight 1 at radius - 1/2 and 0 at radius + 1/2, linear in d^2.
  LightSums sums;
  sum_light(*patch, static_cast<float>(reach * reach * 0.5 / radius_px), static_cast<float>(0.5 / radius_px),
            static_cast<float>(background_gray), sums);
  const double mass = sums.mass;
  DiscLight light{.mass = mass, .center_px = center_px};
  if (mass > 0.0) light.center_px += Vec2(sums.moment_x, sums.moment_y) / mass;
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
    EdgeSums sums;
    sum_edge(*patch, static_cast<float>(squared_radius), static_cast<float>(1.0 / width), sums);
    // The sum weighted by w x falls by half the gain as the weight moves on by a pixel.
    const double gain = 0.5 * static_cast<double>(sums.gain);
    const Vec2 step = Vec2(sums.along_x, sums.along_y) / gain;
    if (!(gain > 0.0 && step.norm() < options.longest_step_px)) return std::nullopt;
    center.center_px += step;
    center.variance_per_variance_px2 = 0.5 * static_cast<double>(sums.squares) / (gain * gain);
    center.variance_per_gray_px2 = 0.5 * static_cast<double>(sums.shots) / (gain * gain);
    if (step.norm() < options.small_step_px) break;
  }
  return center;
}

}  // namespace lodestar

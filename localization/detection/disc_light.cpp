#include "localization/detection/disc_light.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "localization/detection/wide_registers.hpp"

namespace lodestar {
namespace {

// Sixteen pixels at a time: usually a dot's whole width. One register on processors with AVX-512, two of
// eight on all others. Everything is inlined, so that it is compiled for its caller's target.
constexpr int lanes = 16;
using Sixteen [[gnu::vector_size(16 * sizeof(float))]] = float;
using Eight [[gnu::vector_size(8 * sizeof(float))]] = float;
using Four [[gnu::vector_size(4 * sizeof(float))]] = float;

struct TwoOfEight {
  Eight low;
  Eight high;

  TwoOfEight() = default;
  [[gnu::always_inline]] TwoOfEight(const Eight& l, const Eight& h) : low(l), high(h) {}
  [[gnu::always_inline]] TwoOfEight(float all)
      : low(Eight{} + all),
        high(Eight{} + all) {}  // NOLINT(google-explicit-constructor): as a vector's operators do it

  [[gnu::always_inline]] friend TwoOfEight operator+(const TwoOfEight& a, const TwoOfEight& b) {
    return {a.low + b.low, a.high + b.high};
  }
  [[gnu::always_inline]] friend TwoOfEight operator-(const TwoOfEight& a, const TwoOfEight& b) {
    return {a.low - b.low, a.high - b.high};
  }
  [[gnu::always_inline]] friend TwoOfEight operator*(const TwoOfEight& a, const TwoOfEight& b) {
    return {a.low * b.low, a.high * b.high};
  }
  [[gnu::always_inline]] TwoOfEight& operator+=(const TwoOfEight& b) { return *this = *this + b; }
};

using EightBytes [[gnu::vector_size(8)]] = std::uint8_t;
using EightShorts [[gnu::vector_size(16)]] = std::uint16_t;
using EightInts [[gnu::vector_size(32)]] = std::int32_t;
using SixteenBytes [[gnu::vector_size(16)]] = std::uint8_t;
using SixteenShorts [[gnu::vector_size(32)]] = std::uint16_t;
using SixteenInts [[gnu::vector_size(64)]] = std::int32_t;

/// Converts pixels to floats, doubling their width at each step as the instructions do.
template <typename Bytes, typename Shorts, typename Ints, typename Floats>
[[gnu::always_inline]] inline void widen(const std::uint8_t* pixels, Floats& light) {
  Bytes bytes;
  std::memcpy(&bytes, pixels, sizeof(bytes));
  const Shorts shorts = __builtin_convertvector(bytes, Shorts);
  light = __builtin_convertvector(__builtin_convertvector(shorts, Ints), Floats);
}

#ifdef LODESTAR_SIXTEEN_LANES
[[gnu::always_inline]] inline void load(const std::uint8_t* pixels, Sixteen& light) {
  widen<SixteenBytes, SixteenShorts, SixteenInts>(pixels, light);
}
#endif

[[gnu::always_inline]] inline void load(const std::uint8_t* pixels, TwoOfEight& light) {
  widen<EightBytes, EightShorts, EightInts>(pixels, light.low);
  widen<EightBytes, EightShorts, EightInts>(pixels + 8, light.high);
}

template <typename Floats>
[[gnu::always_inline]] inline void clamp_to(float least, float most, Floats& v) {
  const Floats low = Floats{} + least;
  const Floats high = Floats{} + most;
  v = v > low ? v : low;
  v = v < high ? v : high;
}

[[gnu::always_inline]] inline void clamp_to(float least, float most, TwoOfEight& v) {
  clamp_to(least, most, v.low);
  clamp_to(least, most, v.high);
}

/// Adds one half of the lanes to the other half, and so on.
template <typename Floats>
[[gnu::always_inline]] inline float sum_of(const Floats& v) {
  static_assert(sizeof(v) == 4 * sizeof(Four));
  std::array<Four, 4> parts;
  std::memcpy(parts.data(), &v, sizeof(v));
  const Four sum = (parts[0] + parts[2]) + (parts[1] + parts[3]);
  return (sum[0] + sum[2]) + (sum[1] + sum[3]);
}

constexpr std::array<float, lanes> steps{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

/// The pixels around a position, in blocks of lanes; all of them are in the frame.
struct Patch {
  const std::uint8_t* first = nullptr;
  std::size_t stride = 0;
  int rows = 0;
  int blocks = 0;        ///< per row
  float left_px = 0.0F;  ///< position of the first pixel relative to the disc's centre
  float top_px = 0.0F;
};

/// Ceiling of a non-negative value.
int whole_at_least(double value) {
  const int whole = static_cast<int>(value);
  return whole < value ? whole + 1 : whole;
}

/// Blocks may extend beyond the disc, where weights are zero, but not beyond the frame.
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

struct LightSums {
  float mass = 0.0F;
  float moment_x = 0.0F;
  float moment_y = 0.0F;
};

template <typename Floats>
[[gnu::always_inline]] inline void sum_light(const Patch& patch, float edge, float slope, float background,
                                             LightSums& sums) {
  for (int block = 0; block < patch.blocks; ++block) {
    Floats x;
    std::memcpy(&x, steps.data(), sizeof(x));
    x += patch.left_px + static_cast<float>(block * lanes);
    const Floats squared_x = x * x;
    const std::uint8_t* pixels = patch.first + static_cast<std::ptrdiff_t>(block) * lanes;
    Floats columns = Floats{} + 0.0F;
    Floats moment_y = columns;
    for (int v = 0; v < patch.rows; ++v, pixels += patch.stride) {
      const float y = patch.top_px + static_cast<float>(v);
      Floats weight = edge - (squared_x + y * y) * slope;
      clamp_to(0.0F, 1.0F, weight);
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
  float along_x = 0.0F;  ///< light above the background times the weight for x
  float along_y = 0.0F;  ///< and for y
  float gain = 0.0F;     ///< change of both sums together, per pixel
  float squares = 0.0F;  ///< sum of both weights' squares
  float shots = 0.0F;    ///< the same times the light
};

template <typename Floats>
[[gnu::always_inline]] inline void sum_edge(const Patch& patch, float squared_radius, float per_width,
                                            float background, EdgeSums& sums) {
  for (int block = 0; block < patch.blocks; ++block) {
    Floats x;
    std::memcpy(&x, steps.data(), sizeof(x));
    x += patch.left_px + static_cast<float>(block * lanes);
    const Floats squared_x = x * x;
    const std::uint8_t* pixels = patch.first + static_cast<std::ptrdiff_t>(block) * lanes;
    Floats columns = Floats{} + 0.0F;
    Floats along_y = columns;
    Floats change = columns;
    Floats squares = columns;
    Floats shots = columns;
    for (int v = 0; v < patch.rows; ++v, pixels += patch.stride) {
      const float y = patch.top_px + static_cast<float>(v);
      Floats light;
      load(pixels, light);
      light = light - background;
      const Floats squared_distance = squared_x + y * y;
      const Floats t = (squared_distance - squared_radius) * per_width;
      Floats inside = 1.0F - t * t;
      clamp_to(0.0F, 1.0F, inside);
      const Floats weight = inside * inside;
      const Floats light_weight = light * weight;
      columns += light_weight;
      along_y += light_weight * y;
      change += (light * inside) * (squared_distance * t);
      const Floats square = weight * weight * squared_distance;
      squares += square;
      shots += square * light;
    }
    sums.along_x += sum_of(columns * x);
    sums.along_y += sum_of(along_y);
    // d(w x)/dx + d(w y)/dy = 2 w + 2 d^2 dw/d(d^2), and dw/d(d^2) = -4 t (1 - t^2) / width
    sums.gain += sum_of(2.0F * columns - (8.0F * per_width) * change);
    sums.squares += sum_of(squares);
    sums.shots += sum_of(shots);
  }
}

#ifdef LODESTAR_SIXTEEN_LANES
LODESTAR_SIXTEEN_LANES
void sum_light_by_sixteen(const Patch& patch, float edge, float slope, float background, LightSums& sums) {
  sum_light<Sixteen>(patch, edge, slope, background, sums);
}
LODESTAR_SIXTEEN_LANES
void sum_edge_by_sixteen(const Patch& patch, float squared_radius, float per_width, float background,
                         EdgeSums& sums) {
  sum_edge<Sixteen>(patch, squared_radius, per_width, background, sums);
}
#endif
LODESTAR_WIDE_REGISTERS
void sum_light_by_eight(const Patch& patch, float edge, float slope, float background, LightSums& sums) {
  sum_light<TwoOfEight>(patch, edge, slope, background, sums);
}
LODESTAR_WIDE_REGISTERS
void sum_edge_by_eight(const Patch& patch, float squared_radius, float per_width, float background,
                       EdgeSums& sums) {
  sum_edge<TwoOfEight>(patch, squared_radius, per_width, background, sums);
}

struct Sums {
  decltype(&sum_light_by_eight) light = sum_light_by_eight;
  decltype(&sum_edge_by_eight) edge = sum_edge_by_eight;
};

/// The fastest variant on this processor. Both give identical results, to the last bit.
const Sums& sums_of_this_processor() {
  static const Sums sums = [] {
    Sums best;
#ifdef LODESTAR_SIXTEEN_LANES
    if (__builtin_cpu_supports("avx512f")) best = {sum_light_by_sixteen, sum_edge_by_sixteen};
#endif
    return best;
  }();
  return sums;
}

}  // namespace

std::optional<DiscLight> light_in_disc(const cv::Mat& gray, const Vec2& center_px, double radius_px,
                                       double background_gray) {
  const double reach = radius_px + 0.5;
  const std::optional<Patch> patch = patch_about(gray, center_px, reach);
  if (!patch) return std::nullopt;
  // Weight 1 at radius - 1/2 and 0 at radius + 1/2, linear in d^2.
  LightSums sums;
  sums_of_this_processor().light(*patch, static_cast<float>(reach * reach * 0.5 / radius_px),
                                 static_cast<float>(0.5 / radius_px), static_cast<float>(background_gray),
                                 sums);
  const double mass = sums.mass;
  DiscLight light{.mass = mass, .center_px = center_px};
  if (mass > 0.0) light.center_px += Vec2(sums.moment_x, sums.moment_y) / mass;
  return light;
}

std::optional<DiscCenter> center_by_edge(const cv::Mat& gray, const Vec2& start_px, double radius_px,
                                         double background_gray, const EdgeOptions& options) {
  const double width = 2.0 * radius_px * options.half_width_px;
  const double squared_radius = radius_px * radius_px;
  const double reach_px = std::sqrt(squared_radius + width);
  DiscCenter center{.center_px = start_px};
  for (int i = 0; i < options.most_steps; ++i) {
    const std::optional<Patch> patch = patch_about(gray, center.center_px, reach_px);
    if (!patch) return std::nullopt;
    EdgeSums sums;
    sums_of_this_processor().edge(*patch, static_cast<float>(squared_radius), static_cast<float>(1.0 / width),
                                  static_cast<float>(background_gray), sums);
    // The sum weighted by w x falls by half the gain as the weight moves by a pixel.
    const double gain = 0.5 * static_cast<double>(sums.gain);
    const Vec2 step = Vec2(sums.along_x, sums.along_y) / gain;
    if (!(gain > 0.0 && step.squaredNorm() < options.longest_step_px * options.longest_step_px))
      return std::nullopt;
    center.center_px += step;
    center.variance_per_variance_px2 = 0.5 * static_cast<double>(sums.squares) / (gain * gain);
    center.variance_per_light_px2 = 0.5 * static_cast<double>(sums.shots) / (gain * gain);
    if (step.squaredNorm() < options.small_step_px * options.small_step_px) break;
  }
  return center;
}

}  // namespace lodestar

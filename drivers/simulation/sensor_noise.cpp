#include "drivers/simulation/sensor_noise.hpp"

#include <algorithm>
#include <cmath>

#include "maps/input_error.hpp"
#include "maps/random.hpp"

// Fixed point, so that eight pixels are processed at once. Products keep their upper 16 bits only:
//   deviation = base + (slope * light >> 16)      in 1/1024 gray, light in 1/64 gray
//   noise     = number * deviation >> 16          in 1/64 gray, number with deviation 2^12
namespace lodestar {
namespace {

enum NoisePurpose : std::uint64_t { numbers = 31, rows_of_frames };

constexpr std::size_t table_size = std::size_t{1} << 17U;
constexpr double one_sigma = 4096.0;
constexpr double deviation_units_per_gray = 65536.0 / one_sigma * LightImage::units_per_gray;

constexpr double slope_units = deviation_units_per_gray / LightImage::units_per_gray * 65536.0;
constexpr double steepest = 32767.0 / slope_units;  // gray of deviation per gray of light

constexpr double most_noise_gray = 15.0;  // the brightest light plus seven sigmas of it still fits 16 bits

std::int16_t upper_half(std::int16_t a, std::int16_t b) {
  return static_cast<std::int16_t>((a * b) >> 16);
}

}  // namespace

SensorNoise::SensorNoise(double read_noise_gray, double shot_noise_gray_at_255, std::uint64_t seed)
    : seed_(seed), tangents_(tangents_of(read_noise_gray, shot_noise_gray_at_255)), noise_(table_size) {
  Random random = Random(seed).stream(numbers);
  constexpr double farthest = 7.0;  // sigmas that fit 16 bits
  for (std::int16_t& number : noise_) {
    number =
        static_cast<std::int16_t>(std::lrint(one_sigma * std::clamp(random.normal(), -farthest, farthest)));
  }
}

std::array<SensorNoise::Tangent, SensorNoise::tangent_count> SensorNoise::tangents_of(
    double read_noise_gray, double shot_noise_gray_at_255) {
  // The curve is concave, so the minimum of several tangents lies just above it. With d the deviation, the
  // tangent at d_i exceeds it by (d - d_i)^2 / (2 d d_i) of itself: touching points at even ratios are best.
  const double shot2_per_gray = shot_noise_gray_at_255 * shot_noise_gray_at_255 / 255.0;
  const double read2 = read_noise_gray * read_noise_gray;
  const double lowest = std::sqrt(read2 + shot2_per_gray);  // at one gray level, to keep the slope finite
  const double highest = std::sqrt(read2 + 255.0 * shot2_per_gray);
  if (!(highest <= most_noise_gray)) throw InputError("simulated camera: more than 15 gray levels of noise");
  std::array<Tangent, tangent_count> tangents;
  for (std::size_t i = 0; i < tangents.size(); ++i) {
    const double place = (static_cast<double>(i) + 0.5) / tangent_count;
    // Where the curve is too steep for 16 bits, the deviation is a fraction of a gray level and negligible.
    const double wanted = lowest > 0.0 ? lowest * std::pow(highest / lowest, place) : 0.0;
    const double deviation = std::max(wanted, shot2_per_gray / (2.0 * steepest));
    const double slope = deviation > 0.0 ? shot2_per_gray / (2.0 * deviation) : 0.0;
    const double base = deviation > 0.0 ? (deviation * deviation + read2) / (2.0 * deviation) : 0.0;
    const auto fixed = [](double value) {
      return static_cast<std::int16_t>(std::clamp(std::lrint(value), 0L, 32767L));
    };
    tangents[i] = {fixed(base * deviation_units_per_gray), fixed(slope * slope_units)};
  }
  return tangents;
}

cv::Mat SensorNoise::expose(const LightImage& light, std::uint64_t frame_number) const {
  cv::Mat gray(light.height_px(), light.width_px(), CV_8UC1);
  Random random = Random(seed_).stream(rows_of_frames).stream(frame_number);
  const auto width = static_cast<std::size_t>(light.width_px());
  for (int v = 0; v < light.height_px(); ++v) {
    const std::size_t place = random.below(table_size - width);
    expose_row(light.row(v), noise_.data() + place, light.width_px(), gray.ptr<std::uint8_t>(v));
  }
  return gray;
}

void SensorNoise::expose_row(const std::int16_t* light, const std::int16_t* noise, int width,
                             std::uint8_t* gray) const {
  const std::array<Tangent, tangent_count> t = tangents_;
  const auto along = [](Tangent tangent, std::int16_t units) {
    return static_cast<std::int16_t>(tangent.base + upper_half(tangent.slope, units));
  };
  constexpr int half_gray = LightImage::units_per_gray / 2;
  for (int u = 0; u < width; ++u) {
    const std::int16_t units = light[u];
    const std::int16_t deviation = std::min(std::min(along(t[0], units), along(t[1], units)),
                                            std::min(along(t[2], units), along(t[3], units)));
    const auto noisy = static_cast<std::int16_t>(units + upper_half(noise[u], deviation) + half_gray);
    const auto level = static_cast<std::int16_t>(noisy >> 6);
    gray[u] = static_cast<std::uint8_t>(std::clamp<std::int16_t>(level, 0, 255));
  }
}

}  // namespace lodestar

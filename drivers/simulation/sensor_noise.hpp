#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "drivers/simulation/light_image.hpp"

namespace lodestar {

/// Sensor model: read noise and shot noise with standard deviation sqrt(read^2 + shot^2 g / 255) at gray g,
/// then 8 bits with saturation. Gaussian numbers come from a table of 2^17, read from a random position in
/// every row of every frame.
class SensorNoise {
 public:
  SensorNoise(double read_noise_gray, double shot_noise_gray_at_255, std::uint64_t seed);

  /// The frame (CV_8UC1) with this number.
  [[nodiscard]] cv::Mat expose(const LightImage& light, std::uint64_t frame_number) const;

 private:
  /// Deviation as a function of light: base + slope * light.
  struct Tangent {
    std::int16_t base = 0;
    std::int16_t slope = 0;
  };
  static constexpr int tangent_count = 4;

  static std::array<Tangent, tangent_count> tangents_of(double read_noise_gray,
                                                        double shot_noise_gray_at_255);
  void expose_row(const std::int16_t* light, const std::int16_t* noise, int width, std::uint8_t* gray) const;

  std::uint64_t seed_;
  std::array<Tangent, tangent_count> tangents_;
  std::vector<std::int16_t> noise_;
};

}  // namespace lodestar

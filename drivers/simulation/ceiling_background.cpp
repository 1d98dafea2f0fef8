#include "drivers/simulation/ceiling_background.hpp"

#include <algorithm>

#include "drivers/simulation/ceiling_light.hpp"

namespace lodestar {
namespace {

constexpr int cell_bits = 3;
constexpr int cell = 1 << cell_bits;  // side of a coarse cell, in samples of the half-size image
constexpr int light_bits = 8;  // nodes hold light in 1/256 of LightImage's unit, to be stepped along rows
constexpr double light_scale = LightImage::units_per_gray << light_bits;

constexpr double strongest_texture_gray = 30.0;  // such that texture on white still fits 16 bits

std::size_t index(int value) {
  return static_cast<std::size_t>(value);
}

/// One eighth of the way from one end to the other; coordinates wrap, so their difference is taken as signed.
std::int32_t eighth(std::uint32_t from, std::uint32_t to) {
  return static_cast<std::int32_t>(to - from) >> cell_bits;
}
std::int32_t eighth(std::int32_t from, std::int32_t to) {
  return (to - from) >> cell_bits;
}

/// A quarter of the way from a to b. The background stays below 400 gray, so the difference fits 16 bits;
/// with that type, eight pixels fit one register.
std::int16_t quarter_towards(std::int16_t a, std::int16_t b) {
  const auto difference = static_cast<std::int16_t>(b - a);
  return static_cast<std::int16_t>(a + static_cast<std::int16_t>(difference >> 2));
}

}  // namespace

CeilingBackground::CeilingBackground(const CameraModel& camera, const Vignetting& vignetting,
                                     double background_gray, double texture_gray, std::uint64_t seed)
    : background_gray_(background_gray),
      texture_gray_(std::min(texture_gray, strongest_texture_gray)),
      texture_(seed),
      half_width_((camera.width_px + 1) / 2),
      half_height_((camera.height_px + 1) / 2),
      node_columns_((half_width_ + cell - 1) / cell + 1),
      half_stride_(cell * (node_columns_ - 1)) {
  const int node_rows = (half_height_ + cell - 1) / cell + 1;
  for (int row = 0; row < node_rows; ++row) {
    for (int column = 0; column < node_columns_; ++column) {
      // A sample of the half-size image lies at the centre of 2 x 2 pixels.
      const Vec2 pixel(2.0 * cell * column + 0.5, 2.0 * cell * row + 0.5);
      rays_.push_back(ray_through(pixel, camera));
      falloff_.push_back(vignetting.at(pixel));
    }
  }
  nodes_.resize(rays_.size());
  half_.resize(index(half_stride_) * index(half_height_));
}

void CeilingBackground::paint(const Ceiling& ceiling, const Eigen::Isometry3d& map_from_camera,
                              LightImage& image) {
  look_at_nodes(ceiling, map_from_camera);
  sample_half_size();
  enlarge(image);
}

void CeilingBackground::look_at_nodes(const Ceiling& ceiling, const Eigen::Isometry3d& map_from_camera) {
  const Vec3 from = map_from_camera.translation();
  const auto point_seen = [&](std::size_t i) {
    return meet_ceiling(from, map_from_camera.linear() * rays_[i], ceiling.height_m);
  };
  const Vec2 middle = 0.5 * (point_seen(0) + point_seen(nodes_.size() - 1));
  const Ceiling lights = lights_near(ceiling, middle, (point_seen(0) - middle).norm());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Vec2 point = point_seen(i);
    const double gray = std::clamp(background_gray_ + glow_of_lights(lights, point), 0.0, 255.0);
    const Vec2 from_corner = point - ceiling.tile_corner_m;
    nodes_[i] = {CeilingTexture::wrapped(from_corner.x()), CeilingTexture::wrapped(from_corner.y()),
                 static_cast<std::int32_t>(gray * falloff_[i] * light_scale),
                 static_cast<std::int32_t>(texture_gray_ * falloff_[i] * light_scale /
                                           CeilingTexture::units_per_amplitude)};
  }
}

void CeilingBackground::sample_half_size() {
  for (int row = 0; row < half_height_; ++row) sample_half_row(row);
}

void CeilingBackground::sample_half_row(int row) {
  const int down = row % cell;
  const Node* above = nodes_.data() + index(row / cell) * index(node_columns_);
  const Node* below = above + node_columns_;
  // Values on the left and right edge of each cell in this row.
  const auto node_at = [&](int column) {
    const Node& a = above[column];
    const Node& b = below[column];
    return Node{a.x + static_cast<std::uint32_t>(eighth(a.x, b.x) * down),
                a.y + static_cast<std::uint32_t>(eighth(a.y, b.y) * down),
                a.light + eighth(a.light, b.light) * down, a.texture + eighth(a.texture, b.texture) * down};
  };
  std::int16_t* out = half_.data() + index(row) * index(half_stride_);
  Node right = node_at(0);
  for (int column = 1; column < node_columns_; ++column, out += cell) {
    Node here = right;
    right = node_at(column);
    const auto step_x = static_cast<std::uint32_t>(eighth(here.x, right.x));
    const auto step_y = static_cast<std::uint32_t>(eighth(here.y, right.y));
    const std::int32_t step_light = eighth(here.light, right.light);
    for (int i = 0; i < cell; ++i) {
      const std::int32_t light = here.light + here.texture * texture_.at(here.x, here.y);
      out[i] = static_cast<std::int16_t>(std::max(light, 0) >> light_bits);
      here.x += step_x;
      here.y += step_y;
      here.light += step_light;
    }
  }
}

void CeilingBackground::enlarge(LightImage& image) const {
  // A pixel lies a quarter of the sample spacing from the nearest sample: bilinear weights 3/4 and 1/4 in
  // both directions.
  std::vector<std::int16_t> mixed(index(half_width_) + 2);  // one row, with a repeated sample at either end
  std::int16_t* mix = mixed.data() + 1;
  for (int v = 0; v < image.height_px(); ++v) {
    const int nearest = v / 2;
    const int next = std::clamp(v % 2 == 0 ? nearest - 1 : nearest + 1, 0, half_height_ - 1);
    const std::int16_t* a = half_.data() + index(nearest) * index(half_stride_);
    const std::int16_t* b = half_.data() + index(next) * index(half_stride_);
    for (int i = 0; i < half_width_; ++i) mix[i] = quarter_towards(a[i], b[i]);
    mix[-1] = mix[0];
    mix[half_width_] = mix[half_width_ - 1];
    std::int16_t* out = image.row(v);
    for (int i = 0; i < half_width_; ++i) {
      out[2 * i] = quarter_towards(mix[i], mix[i - 1]);
      out[2 * i + 1] = quarter_towards(mix[i], mix[i + 1]);
    }
  }
}

}  // namespace lodestar

#include "localization/detection/joint_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "maps/median.hpp"

namespace lodestar {
namespace {

/// All pixels within reach of any start; none when the frame's border cuts them.
void collect_pixels(const cv::Mat& gray, std::span<const Vec2> starts_px, double reach_px,
                    std::vector<GrayPixel>& pixels) {
  pixels.clear();
  Vec2 low = starts_px.front();
  Vec2 high = low;
  for (const Vec2& start : starts_px) {
    low = low.cwiseMin(start);
    high = high.cwiseMax(start);
  }
  const auto left = static_cast<int>(std::ceil(low.x() - reach_px));
  const auto top = static_cast<int>(std::ceil(low.y() - reach_px));
  if (left < 0 || top < 0 || high.x() + reach_px >= gray.cols || high.y() + reach_px >= gray.rows) return;
  for (int v = top; v <= high.y() + reach_px; ++v) {
    for (int u = left; u <= high.x() + reach_px; ++u) {
      const Vec2 place(u, v);
      const bool near = std::ranges::any_of(
          starts_px, [&](const Vec2& start) { return (start - place).squaredNorm() < reach_px * reach_px; });
      if (near) pixels.push_back({place, static_cast<double>(gray.ptr<std::uint8_t>(v)[u])});
    }
  }
}

constexpr int per_dot = 3;  // x, y, height; the width and the background come last
constexpr int most_unknowns = per_dot * static_cast<int>(most_joint_dots) + 2;

using State = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_unknowns, 1>;
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_unknowns, most_unknowns>;

/// Normal equations of one step, and the sum of squared residuals.
struct Normal {
  Square matrix;
  State right;
  double squares = 0.0;
};

Normal normal_of(std::span<const GrayPixel> pixels, const State& state) {
  const Eigen::Index width_at = state.size() - 2;
  const Eigen::Index background_at = state.size() - 1;
  const double width = state[width_at];
  const double least_exponent = -8.0;  // four sigmas
  Normal normal{Square::Zero(state.size(), state.size()), State::Zero(state.size())};
  State slope(state.size());
  InlineVector<Eigen::Index, most_unknowns> near;
  for (const GrayPixel& pixel : pixels) {
    double expected = state[background_at];
    slope.setZero();
    near.clear();
    for (Eigen::Index i = 0; i < width_at; i += per_dot) {
      const Vec2 off = pixel.place_px - state.segment<2>(i);
      const double exponent = -0.5 * off.squaredNorm() / (width * width);
      if (exponent < least_exponent) continue;
      const double shape = std::exp(exponent);
      const double light = state[i + 2] * shape;
      expected += light;
      slope.segment<2>(i) = light / (width * width) * off;
      slope[i + 2] = shape;
      slope[width_at] += light * off.squaredNorm() / (width * width * width);
      for (Eigen::Index k = i; k < i + per_dot; ++k) near.push_back(k);
    }
    slope[background_at] = 1.0;
    near.push_back(width_at);
    near.push_back(background_at);
    const double residual = pixel.gray - expected;
    normal.squares += residual * residual;
    for (const Eigen::Index row : near) {
      normal.right[row] += slope[row] * residual;
      for (const Eigen::Index column : near) normal.matrix(row, column) += slope[row] * slope[column];
    }
  }
  return normal;
}

/// Levenberg and Marquardt; the state at the least squares, with its normal equations.
Normal descend(std::span<const GrayPixel> pixels, State& state, int most_iterations) {
  constexpr double small_step_px = 0.003;
  constexpr double narrowest_px = 0.5;
  double damping = 1e-2;
  Normal normal = normal_of(pixels, state);
  for (int i = 0; i < most_iterations; ++i) {
    Square damped = normal.matrix;
    damped.diagonal() *= 1.0 + damping;
    const State step = damped.ldlt().solve(normal.right);
    State next = state + step;
    Eigen::Index const width_at = state.size() - 2;
    next[width_at] = std::max(next[width_at], narrowest_px);
    Normal at_next = normal_of(pixels, next);
    if (!(at_next.squares < normal.squares)) {
      damping *= 8.0;
      continue;
    }
    damping *= 0.2;
    state = std::move(next);
    normal = std::move(at_next);
    double longest_px = 0.0;
    for (Eigen::Index k = 0; k < width_at; k += per_dot)
      longest_px = std::max(longest_px, step.segment<2>(k).norm());
    if (longest_px < small_step_px) break;
  }
  return normal;
}

double median_height(const State& state) {
  InlineVector<double, most_joint_dots> heights;
  for (Eigen::Index i = 0; i < state.size() - 2; i += per_dot) heights.push_back(state[i + 2]);
  return median_in_place({heights.data(), heights.size()});
}

}  // namespace

FittedDots JointFit::fit(const cv::Mat& gray, std::span<const Vec2> starts_px, const DotLight& light) {
  if (starts_px.empty() || starts_px.size() > most_joint_dots) return {};
  collect_pixels(gray, starts_px, options_.reach_sigmas * light.width_px, pixels_);
  const auto dots = static_cast<Eigen::Index>(starts_px.size());
  State state(per_dot * dots + 2);
  if (static_cast<Eigen::Index>(pixels_.size()) < 2 * state.size()) return {};
  for (Eigen::Index i = 0; i < dots; ++i) {
    const Vec2& start = starts_px[static_cast<std::size_t>(i)];
    const double here =
        gray.ptr<std::uint8_t>(static_cast<int>(std::lround(start.y())))[std::lround(start.x())];
    state.segment<2>(per_dot * i) = start;
    state[per_dot * i + 2] = here - light.background_gray;
  }
  state.tail<2>() << light.width_px, light.background_gray;
  const Normal normal = descend(pixels_, state, options_.most_iterations);
  const double height = median_height(state);
  const double freedom = static_cast<double>(pixels_.size()) - static_cast<double>(state.size());
  const double residual2 = normal.squares / freedom;
  if (!state.allFinite() || !(height > 0.0) || residual2 > square(options_.most_error * height)) return {};
  // Pixels as noisy as they are, or as badly explained.
  const double variance =
      std::max(square(light.noise_gray) + 0.5 * light.variance_per_gray * height, residual2);
  const Square covariance = normal.matrix.ldlt().solve(Square::Identity(state.size(), state.size()));
  FittedDots result{
      .dots = {}, .width_px = state[state.size() - 2], .background_gray = state[state.size() - 1]};
  for (Eigen::Index i = 0; i < dots; ++i) {
    const Eigen::Index at = per_dot * i;
    const Vec2 center = state.segment<2>(at);
    if (state[at + 2] < options_.least_share * height) continue;
    if ((center - starts_px[static_cast<std::size_t>(i)]).norm() > result.width_px) return {};
    result.dots.push_back({static_cast<std::size_t>(i), center,
                           std::sqrt(0.5 * variance * (covariance(at, at) + covariance(at + 1, at + 1))),
                           state[at + 2]});
  }
  return result;
}

}  // namespace lodestar

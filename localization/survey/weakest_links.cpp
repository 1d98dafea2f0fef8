#include "localization/survey/weakest_links.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

#include "localization/survey/rigid_motion.hpp"

namespace lodestar {
namespace {

constexpr std::size_t neighbours = 4;

Vec2 xy(const MarkerSurvey& survey, std::size_t marker) {
  return survey.markers[marker].position_m.head<2>();
}

std::vector<std::size_t> nearest_to(const MarkerSurvey& survey, std::size_t marker) {
  std::vector<std::size_t> others(survey.markers.size());
  std::iota(others.begin(), others.end(), 0U);
  std::erase(others, marker);
  const auto kept = static_cast<std::ptrdiff_t>(std::min(neighbours, others.size()));
  std::ranges::partial_sort(others, others.begin() + kept, {}, [&](std::size_t other) {
    return (xy(survey, other) - xy(survey, marker)).squaredNorm();
  });
  others.resize(static_cast<std::size_t>(kept));
  return others;
}

double relative_sigma_m(const Eigen::MatrixXd& covariance, std::size_t first, std::size_t second) {
  const auto block = [&](std::size_t a, std::size_t b) {
    return covariance.block<2, 2>(3 * static_cast<Eigen::Index>(a), 3 * static_cast<Eigen::Index>(b));
  };
  const Eigen::Matrix2d relative =
      block(first, first) + block(second, second) - block(first, second) - block(second, first);
  return larger_sigma(relative);
}

}  // namespace

std::vector<MarkerLink> weakest_links(const MarkerSurvey& survey) {
  const auto rows = 3 * static_cast<Eigen::Index>(survey.markers.size());
  std::vector<MarkerLink> links;
  if (rows == 0 || survey.covariance.rows() != rows) return links;
  // Of the shape: a turn of the registry as a whole moves no marker as seen from another.
  const Eigen::MatrixXd covariance = shape_covariance(survey.markers, survey.covariance);
  for (std::size_t marker = 0; marker < survey.markers.size(); ++marker) {
    for (const std::size_t other : nearest_to(survey, marker)) {
      const auto is_other_way = [&](const MarkerLink& link) {
        return link.first == survey.markers[other].id && link.second == survey.markers[marker].id;
      };
      if (std::ranges::any_of(links, is_other_way)) continue;
      links.push_back({.first = survey.markers[marker].id,
                       .second = survey.markers[other].id,
                       .sigma_m = relative_sigma_m(covariance, marker, other),
                       .between_m = 0.5 * (xy(survey, marker) + xy(survey, other))});
    }
  }
  std::ranges::sort(links, std::greater(), &MarkerLink::sigma_m);
  return links;
}

}  // namespace lodestar

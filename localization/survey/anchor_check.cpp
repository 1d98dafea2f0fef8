#include "localization/survey/anchor_check.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "localization/survey/redundancy.hpp"
#include "maps/chi_square.hpp"

namespace lodestar {

bool holds(const Anchors& anchors) {
  return std::ranges::any_of(anchors.anchors, [](const Anchor& anchor) {
    return !std::holds_alternative<DistanceAnchor>(anchor.what);
  });
}

namespace {

std::string in_words(const Anchor& anchor) {
  return fmt::format("{} (line {})", to_string(anchor), anchor.line);
}

/// Numbers that anchors give beyond the three that place and turn the registry.
int spare_numbers(const SurveyProblem& problem, const SurveyBundle& bundle) {
  int numbers = 0;
  for (const ResidualSum& sum : bundle.sums_by_anchor()) numbers += sum.count;
  return numbers - (holds(problem.anchors) ? 3 : 0);
}

double sigma_of(const Anchor& anchor) {
  return std::visit([](const auto& what) { return what.sigma_m; }, anchor.what);
}

}  // namespace

SurveyFit fit_of_anchors(const SurveyProblem& problem, const SurveyBundle& bundle, double chi2_without) {
  return {bundle.chi2() - chi2_without, static_cast<double>(spare_numbers(problem, bundle))};
}

std::optional<SurveyRefusal> false_anchor(const SurveyProblem& problem, const SurveyBundle& bundle,
                                          const SurveyFit& fit) {
  const int spare = spare_numbers(problem, bundle);
  if (spare <= 0 || fit.chi2 <= chi_square_quantile(1.0 - problem.options.least_probability, spare))
    return std::nullopt;
  double worst = 0.0;
  std::string culprit;
  const std::vector<ResidualSum> sums = bundle.sums_by_anchor();
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (sums[i].chi2 / sums[i].count <= worst) continue;
    worst = sums[i].chi2 / sums[i].count;
    culprit = in_words(problem.anchors.anchors[problem.placed[i].anchor]);
  }
  return SurveyRefusal{
      SurveyFlaw::anchors_contradict,
      fmt::format("anchors and survey are apart by chi2 {:.1f} for {} spare numbers; the farthest is {}, off "
                  "by {:.1f} sigmas",
                  fit.chi2, spare, culprit, std::sqrt(worst))};
}

void check_anchors(const SurveyProblem& problem, const SurveyBundle& bundle,
                   const std::vector<double>& redundancies, MarkerSurvey& survey) {
  const int spare = spare_numbers(problem, bundle);
  const double probability = problem.options.least_probability;
  for (std::size_t i = 0; i < redundancies.size(); ++i) {
    const Anchor& anchor = problem.anchors.anchors[problem.placed[i].anchor];
    survey.anchor_checks.push_back(
        {in_words(anchor), sigma_of(anchor) * least_noticeable(redundancies[i], probability, spare)});
  }
  // The test ran before the misfit widened any sigma: its sigmas are those that people gave.
  const double believed = problem.anchors.print_scale.sigma;
  const double left = survey.print_scale_sigma / (std::sqrt(survey.gauge_factor) * believed);
  survey.noticeable_print_scale = believed * least_noticeable(1.0 - square(left), probability, spare);
}

}  // namespace lodestar

#include "localization/survey/anchor_check.hpp"

#include <cmath>
#include <fmt/format.h>

#include "localization/survey/redundancy.hpp"
#include "maps/chi_square.hpp"

namespace lodestar {
namespace {

std::string in_words(const Anchor& anchor) {
  return fmt::format("{} (line {})", to_string(anchor), anchor.line);
}

double sigma_of(const Anchor& anchor) {
  return std::visit([](const auto& what) { return what.sigma_m; }, anchor.what);
}

}  // namespace

std::optional<SurveyRefusal> false_anchor(const SurveyProblem& problem, const SurveyBundle& bundle,
                                          double cost) {
  int equations = 0;
  double worst = 0.0;
  std::string culprit;
  const std::vector<ResidualSum> sums = bundle.sums_by_anchor();
  for (std::size_t i = 0; i < sums.size(); ++i) {
    equations += sums[i].count;
    if (sums[i].chi2 / sums[i].count <= worst) continue;
    worst = sums[i].chi2 / sums[i].count;
    const Anchor& anchor = problem.anchors.anchors[problem.placed[i].anchor];
    culprit = in_words(anchor);
  }
  if (equations == 0) return std::nullopt;
  if (cost <= chi_square_quantile(1.0 - problem.options.least_probability, equations)) return std::nullopt;
  return SurveyRefusal{
      SurveyFlaw::anchors_contradict,
      fmt::format("anchors and survey are apart by chi2 {:.1f} for {} numbers; the farthest is {}, off by "
                  "{:.1f} sigmas",
                  cost, equations, culprit, std::sqrt(worst))};
}

void check_anchors(const SurveyProblem& problem, const SurveyBundle& bundle,
                   const std::vector<double>& redundancies, MarkerSurvey& survey) {
  int numbers = 0;
  for (const ResidualSum& sum : bundle.sums_by_anchor()) numbers += sum.count;
  const double probability = problem.options.least_probability;
  for (std::size_t i = 0; i < redundancies.size(); ++i) {
    const Anchor& anchor = problem.anchors.anchors[problem.placed[i].anchor];
    survey.anchor_checks.push_back(
        {in_words(anchor), sigma_of(anchor) * least_noticeable(redundancies[i], probability, numbers)});
  }
  const double believed = problem.anchors.print_scale.sigma;
  survey.noticeable_print_scale =
      believed * least_noticeable(1.0 - square(survey.print_scale_sigma / believed), probability, numbers);
}

}  // namespace lodestar

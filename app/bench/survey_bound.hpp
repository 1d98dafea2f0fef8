#pragma once

#include <optional>

#include "app/bench/survey_world.hpp"
#include "maps/anchors.hpp"

namespace lodestar {

/// The RMS of horizontal errors that no unbiased survey of this drive stays below (Cramer 1946, Rao 1945;
/// with priors: van Trees 1968): the inverse Fisher information of the same keyframes at the true state, with
/// the sigmas that the world was drawn with. Without anchors that hold it, of the shape. Nothing where that
/// does not determine the registry.
std::optional<double> survey_bound_m(const SurveyWorld& world, const SurveyDrive& drive,
                                     const Anchors& anchors, const SurveyOptions& options);

}  // namespace lodestar

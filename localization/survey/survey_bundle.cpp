#include "localization/survey/survey_bundle.hpp"

#include <algorithm>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <cmath>

#include "localization/survey/inverse_variance.hpp"
#include "localization/survey/normal_inverse.hpp"
#include "localization/survey/redundancy.hpp"
#include "localization/survey/rigid_motion.hpp"
#include "localization/survey/survey_costs.hpp"
#include "maps/median.hpp"

namespace lodestar {
namespace {

using Block = ceres::ResidualBlockId;

Eigen::VectorXd all(double value, Eigen::Index count) {
  return Eigen::VectorXd::Constant(count, value);
}

ceres::Problem::Options keeping_losses() {
  ceres::Problem::Options options;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  return options;
}

}  // namespace

struct SurveyBundle::Ceres {
  ceres::Problem problem{keeping_losses()};
  InverseVariance dots_factor;
  InverseVariance wheels_factor;
  InverseVariance ceiling_factor;
  InverseVariance gauge_factor;
  std::vector<std::vector<Block>> dots;  ///< of each keyframe's sightings
  std::vector<Block> wheels;
  std::vector<Block> ceiling;
  std::vector<Block> anchors;  ///< of each placed one, once they are added
  Block gauge = nullptr;
  int freedom = 0;  ///< residuals less unknowns

  /// Weighted, block by block.
  [[nodiscard]] std::vector<ResidualSum> sums_of(const std::vector<Block>& blocks) {
    ceres::Problem::EvaluateOptions options;
    options.residual_blocks = blocks;
    std::vector<double> residuals;
    if (blocks.empty() || !problem.Evaluate(options, nullptr, &residuals, nullptr, nullptr)) return {};
    std::vector<ResidualSum> sums;
    const double* next = residuals.data();
    for (const Block block : blocks) {
      const int count = problem.GetCostFunctionForResidualBlock(block)->num_residuals();
      sums.push_back({Eigen::Map<const Eigen::VectorXd>(next, count).squaredNorm(), count});
      next += count;
    }
    return sums;
  }
  [[nodiscard]] ResidualSum sum_of(const std::vector<Block>& blocks) {
    ResidualSum all;
    for (const ResidualSum& sum : sums_of(blocks)) {
      all.chi2 += sum.chi2;
      all.count += sum.count;
    }
    return all;
  }
  [[nodiscard]] Eigen::SparseMatrix<double, Eigen::RowMajor> jacobian(
      const ceres::Problem::EvaluateOptions& options) {
    ceres::CRSMatrix rows;
    problem.Evaluate(options, nullptr, nullptr, nullptr, &rows);
    return Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>>(
        rows.num_rows, rows.num_cols, static_cast<Eigen::Index>(rows.values.size()), rows.rows.data(),
        rows.cols.data(), rows.values.data());
  }
  [[nodiscard]] std::vector<Block> all_dots() const {
    std::vector<Block> blocks;
    for (const std::vector<Block>& of_frame : dots)
      blocks.insert(blocks.end(), of_frame.begin(), of_frame.end());
    return blocks;
  }
};

SurveyBundle::SurveyBundle(const SurveyProblem& problem, SurveyUnknowns unknowns)
    : problem_(problem), unknowns_(std::move(unknowns)), ceres_(std::make_unique<Ceres>()) {
  add_dots();
  add_wheels();
  add_ceiling();
  add_beliefs();
  // Something must hold the registry where no anchor does; how well shows nowhere else.
  hold(1e-3);
}

SurveyBundle::~SurveyBundle() = default;

void SurveyBundle::add_dots() {
  SurveyState& state = unknowns_.state;
  const std::vector<SurveyKeyframe>& frames = problem_.keyframes.frames;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    std::vector<Block>& dots = ceres_->dots.emplace_back();
    for (const KeyframeSighting& sighting : frames[i].sightings) {
      const std::size_t m = sighting.marker;
      dots.push_back(ceres_->problem.AddResidualBlock(
          new DotsOfSighting(sighting, unknowns_.cells[m], problem_.camera, problem_.belief,
                             problem_.options),
          &ceres_->dots_factor, state.places[i].data(), state.markers[m].data(), state.mount_m.data(),
          state.mount_turn_rad.data(), state.scale_and_k1.data(), state.dot_offsets_m[m].data()));
    }
  }
}

void SurveyBundle::add_wheels() {
  SurveyState& state = unknowns_.state;
  const std::vector<SurveyKeyframe>& frames = problem_.keyframes.frames;
  const WheelGauge gauge{.difference = state.wheels[1], .track_m = state.wheels[2]};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!frames[i].from_previous) continue;
    ceres_->wheels.push_back(ceres_->problem.AddResidualBlock(
        new WheelsBetween(*frames[i].from_previous, gauge, problem_.belief.wheels), &ceres_->wheels_factor,
        state.places[i - 1].data(), state.places[i].data(), state.wheels.data()));
  }
}

void SurveyBundle::add_ceiling() {
  SurveyState& state = unknowns_.state;
  const std::vector<SurveyKeyframe>& frames = problem_.keyframes.frames;
  const Vec3& believed_m = problem_.belief.base_from_camera.translation();
  std::vector<double> heights_m;
  for (const SurveyState::Marker& marker : state.markers) heights_m.push_back(marker.z());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!frames[i].by_ceiling) continue;
    ceres_->ceiling.push_back(ceres_->problem.AddResidualBlock(
        new CeilingBetween(*frames[i].by_ceiling, believed_m, median(heights_m)), &ceres_->ceiling_factor,
        state.places[i - 1].data(), state.places[i].data(), state.ceiling.data(), state.mount_m.data(),
        state.mount_turn_rad.data(), state.scale_and_k1.data()));
  }
}

void SurveyBundle::add_beliefs() {
  SurveyState& state = unknowns_.state;
  const SurveyOptions& options = problem_.options;
  ceres::Problem& ceres = ceres_->problem;
  const auto near = [&ceres](auto& block, int first, const Eigen::VectorXd& mean,
                             const Eigen::VectorXd& sigmas, ceres::LossFunction* factor = nullptr) {
    ceres.AddResidualBlock(new Near(static_cast<int>(block.size()), first, mean, sigmas), factor,
                           block.data());
  };
  for (SurveyState::Place& place : state.places)
    near(place, 3, Vec2::Zero(), all(problem_.belief.lean_sigma_rad, 2));
  for (std::size_t m = 0; m < state.markers.size(); ++m) {
    near(state.markers[m], 4, Vec2::Zero(), all(options.marker_tilt_sigma_rad, 2));
    const Eigen::Index offsets = state.dot_offsets_m[m].size();
    near(state.dot_offsets_m[m], 0, all(0.0, offsets), all(options.dot_place_sigma_m, offsets));
  }
  const Vec3 mount_sigmas_m = Vec3::Constant(options.mount_sigma_m);
  near(state.mount_m, 0, problem_.belief.base_from_camera.translation(), mount_sigmas_m);
  near(state.mount_turn_rad, 0, Vec3::Zero(),
       Vec3(options.mount_tilt_sigma_rad, options.mount_tilt_sigma_rad, options.mount_yaw_sigma_rad));
  const PrintScale& print = problem_.anchors.print_scale;
  near(state.scale_and_k1, 0, all(print.scale, 1), all(print.sigma, 1), &ceres_->gauge_factor);
  near(state.scale_and_k1, 1, all(0.0, 1), all(options.lens_sigma, 1));
  if (!ceres_->ceiling.empty()) near(state.ceiling, 0, all(1.0, 1), all(options.ceiling_sigma, 1));
  const double track_m = problem_.belief.track_width_m;
  near(state.wheels, 0, Vec3(1.0, 0.0, track_m), options.wheel_sigma * Vec3(1.0, 1.0, track_m));
}

Pose2 SurveyBundle::anchored_from_now() const {
  const SurveyState& state = unknowns_.state;
  std::vector<PointPair> pairs;
  Vec2 turns = Vec2::Zero();
  const auto take = [&](const Pose2& at, const Vec2& position_m, const std::optional<AnchorYaw>& yaw) {
    pairs.push_back({at.position_m, position_m});
    if (yaw) turns += Eigen::Rotation2Dd(yaw->yaw_rad - at.yaw_rad) * Vec2::UnitX();
  };
  for (const PlacedAnchor& placed : problem_.placed) {
    const auto& what = problem_.anchors.anchors[placed.anchor].what;
    if (const auto* const m = std::get_if<MarkerAnchor>(&what)) {
      const SurveyState::Marker& marker = state.markers[marker_index(m->id)];
      take({marker.head<2>(), marker[3]}, m->position_m, m->yaw);
    } else if (const auto* const r = std::get_if<RobotAnchor>(&what)) {
      const SurveyState::Place& place = state.places[placed.keyframe];
      take(Pose2{place.head<2>(), place[2]} * placed.keyframe_from_robot, r->position_m, r->yaw);
    }
  }
  if (pairs.empty()) return {};
  return best_rigid_motion(pairs, turns.norm() > 0.0 ? heading_of(turns) : 0.0);
}

void SurveyBundle::place_registry() {
  const Pose2 move = anchored_from_now();
  const auto moved = [&move](auto& block, int yaw_at) {
    const Pose2 pose = move * Pose2{block.template head<2>(), block[yaw_at]};
    block.template head<2>() = pose.position_m;
    block[yaw_at] = pose.yaw_rad;
  };
  for (SurveyState::Place& place : unknowns_.state.places) moved(place, 2);
  for (SurveyState::Marker& marker : unknowns_.state.markers) moved(marker, 3);
  hold(1e-3);
}

void SurveyBundle::add_anchors() {
  SurveyState& state = unknowns_.state;
  const auto marker = [&](int id) { return state.markers[marker_index(id)].data(); };
  ceres::LossFunction* const factor = &ceres_->gauge_factor;
  bool holds = false;
  for (const PlacedAnchor& placed : problem_.placed) {
    const auto& what = problem_.anchors.anchors[placed.anchor].what;
    Block block = nullptr;
    if (const auto* const m = std::get_if<MarkerAnchor>(&what)) {
      holds = true;
      block = ceres_->problem.AddResidualBlock(new PoseNear({m->position_m, m->sigma_m, m->yaw, {}}, 6, 3),
                                               factor, marker(m->id));
    } else if (const auto* const r = std::get_if<RobotAnchor>(&what)) {
      holds = true;
      block = ceres_->problem.AddResidualBlock(
          new PoseNear({r->position_m, r->sigma_m, r->yaw, placed.keyframe_from_robot}, 5, 2), factor,
          state.places[placed.keyframe].data());
    } else if (const auto* const d = std::get_if<DistanceAnchor>(&what)) {
      block = ceres_->problem.AddResidualBlock(new MarkersApart(d->distance_m, d->sigma_m), factor,
                                               marker(d->first), marker(d->second));
    }
    ceres_->anchors.push_back(block);
  }
  // Without its hold the registry may turn and move as a whole; where anchors fix too little of that, sigmas
  // say so.
  constexpr double anywhere_m = 1e3;
  if (holds) hold(anywhere_m);
}

/// Holds the first keyframe where it is, as well as said.
void SurveyBundle::hold(double sigma) {
  if (ceres_->gauge != nullptr) ceres_->problem.RemoveResidualBlock(ceres_->gauge);
  SurveyState::Place& first = unknowns_.state.places.front();
  ceres_->gauge =
      ceres_->problem.AddResidualBlock(new Near(5, 0, first.head<3>(), all(sigma, 3)), nullptr, first.data());
}

std::size_t SurveyBundle::marker_index(int id) const {
  const std::vector<int>& ids = problem_.keyframes.ids;
  return static_cast<std::size_t>(std::ranges::lower_bound(ids, id) - ids.begin());
}

void SurveyBundle::set_factors(double dots, double wheels, double ceiling) {
  ceres_->dots_factor.set(dots);
  ceres_->wheels_factor.set(wheels);
  ceres_->ceiling_factor.set(ceiling);
}

void SurveyBundle::set_gauge_factor(double factor) {
  ceres_->gauge_factor.set(factor);
}

bool SurveyBundle::solve() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = problem_.options.most_iterations;
  options.function_tolerance = 1e-9;
  // The start is a least-squares one, from which Gauss-Newton's steps are good. Damped as Ceres' 1e4 says,
  // long soft shapes, as rows without lanes across, hardly move: 60 iterations where this takes 10.
  options.initial_trust_region_radius = 1e11;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &ceres_->problem, &summary);
  ceres_->freedom = summary.num_residuals - summary.num_effective_parameters;
  return summary.IsSolutionUsable() && summary.termination_type == ceres::CONVERGENCE;
}

double SurveyBundle::chi2() const {
  double cost = 0.0;
  ceres_->problem.Evaluate({}, &cost, nullptr, nullptr, nullptr);
  return 2.0 * cost;
}

/// The redundancy that is not the dots' is what the others' squared residuals amount to: their expectation.
SurveyFit SurveyBundle::fit_of_dots() const {
  const ResidualSum dots = ceres_->sum_of(ceres_->all_dots());
  const double others = chi2() - dots.chi2;
  return {dots.chi2 / ceres_->dots_factor.weight(), std::max(1.0, ceres_->freedom - others)};
}

SurveyFit SurveyBundle::fit_of_wheels() const {
  const ResidualSum wheels = ceres_->sum_of(ceres_->wheels);
  return {wheels.chi2 / ceres_->wheels_factor.weight(), static_cast<double>(wheels.count)};
}

SurveyFit SurveyBundle::fit_of_ceiling() const {
  const ResidualSum ceiling = ceres_->sum_of(ceres_->ceiling);
  return {ceiling.chi2 / ceres_->ceiling_factor.weight(), static_cast<double>(ceiling.count)};
}

std::vector<std::vector<ResidualSum>> SurveyBundle::sums_by_sighting() const {
  const std::vector<ResidualSum> in_order = ceres_->sums_of(ceres_->all_dots());
  std::vector<std::vector<ResidualSum>> sums;
  auto next = in_order.begin();
  for (const std::vector<Block>& of_frame : ceres_->dots) {
    const auto end = next + static_cast<std::ptrdiff_t>(in_order.empty() ? 0 : of_frame.size());
    sums.emplace_back(next, end);
    next = end;
  }
  return sums;
}

std::vector<ResidualSum> SurveyBundle::sums_by_anchor() const {
  return ceres_->sums_of(ceres_->anchors);
}

std::optional<SurveyCovariance> SurveyBundle::covariance() const {
  SurveyState& state = const_cast<SurveyBundle*>(this)->unknowns_.state;
  ceres::Problem::EvaluateOptions options;
  std::vector<int> wanted;
  int column = 0;
  const auto add = [&](double* block, int size, int first_wanted, int wanted_count) {
    options.parameter_blocks.push_back(block);
    for (int i = 0; i < wanted_count; ++i) wanted.push_back(column + first_wanted + i);
    column += size;
  };
  for (SurveyState::Place& place : state.places) add(place.data(), 5, 0, 0);
  for (std::size_t m = 0; m < state.markers.size(); ++m)
    add(state.dot_offsets_m[m].data(), static_cast<int>(state.dot_offsets_m[m].size()), 0, 0);
  for (SurveyState::Marker& marker : state.markers) add(marker.data(), 6, 0, 4);
  add(state.mount_m.data(), 3, 0, 3);
  add(state.mount_turn_rad.data(), 3, 0, 3);
  add(state.scale_and_k1.data(), 2, 0, 2);
  add(state.wheels.data(), 3, 0, 3);
  if (!ceres_->ceiling.empty()) add(state.ceiling.data(), 1, 0, 0);
  const auto reported = static_cast<Eigen::Index>(wanted.size());
  constexpr int of_place = 5;
  for (const PlacedAnchor& placed : problem_.placed)
    if (std::holds_alternative<RobotAnchor>(problem_.anchors.anchors[placed.anchor].what))
      for (int i = 0; i < 3; ++i) wanted.push_back(of_place * static_cast<int>(placed.keyframe) + i);
  const std::optional<Eigen::MatrixXd> inverse = inverse_part(ceres_->jacobian(options), wanted);
  if (!inverse) return std::nullopt;
  SurveyCovariance covariance{.matrix = inverse->topLeftCorner(reported, reported)};
  if (ceres_->anchors.empty()) return covariance;
  options.residual_blocks = ceres_->anchors;
  std::vector<int> counts;
  for (const ResidualSum& sum : sums_by_anchor()) counts.push_back(sum.count);
  covariance.anchor_redundancies = least_redundancies(ceres_->jacobian(options), counts, wanted, *inverse);
  return covariance;
}

}  // namespace lodestar

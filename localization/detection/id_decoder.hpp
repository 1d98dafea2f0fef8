#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "maps/marker.hpp"

namespace lodestar {

/// Log odds of a dot in each cell of a marker's grid: positive for a dot, negative for an empty cell, zero
/// for unknown.
struct CellEvidence {
  std::array<double, static_cast<std::size_t>(marker_grid_size* marker_grid_size)> log_odds{};

  [[nodiscard]] double& at(GridCell cell) { return log_odds[index(cell)]; }
  [[nodiscard]] double at(GridCell cell) const { return log_odds[index(cell)]; }

  /// Number of undecided cells: |log odds| below 3 (20 to 1).
  [[nodiscard]] int undecided() const;

 private:
  static std::size_t index(GridCell cell) {
    return static_cast<std::size_t>(cell.row * marker_grid_size + cell.column);
  }
};

struct IdDecoderOptions {
  /// Prior that a detected marker is none of the registered ones: IDs installed elsewhere, and look-alikes.
  double foreign_probability = 0.1;
  /// Log odds against an occluder in front of a marker that is as gray as the ceiling, so that the occluded
  /// cells look empty: one marker in 400. Not applied where an occluder shows.
  double cover = 6.0;
  /// Log odds against each dot being behind it: one occluder hides several dots, so losses are correlated.
  double covered = 2.0;
};

/// The most likely ID for one set of cell evidence.
struct IdReading {
  int id = 0;
  int contradicting = 0;  ///< decided cells that disagree with the ID, including O, X, Y and the empty corner
  double weight = 0.0;    ///< likelihood times prior
  double all_weight = 0.0;  ///< sum over all IDs: weight / all_weight is the ID's posterior probability
};

/// Decodes the ID from the cell evidence by Bayes' rule. The prior is uniform over the registered markers,
/// with a small probability for any of the 4096 IDs. False dots are independent of each other; missing dots
/// may be correlated.
class IdDecoder {
 public:
  /// Without registered IDs, all IDs are equally likely.
  explicit IdDecoder(std::span<const int> registered_ids = {}, const IdDecoderOptions& options = {});

  /// Likelihoods are relative to every cell, corners included (O, X and Y hold dots, the fourth does not),
  /// being what its evidence says. `cover_shows`: an occluder is known to be in front of the marker; an
  /// undecided cell implies one.
  [[nodiscard]] IdReading read(const CellEvidence& cells, bool cover_shows) const;

  [[nodiscard]] bool knows_ids() const { return !ids_.empty(); }

  /// True for a registered ID, or for any ID without registered ones.
  [[nodiscard]] bool accepts(int id) const;

 private:
  IdDecoderOptions options_;
  std::vector<int> ids_;
  double registered_prior_ = 0.0;  ///< of each registered ID
  double foreign_prior_ = 0.0;     ///< of each of the 4096 IDs
};

}  // namespace lodestar

#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "maps/marker.hpp"

namespace lodestar {

/// How surely each cell of a marker's grid holds a dot: the logarithm of the odds, positive for a dot, zero
/// where nothing can be said.
struct CellEvidence {
  std::array<double, static_cast<std::size_t>(marker_grid_size* marker_grid_size)> log_odds{};

  [[nodiscard]] double& at(GridCell cell) { return log_odds[index(cell)]; }
  [[nodiscard]] double at(GridCell cell) const { return log_odds[index(cell)]; }

  /// How many cells can be one or the other.
  [[nodiscard]] int undecided() const;

 private:
  static std::size_t index(GridCell cell) {
    return static_cast<std::size_t>(cell.row * marker_grid_size + cell.column);
  }
};

struct IdDecoderOptions {
  /// That a marker seen is none of the registered ones. IDs that hang elsewhere, and things that look alike.
  double foreign_probability = 0.1;
  /// Log odds against something that hangs before a marker and is as gray as the ceiling, so that the cells
  /// it covers look empty: one marker in 400. Void where a cover shows.
  double cover = 6.0;
  /// Log odds against each dot being under it: one cover hides several dots, they are not lost independently.
  double covered = 2.0;
};

/// The likeliest ID of one reading of the cells.
struct IdReading {
  int id = 0;
  int contradicting = 0;  ///< cells that surely are not what the ID wants, O, X, Y and the fourth among them
  double weight = 0.0;    ///< its likelihood times its prior
  double all_weight = 0.0;  ///< of all IDs together: weight / all_weight is the ID's posterior probability
};

/// Tells the ID from the cells' evidence by Bayes' rule. A registered marker is expected, and which one is
/// open; but with a small probability any of the 4096 hangs there. Dots that should not be there come
/// independently of each other. Dots that are not seen may be lost together.
class IdDecoder {
 public:
  /// No registered IDs: all are alike.
  explicit IdDecoder(std::span<const int> registered_ids = {}, const IdDecoderOptions& options = {});

  /// Likelihoods are relative to every cell being what its evidence says, the corners' among them: O, X and Y
  /// hold dots, the fourth does not. `cover_shows`: something is known to hang before the marker. An
  /// undecided cell tells as much.
  [[nodiscard]] IdReading read(const CellEvidence& cells, bool cover_shows) const;

  [[nodiscard]] bool knows_ids() const { return !ids_.empty(); }

  /// Is it one of the registered IDs, or are all alike?
  [[nodiscard]] bool accepts(int id) const;

 private:
  IdDecoderOptions options_;
  std::vector<int> ids_;
  double registered_prior_ = 0.0;  ///< of each registered ID
  double foreign_prior_ = 0.0;     ///< of each of all IDs
};

}  // namespace lodestar

#pragma once

#include <optional>
#include <span>
#include <vector>

#include "planning/corners.hpp"
#include "planning/tile_distances.hpp"

namespace lodestar {

/// A point where a path may turn; one without a corner lies on open ground, where it may turn either way.
struct TurnPlace {
  Vec2 position = Vec2::Zero();
  std::optional<Vec2> corner;
};

/// Chooses, on maps with very many corners, the turn points that are worth a search: those where a path must
/// bend, a fraction of the radius apart, in the order of the length of the shortest path through each. That
/// length is measured over tiles, in both directions, with obstacles: much sharper than an ellipse about
/// start and goal. Memory is kept between queries.
class TurnPointChoice {
 public:
  /// Space and turn points must outlive it.
  TurnPointChoice(const CollisionChecker& space, std::span<const TurnPoint> turn_points);

  /// For paths from the first to the last of the known points of at most this length. Without turns counted,
  /// only tight points. At most `most`; valid until the next call. Rounds after round 0 choose others, for
  /// the same start and goal and no greater length: lengths over tiles are measured in round 0.
  const std::vector<TurnPlace>& choose(std::span<const Vec2> known, double longest_cells, bool counts_turns,
                                       std::size_t most, int round);

  /// After choose(): the length over tiles to the start and to the goal; a large one where there is none.
  [[nodiscard]] double to_start_cells(const Vec2& point) const { return measured(from_start_, point); }
  [[nodiscard]] double to_goal_cells(const Vec2& point) const { return measured(from_goal_, point); }

  /// Bounds between a length over tiles and that of a straight or any-angle path.
  [[nodiscard]] double at_least_cells(double over_tiles) const;
  [[nodiscard]] double at_most_cells(double straight) const;

 private:
  struct Ranked {
    std::int32_t through = 0;  ///< length of the shortest path through it, in eighths of a tile's side
    std::uint32_t tile = 0;
  };
  struct Earlier;
  enum class Bend : std::uint8_t { unknown, possible, impossible };
  static constexpr std::uint32_t none = 0xffffffff;

  [[nodiscard]] double measured(const TileDistances& distances, const Vec2& point) const;
  void sort_into_tiles();
  void measure(const Vec2& start, const Vec2& goal, double longest_cells);
  void rank_tiles(double longest_cells);
  void choose_corners(std::size_t most, bool counts_turns);
  void choose_corners_of(std::uint32_t tile, std::size_t most, bool counts_turns);
  void choose_open(std::size_t most, double longest_cells, int round);
  void rank_open(int spacing, int round, double longest_cells);
  void forget_chosen();
  [[nodiscard]] std::optional<std::int32_t> through(Cell tile, double longest_cells) const;
  [[nodiscard]] bool is_apart(const TurnPoint& point, std::uint32_t tile) const;
  [[nodiscard]] bool lets_bend(std::uint32_t index);
  [[nodiscard]] bool looks_bendable(const TurnPoint& point) const;

  const CollisionChecker& space_;
  std::span<const TurnPoint> turn_points_;
  TileMap tiles_;
  std::vector<std::uint32_t> by_tile_;        ///< turn points; those that need fewer turns first
  std::vector<std::uint32_t> first_of_tile_;  ///< in by_tile_; one more than tiles
  std::vector<Bend> bends_;                   ///< by turn point
  TileDistances from_start_;
  TileDistances from_goal_;
  std::vector<Ranked> ranked_;
  std::vector<TurnPlace> chosen_;
  std::vector<std::uint32_t> newest_of_tile_;  ///< among the chosen corners
  std::vector<std::uint32_t> older_of_tile_;   ///< by chosen place
};

}  // namespace lodestar

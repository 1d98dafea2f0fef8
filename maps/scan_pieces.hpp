#pragma once

#include <cstddef>
#include <vector>

#include "maps/scan_rays.hpp"

namespace lodestar {

/// Rays of a scan, one after the other, that hit one piece.
using ScanPiece = std::vector<std::size_t>;

/// What the scan hits, of the rays that `counts`, split where one `joins` not the one before it that counts;
/// rays between them that do not count are looked across. A piece where the turn begins is in two.
template <typename Counts, typename Joins>
std::vector<ScanPiece> pieces_of(const DeskewedScan& scan, const Counts& counts, const Joins& joins) {
  std::vector<ScanPiece> pieces;
  for (std::size_t i = 0; i < scan.rays.size(); ++i) {
    if (!ends_at_something(scan.rays[i]) || !counts(scan.rays[i])) continue;
    if (pieces.empty() || !joins(scan.rays[pieces.back().back()], scan.rays[i])) pieces.emplace_back();
    pieces.back().push_back(i);
  }
  return pieces;
}

/// A turn may begin in the middle of a thing: makes one of the last piece and the first, where the last ray
/// `joins` the first, by their places in the scan.
template <typename Joins>
void join_over_seam(std::vector<ScanPiece>& pieces, const Joins& joins) {
  if (pieces.size() < 2 || !joins(pieces.back().back(), pieces.front().front())) return;
  pieces.back().insert(pieces.back().end(), pieces.front().begin(), pieces.front().end());
  pieces.erase(pieces.begin());
}

}  // namespace lodestar

#pragma once

#include <array>
#include <string_view>

namespace lodestar {

/// What a simulated ceiling is made of. All but the first are rendered at full resolution, bright under the
/// ring's light, with structure that crosses markers.
enum class CeilingKind {
  tiles,       ///< mineral fibre with shallow joints and little contrast; quick to render
  joints,      ///< metal or gypsum panels with dark joints
  planks,      ///< boards with dark grooves between them
  veneer,      ///< wood with veins and knots
  plaster,     ///< trowelled, with cracks and uneven light
  vents,       ///< louvres and perforated plates among panels
  slats,       ///< a linear ceiling: slats with dark slots between them, all over
  detectors,   ///< smoke detectors and sprinklers on plaster
  reflectors,  ///< rows of tubes in reflectors, which light the ceiling beside them steeply
  glossy       ///< paint that mirrors the camera's own ring light
};

inline constexpr std::array all_ceiling_kinds{
    CeilingKind::tiles,      CeilingKind::joints, CeilingKind::planks, CeilingKind::veneer,
    CeilingKind::plaster,    CeilingKind::vents,  CeilingKind::slats,  CeilingKind::detectors,
    CeilingKind::reflectors, CeilingKind::glossy};

std::string_view name_of(CeilingKind kind);

}  // namespace lodestar

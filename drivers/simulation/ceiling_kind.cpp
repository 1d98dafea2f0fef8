#include "drivers/simulation/ceiling_kind.hpp"

namespace lodestar {

std::string_view name_of(CeilingKind kind) {
  switch (kind) {
    case CeilingKind::tiles:
      return "tiles";
    case CeilingKind::joints:
      return "joints";
    case CeilingKind::planks:
      return "planks";
    case CeilingKind::veneer:
      return "veneer";
    case CeilingKind::plaster:
      return "plaster";
    case CeilingKind::vents:
      return "vents";
    case CeilingKind::slats:
      return "slats";
    case CeilingKind::detectors:
      return "detectors";
    case CeilingKind::reflectors:
      return "reflectors";
    case CeilingKind::glossy:
      return "glossy";
  }
  return "";
}

}  // namespace lodestar

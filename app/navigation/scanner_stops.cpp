#include "app/navigation/scanner_stops.hpp"

namespace lodestar {

StopReason stop_for(ScannerFault fault) {
  switch (fault) {
    case ScannerFault::silent:
      return StopReason::scanner_silent;
    case ScannerFault::other_clock:
      return StopReason::scanner_clock;
    case ScannerFault::late:
      return StopReason::scanner_late;
    case ScannerFault::frozen:
      return StopReason::scanner_repeats;
    case ScannerFault::checksums:
      return StopReason::scanner_damaged;
    case ScannerFault::motor:
      return StopReason::scanner_motor;
    case ScannerFault::dirty:
      return StopReason::scanner_dirty;
    case ScannerFault::beams_lost:
      return StopReason::scanner_blind;
    case ScannerFault::turned:
      return StopReason::scanner_turned;
  }
  return StopReason::scanner_silent;
}

StopReason stop_for(FieldReason reason) {
  switch (reason) {
    case FieldReason::person_near:
      return StopReason::person_near;
    case FieldReason::obstacle_ahead:
      return StopReason::obstacle_ahead;
    case FieldReason::hidden_corner:
      return StopReason::hidden_corner;
    case FieldReason::no_scan:
      break;
  }
  return StopReason::scanner_silent;
}

}  // namespace lodestar

#pragma once

#include "control/protective_field.hpp"
#include "control/safety_stop.hpp"
#include "localization/integrity/scanner_watch.hpp"

// What a robot with a scanner says when it stands.
namespace lodestar {

StopReason stop_for(ScannerFault fault);
StopReason stop_for(FieldReason reason);

}  // namespace lodestar

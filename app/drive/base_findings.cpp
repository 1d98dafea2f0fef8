#include "app/drive/base_findings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "drivers/system/clock.hpp"

namespace lodestar {
namespace {

/// The kinds of feedback that a run needs and the base does not send.
std::vector<std::string> missing_kinds(const HeardBase& heard) {
  std::vector<std::string> missing;
  if (!heard.system) missing.emplace_back("no system state");
  if (!heard.reports_motion) missing.emplace_back("no motion state");
  if (!heard.reports_travel) missing.emplace_back("no odometer");
  return missing;
}

Finding look_at_frames(const HeardBase& heard) {
  constexpr int enough_states = 3;
  if (!heard.newest) {
    return {.what = "base",
            .verdict = Verdict::bad,
            .found = heard.kinds.empty() ? "silent: no frame in a second"
                                         : "none of the frames heard is the base's",
            .remedy = "switch the base on; check the plug, the bit rate and the protocol in site.yaml"};
  }
  const Stamp now = monotonic_now();
  std::string kinds;
  for (const auto& [id, kind] : heard.kinds)
    kinds += fmt::format(" {:03X} x {} ({:.0f} ms)", id, kind.count, 1e3 * seconds(now - kind.newest));
  Finding finding{.what = "base", .found = "heard in a second (the newest so long ago):" + kinds};
  if (const std::vector<std::string> missing = missing_kinds(heard); !missing.empty()) {
    finding.verdict = Verdict::bad;
    finding.found += fmt::format("; {}", fmt::join(missing, ", "));
    finding.remedy =
        "have the base send all of its feedback; check the protocol in site.yaml; of two axes, both must "
        "send";
  } else if (heard.states >= enough_states && heard.counter_advances == 0) {
    finding.verdict = Verdict::bad;
    finding.found += fmt::format("; the counter in its state stands still at {}", heard.system->counter);
    finding.remedy = "switch the base off and on: its controller hangs, and what it sends may be outdated";
  } else if (heard.odd > 0) {
    finding.verdict = Verdict::doubtful;
    finding.found += fmt::format("; {} frames are odd", heard.odd);
    finding.remedy = "check the protocol in site.yaml and what else is on the bus";
  }
  return finding;
}

Finding look_at_mode(const SystemState& system) {
  switch (system.mode) {
    case ControlMode::can:
      return {.what = "mode", .found = "takes commands from CAN"};
    case ControlMode::standby:
      return {.what = "mode", .found = "standby; a run requests CAN mode"};
    case ControlMode::remote:
      return {.what = "mode",
              .verdict = Verdict::bad,
              .found = "the remote control drives",
              .remedy = "switch the remote control to CAN mode, or off"};
    case ControlMode::uart:
    case ControlMode::unknown:
      break;
  }
  return {.what = "mode",
          .verdict = Verdict::doubtful,
          .found = "another controller has the base",
          .remedy = "end what commands it over the serial line"};
}

Finding look_at_emergency_stop(const SystemState& system) {
  if (system.vehicle != VehicleState::emergency_stop) return {.what = "e-stop", .found = "released"};
  return {.what = "e-stop",
          .verdict = Verdict::bad,
          .found = "pressed",
          .remedy =
              "release it; if the base still reports it, start a run and type resume: that asks the base "
              "to clear it"};
}

Finding look_at_faults(const SystemState& system, const BaseProtocol& protocol, std::uint32_t ignored_bits) {
  const std::uint32_t harmless = system.fault_bits & (protocol.warning_bits() | ignored_bits);
  const std::vector<std::string> faults = protocol.fault_names(system.fault_bits & ~harmless);
  const std::vector<std::string> warnings = protocol.fault_names(harmless);
  const bool is_exception =
      system.vehicle == VehicleState::exception || system.vehicle == VehicleState::unknown;
  if (!faults.empty() || is_exception) {
    return {.what = "faults",
            .verdict = Verdict::bad,
            .found =
                faults.empty() ? "the base reports an exception" : fmt::format("{}", fmt::join(faults, ", ")),
            .remedy = "find the cause; then start a run and type resume: that asks the base to clear them"};
  }
  if (warnings.empty()) return {.what = "faults", .found = "none"};
  return {.what = "faults",
          .verdict = Verdict::doubtful,
          .found = fmt::format("none that stops the robot, but: {}", fmt::join(warnings, ", ")),
          .remedy = "a run drives nevertheless"};
}

Finding look_at_masters(const HeardBase& heard) {
  if (heard.other_masters == 0) return {.what = "masters", .found = "no motion commands"};
  return {.what = "masters",
          .verdict = Verdict::doubtful,
          .found = fmt::format("{} motion commands of another program", heard.other_masters),
          .remedy = "end it before a run: two masters stop each other"};
}

}  // namespace

void HeardBase::take(const StampedCanFrame& received, const HeardFrame& said) {
  Kind& kind = kinds[received.frame.id];
  ++kind.count;
  kind.newest = received.stamp;
  odd += said.odd ? 1 : 0;
  other_masters += said.command ? 1 : 0;
  if (said.from_base) newest = received.stamp;
  reports_motion = reports_motion || said.measured.has_value();
  reports_travel = reports_travel || said.travel.has_value();
  if (!said.system) return;
  ++states;
  if (system && system->counter != said.system->counter) ++counter_advances;
  system = said.system;
}

std::vector<Finding> look_at_base(const HeardBase& heard, const BaseProtocol& protocol,
                                  std::uint32_t ignored_bits) {
  std::vector<Finding> findings{look_at_frames(heard)};
  if (heard.system) {
    findings.push_back(look_at_mode(*heard.system));
    findings.push_back(look_at_emergency_stop(*heard.system));
    findings.push_back(look_at_faults(*heard.system, protocol, ignored_bits));
  }
  if (heard.newest) findings.push_back(look_at_masters(heard));
  return findings;
}

}  // namespace lodestar

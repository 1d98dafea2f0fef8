#include "planning/planner_kind.hpp"

#include <algorithm>
#include <array>

namespace lodestar {
namespace {

struct KindName {
  PlannerKind kind;
  std::string_view name;
  std::optional<SamplingMethod> sampling;
};
constexpr std::array<KindName, 8> kinds{{
    {PlannerKind::astar, "astar", std::nullopt},
    {PlannerKind::anyangle, "anyangle", std::nullopt},
    {PlannerKind::fastest, "fastest", std::nullopt},
    {PlannerKind::rrtstar, "rrtstar", SamplingMethod::rrtstar},
    {PlannerKind::informedrrtstar, "informedrrtstar", SamplingMethod::informedrrtstar},
    {PlannerKind::bitstar, "bitstar", SamplingMethod::bitstar},
    {PlannerKind::abitstar, "abitstar", SamplingMethod::abitstar},
    {PlannerKind::prmstar, "prmstar", SamplingMethod::prmstar},
}};

const KindName& named(PlannerKind kind) {
  return *std::ranges::find(kinds, kind, &KindName::kind);
}

}  // namespace

std::string_view to_string(PlannerKind kind) {
  return named(kind).name;
}

std::optional<PlannerKind> planner_kind(std::string_view name) {
  const auto* found = std::ranges::find(kinds, name, &KindName::name);
  if (found == kinds.end()) return std::nullopt;
  return found->kind;
}

std::vector<PlannerKind> all_planner_kinds() {
  std::vector<PlannerKind> all;
  for (const KindName& each : kinds) all.push_back(each.kind);
  return all;
}

std::optional<SamplingMethod> sampling_method(PlannerKind kind) {
  return named(kind).sampling;
}

}  // namespace lodestar

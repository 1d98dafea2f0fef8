#include "app/placement/accepted_issues.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "maps/atomic_file.hpp"
#include "maps/marker.hpp"
#include "maps/strict_yaml.hpp"
#include "maps/yaml_quoting.hpp"

namespace lodestar {
namespace {

constexpr double farthest_m = 1e4;

bool are_near(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
  constexpr double near_m = 0.5;
  return std::ranges::equal(a, b, [](const Vec2& p, const Vec2& q) { return (p - q).norm() < near_m; });
}

/// A stretch may be found from either end.
bool are_same_places(const std::vector<Vec2>& a, std::vector<Vec2> b) {
  if (are_near(a, b)) return true;
  std::ranges::reverse(b);
  return are_near(a, b);
}

std::vector<int> sorted(std::vector<int> ids) {
  std::ranges::sort(ids);
  return ids;
}

AcceptedIssue read_item(StrictYaml& item) {
  AcceptedIssue accepted;
  const std::string word = item.text("kind");
  const std::optional<IssueKind> kind = issue_kind_named(word);
  if (!kind)
    item.refuse("kind", "'" + word + "'", "a kind of issue as `lodestar markers check --json` names it");
  accepted.kind = *kind;
  accepted.reason = item.text("reason");
  accepted.at = item.text("at");
  if (item.has("by")) accepted.by = item.text("by");
  if (item.has("ids")) {
    for (const double id : item.numbers("ids", item.node("ids").size())) {
      if (id != std::floor(id) || id < 0 || id >= marker_id_count)
        item.refuse("ids", fmt::format("{}", id), "IDs of markers");
      accepted.ids.push_back(static_cast<int>(id));
    }
  }
  if (item.has("places_m")) accepted.places_m = item.points("places_m", farthest_m);
  if (accepted.ids.empty() && accepted.places_m.empty())
    item.refuse("kind", "neither ids nor places_m", "one of them");
  item.finish();
  return accepted;
}

}  // namespace

std::vector<AcceptedIssue> load_accepted(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / accepted_file_name;
  if (!std::filesystem::exists(file)) return {};
  StrictYaml yaml = StrictYaml::load(file);
  if (const std::string format = yaml.text("format"); format != "lodestar-accepted")
    yaml.refuse("format", "'" + format + "'", "'lodestar-accepted'");
  (void)yaml.integer("version", 1, 1);
  std::vector<AcceptedIssue> accepted;
  for (StrictYaml& item : yaml.list_of_mappings("accepted")) accepted.push_back(read_item(item));
  yaml.finish();
  return accepted;
}

void save_accepted(std::span<const AcceptedIssue> accepted, const std::filesystem::path& folder) {
  std::string text =
      "format: lodestar-accepted\nversion: 1\naccepted:" + std::string(accepted.empty() ? " []\n" : "\n");
  for (const AcceptedIssue& issue : accepted) {
    text += fmt::format("  - {{kind: {}, reason: {}, at: {}", to_string(issue.kind),
                        yaml_quoted(issue.reason), yaml_quoted(issue.at));
    if (!issue.by.empty()) text += ", by: " + yaml_quoted(issue.by);
    if (!issue.ids.empty()) text += fmt::format(", ids: [{}]", fmt::join(issue.ids, ", "));
    if (!issue.places_m.empty()) {
      std::vector<std::string> places;
      for (const Vec2& place : issue.places_m)
        places.push_back(fmt::format("[{:.2f}, {:.2f}]", place.x(), place.y()));
      text += fmt::format(", places_m: [{}]", fmt::join(places, ", "));
    }
    text += "}\n";
  }
  write_file_atomically(folder / accepted_file_name, text);
}

const AcceptedIssue* acceptance_of(const RegistryIssue& issue, std::span<const AcceptedIssue> accepted) {
  if (issue.error) return nullptr;
  const auto fits = [&](const AcceptedIssue& other) {
    if (other.kind != issue.kind || sorted(other.ids) != sorted(issue.ids)) return false;
    return !issue.ids.empty() || are_same_places(issue.places_m, other.places_m);
  };
  const auto found = std::ranges::find_if(accepted, fits);
  return found == accepted.end() ? nullptr : &*found;
}

nlohmann::ordered_json issue_json(const RegistryIssue& issue, std::span<const AcceptedIssue> accepted) {
  nlohmann::ordered_json json = issue_json(issue);
  if (const AcceptedIssue* by = acceptance_of(issue, accepted))
    json["accepted"] = {{"reason", by->reason}, {"by", by->by}, {"at", by->at}};
  return json;
}

}  // namespace lodestar

#include "app/console/accepted_api.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/common/json_parse.hpp"
#include "app/common/wall_clock.hpp"
#include "app/common/whole_number.hpp"
#include "app/console/history_json.hpp"
#include "app/placement/accepted_issues.hpp"
#include "maps/input_error.hpp"
#include "maps/marker.hpp"

namespace lodestar {
namespace {

using nlohmann::json;

RegistryIssue issue_in(const json& sent) {
  const auto word = sent.at("kind").get<std::string>();
  const std::optional<IssueKind> kind = issue_kind_named(word);
  if (!kind) throw InputError(fmt::format("kind: found '{}', wanted one of /api/markers/check", word));
  RegistryIssue issue{.kind = *kind, .words = {}};
  for (const json& id : sent.at("ids"))
    issue.ids.push_back(static_cast<int>(whole_number(id, marker_id_count - 1)));
  for (const json& place : sent.at("places_m"))
    issue.places_m.emplace_back(place.at(0).get<double>(), place.at(1).get<double>());
  if (issue.ids.empty() && issue.places_m.empty())
    throw InputError("found neither markers nor places, wanted what the issue is about");
  return issue;
}

}  // namespace

std::optional<HttpResponse> AcceptedApi::answer(const HttpRequest& request) const {
  if (request.method != "PUT" || request.target != "/api/accepted") return std::nullopt;
  try {
    return set(request);
  } catch (const InputError& error) {
    return refusal(422, error.what());
  } catch (const json::exception& error) {
    return refusal(422, error.what());
  }
}

HttpResponse AcceptedApi::set(const HttpRequest& request) const {
  constexpr std::size_t longest_reason = 200;
  constexpr std::size_t most_accepted = 10000;
  const json sent = parse_json(request.body);
  const RegistryIssue issue = issue_in(sent);
  const auto reason = sent.at("reason").get<std::string>();
  if (reason.size() > longest_reason)
    return refusal(
        422, fmt::format("found a reason of {} bytes, wanted at most {}", reason.size(), longest_reason));
  std::vector<AcceptedIssue> accepted = load_accepted(folder_);
  if (accepted.size() >= most_accepted) return refusal(422, "found ten thousand warnings that stand already");
  std::erase_if(accepted,
                [&](const AcceptedIssue& other) { return acceptance_of(issue, {&other, 1}) != nullptr; });
  if (!reason.empty())
    accepted.push_back({.kind = issue.kind,
                        .ids = issue.ids,
                        .places_m = issue.ids.empty() ? issue.places_m : std::vector<Vec2>{},
                        .reason = reason,
                        .by = name_of(request),
                        .at = utc_text()});
  save_accepted(accepted, folder_);
  const std::string what = fmt::format("the warning '{}'", to_string(issue.kind));
  audit_.note({.by = name_of(request),
               .what = reason.empty() ? "no longer lets stand " + what : "lets stand " + what + ": " + reason,
               .document = {}});
  return {.body = "{}"};
}

}  // namespace lodestar

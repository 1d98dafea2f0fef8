#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "app/placement/registry_check.hpp"

// Warnings accepted with a reason: accepted.yaml of a site's folder.
// docs/file-formats.md has the keys.
namespace lodestar {

struct AcceptedIssue {
  IssueKind kind = IssueKind::gap;
  std::vector<int> ids;
  std::vector<Vec2> places_m;  ///< as the issue's, where it concerns no marker
  std::string reason;
  std::string by;  ///< may be empty
  std::string at;  ///< ISO 8601 in UTC
};

inline constexpr const char* accepted_file_name = "accepted.yaml";

/// Of a folder without the file: none. Throws InputError with file and line.
std::vector<AcceptedIssue> load_accepted(const std::filesystem::path& folder);

void save_accepted(std::span<const AcceptedIssue> accepted, const std::filesystem::path& folder);

/// The acceptance of the issue: of the same kind and markers, or of places within half a metre of
/// these, so that a gap that has grown is a new one. An error is never accepted.
const AcceptedIssue* acceptance_of(const RegistryIssue& issue, std::span<const AcceptedIssue> accepted);

/// As issue_json(), with "accepted": {reason, by, at} where it is accepted.
nlohmann::ordered_json issue_json(const RegistryIssue& issue, std::span<const AcceptedIssue> accepted);

}  // namespace lodestar

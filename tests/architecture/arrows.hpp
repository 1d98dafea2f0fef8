#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

// The dependency rules between rooms, and a parser of the sources' includes. A room is a folder with one
// target: one at the top (maps, planning, control), or one inside app/, drivers/ and localization/
// (app/report).
namespace lodestar {

inline constexpr int longest_source_lines = 350;

/// For each room, the rooms that it depends on directly; it may also use theirs.
const std::map<std::string, std::set<std::string>>& arrows();

/// All rooms that a room may use, directly or through others, itself among them.
/// Throws std::out_of_range for an unknown room.
std::set<std::string> usable_by(const std::string& room);

/// The room of a source (path from the project's root); empty when it is in none.
std::string room_of(const std::string& file);

/// The headers in quotation marks that a source text includes, in order.
std::vector<std::string> includes_of(std::string_view source);

/// Why `file` (path from the project's root) may not include `header`; empty when it may.
std::string complaint_about_include(const std::string& file, const std::string& header);

/// Violations in the source text of `file`: its includes and its length.
std::vector<std::string> complaints_about_source(const std::string& file, std::string_view source);

/// Violations in the lodestar_library(... USES ...) of a room's CMakeLists.txt.
std::vector<std::string> complaints_about_target(const std::string& room, const std::string& cmake);

}  // namespace lodestar

#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

// The rules between the rooms, and a reader of what the sources say. A room is a folder with one target: a
// folder at the top (maps, planning, control), or one of those inside app/, drivers/ and localization/
// (app/report).
namespace lodestar {

inline constexpr int longest_source_lines = 350;

/// For each room those that it draws an arrow to. What these may use, it may use too.
const std::map<std::string, std::set<std::string>>& arrows();

/// All rooms that a room may use, itself among them: what its arrows lead to, and theirs.
/// Throws std::out_of_range for an unknown room.
std::set<std::string> usable_by(const std::string& room);

/// The room that a source stands in (path from the project's root); empty where it stands in none.
std::string room_of(const std::string& file);

/// The headers in quotation marks that a source text includes, in order.
std::vector<std::string> includes_of(std::string_view source);

/// What is wrong with `file` (path from the project's root) including `header`; empty when nothing is.
std::string complaint_about_include(const std::string& file, const std::string& header);

/// What is wrong with the source text of `file`: its includes and its length.
std::vector<std::string> complaints_about_source(const std::string& file, std::string_view source);

/// What is wrong with the lodestar_library(... USES ...) of a room's CMakeLists.txt.
std::vector<std::string> complaints_about_target(const std::string& room, const std::string& cmake);

}  // namespace lodestar

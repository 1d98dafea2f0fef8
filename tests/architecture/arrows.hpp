#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

// The rules between the folders, and a reader of what the sources say.
namespace lodestar {

inline constexpr int longest_source_lines = 350;

/// For each folder the folders that it may use, itself among them.
const std::map<std::string, std::set<std::string>>& allowed_arrows();

/// The headers in quotation marks that a source text includes, in order.
std::vector<std::string> includes_of(std::string_view source);

/// What is wrong with `file` (path from the project's root) including `header`; empty when nothing is.
std::string complaint_about_include(const std::string& file, const std::string& header);

/// What is wrong with the source text of `file`: its includes and its length.
std::vector<std::string> complaints_about_source(const std::string& file, std::string_view source);

/// What is wrong with the lodestar_library(... USES ...) lines of a folder's CMakeLists.txt.
std::vector<std::string> complaints_about_targets(const std::string& folder, const std::string& cmake);

}  // namespace lodestar

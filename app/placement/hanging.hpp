#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

// How far the markers of a site are hung: hanging.yaml of its folder. docs/file-formats.md has the keys.
namespace lodestar {

enum class HangingState { planned, hung, verified };
std::string_view to_string(HangingState state);
std::optional<HangingState> hanging_state_named(const std::string& name);

struct HungMarker {
  HangingState state = HangingState::planned;
  std::string by;  ///< who said so; may be empty
  std::string at;  ///< ISO 8601 in UTC
};

inline constexpr const char* hanging_file_name = "hanging.yaml";

/// By ID; markers that are not in it are planned. Of a folder without the file: none. Throws InputError with
/// file and line.
std::map<int, HungMarker> load_hanging(const std::filesystem::path& folder);

void save_hanging(const std::map<int, HungMarker>& markers, const std::filesystem::path& folder);

}  // namespace lodestar

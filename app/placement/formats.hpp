#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "maps/marker_registry.hpp"

// Marker maps of other programs. Poses written and read are in the map frame: a registry's alignment is
// applied on export, and an imported registry has none. Lengths are metres.
//
//   format         place of a marker       direction
//   lodestar       dot O                   yaw of O to X, degrees
//   csv            dot O                   yaw of O to X, degrees       id,x,y,z,yaw_deg (size, name ignored)
//   stargazer      dot O                   angle-axis, radians          the KIT localizer's Landmarks list
//   apriltag       centre of the square    quaternion                   WPILib field layout: x out of the
//                                                                       face, y to its right, z to its top
//   fiducial_slam  centre of the square    roll pitch yaw, degrees      x to the right, y to the top, z out
//   geojson        dot O                   yaw of O to X, degrees       points in metres of the map frame
namespace lodestar {

enum class MarkerFormat { lodestar, csv, stargazer, apriltag, fiducial_slam, geojson };

/// The names above, in that order.
const std::vector<std::string>& marker_format_names();
std::optional<MarkerFormat> marker_format_named(std::string_view name);

/// By the file's extension and, for JSON and YAML, by its content; nothing for an unknown extension.
std::optional<MarkerFormat> guess_marker_format(const std::filesystem::path& file, std::string_view text);

/// The text in this format. Its numbers are read back as the same doubles.
std::string markers_text(const MarkerRegistry& registry, MarkerFormat format);

/// Reads a text; `file` is used in error messages only. Throws InputError with the line, where the format has
/// lines, for malformed input, an ID outside 0..4095 or given twice, and a face that is not downward within 5
/// degrees, as on a ceiling.
MarkerRegistry parse_markers(const std::string& text, MarkerFormat format, const std::filesystem::path& file);

}  // namespace lodestar

#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "maps/occupancy_map.hpp"

// An occupancy map from someone's plan of a building: a picture, a page of PDF or a drawing in DXF.
namespace lodestar {

struct PlanOptions {
  /// Metres for a pixel of a picture, or for a unit of a drawing. Nothing: as the drawing's header says.
  std::optional<double> metres_per_unit;
  double cell_m = 0.05;     ///< side of the map's cells, as in the lab's map
  double rotate_rad = 0.0;  ///< counter-clockwise, of the plan on the map
  int darkest_free = 128;   ///< gray values below this one (0 black .. 255 white) are walls
};

struct MapFromPlan {
  OccupancyMap map;
  std::vector<std::string> warnings;
};

/// A plan as a picture: 0 wherever something is drawn dark enough to be a wall, 255 elsewhere; top row first.
struct PlanPicture {
  cv::Mat walls;
  double metres_per_px = 0.0;
};

/// A plan as it was read: gray, top row first.
struct PlanSheet {
  cv::Mat gray;
  std::optional<double> metres_per_px;  ///< of a drawing, or as given
};

/// Reads a plan by the ending of its name: .png .jpg .jpeg .pgm .bmp (a picture), .pdf (its first page, with
/// 150 pixels per inch), .dxf (its lines, without frozen layers). Throws InputError.
PlanSheet read_plan(const std::filesystem::path& file, const PlanOptions& options);

/// Of read_plan()'s kinds. A wall thinner than a cell fills the cells that it touches. What lies outside the
/// outer walls becomes unknown, and the map ends at those walls; its frame begins at its lower left corner.
/// Throws InputError, also where the scale is unknown.
MapFromPlan map_from_plan(const std::filesystem::path& file, const PlanOptions& options);

/// The same from a plan that was read before, and has a scale.
MapFromPlan map_from_sheet(const PlanSheet& sheet, const PlanOptions& options);

/// The same from a picture.
MapFromPlan map_from_picture(const PlanPicture& picture, const PlanOptions& options);

/// A hall with walls of one cell around this free floor. Throws InputError for less than a square metre, and
/// for more cells than a map may have.
OccupancyMap empty_hall(double width_m, double height_m, double cell_m);

/// Parts of map_from_plan(), one for each kind of file.
cv::Mat read_pdf_page(const std::filesystem::path& file);
PlanPicture read_dxf_plan(const std::filesystem::path& file, const PlanOptions& options);

/// Largest number of pixels of a plan, and of the finer grid on which its walls are sampled.
inline constexpr double max_plan_px = 2e8;

}  // namespace lodestar

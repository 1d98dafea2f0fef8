#include "app/site/floor_plan.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "maps/input_error.hpp"
#include "maps/path_kind.hpp"
#include "maps/picture.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

constexpr std::uint8_t wall = 0;
constexpr std::uint8_t outside = 128;
constexpr std::uint8_t paper = 255;

std::string ending_of(const fs::path& file) {
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending;
}

cv::Mat read_picture(const fs::path& file) {
  try {
    return gray_picture_in(file);
  } catch (const PictureError&) {
    throw InputError(file, 0, "no picture that can be read", "a PNG, JPEG, PGM or BMP file");
  }
}

void expect_size(double columns, double rows, const std::string& what) {
  if (columns * rows <= max_plan_px) return;
  throw InputError(
      fmt::format("{}: found {:.0f} x {:.0f} points, wanted at most {:.0f} million in all; a "
                  "larger --cell or another scale",
                  what, columns, rows, max_plan_px / 1e6));
}

/// The walls on a grid `finer` times as fine as the map's, turned. No pixel of the plan falls between its
/// points.
cv::Mat turned(const PlanPicture& picture, double rotate_rad, double pitch_m) {
  const double scale = picture.metres_per_px / pitch_m;
  const double c = std::abs(std::cos(rotate_rad)) * scale;
  const double s = std::abs(std::sin(rotate_rad)) * scale;
  const double width = std::max(1.0, std::ceil(picture.walls.cols * c + picture.walls.rows * s - 1e-6));
  const double height = std::max(1.0, std::ceil(picture.walls.cols * s + picture.walls.rows * c - 1e-6));
  expect_size(width, height, "the plan");
  const cv::Point2d middle(0.5 * (picture.walls.cols - 1), 0.5 * (picture.walls.rows - 1));
  cv::Mat transform = cv::getRotationMatrix2D(middle, degrees(rotate_rad), scale);
  transform.at<double>(0, 2) += 0.5 * (width - 1.0) - middle.x;
  transform.at<double>(1, 2) += 0.5 * (height - 1.0) - middle.y;
  cv::Mat result;
  cv::warpAffine(picture.walls, result, transform, {static_cast<int>(width), static_cast<int>(height)},
                 cv::INTER_NEAREST, cv::BORDER_CONSTANT, cv::Scalar(paper));
  return result;
}

/// A cell is a wall when any of its points is. One cell of paper is added on each side, so that what lies
/// outside hangs together.
cv::Mat pooled(const cv::Mat& fine, int finer) {
  const int columns = (fine.cols + finer - 1) / finer;
  const int rows = (fine.rows + finer - 1) / finer;
  cv::Mat cells(rows + 2, columns + 2, CV_8U, cv::Scalar(paper));
  for (int row = 0; row < fine.rows; ++row) {
    const std::uint8_t* const from = fine.ptr<std::uint8_t>(row);
    std::uint8_t* const to = cells.ptr<std::uint8_t>(row / finer + 1) + 1;
    for (int column = 0; column < fine.cols; ++column) {
      if (from[column] == wall) to[column / finer] = wall;
    }
  }
  return cells;
}

/// Whether a square metre of floor is left inside; if not, all paper is floor again.
bool mark_outside(cv::Mat& cells, double cell_m) {
  cv::floodFill(cells, cv::Point(0, 0), cv::Scalar(outside), nullptr, cv::Scalar(), cv::Scalar(), 4);
  cv::Mat inside;
  cv::compare(cells, paper, inside, cv::CMP_EQ);
  if (cv::countNonZero(inside) * cell_m * cell_m >= 1.0) return true;
  cells.setTo(paper, cells == outside);
  return false;
}

OccupancyMap map_of(const cv::Mat& cells, double cell_m) {
  OccupancyMap map{.columns = cells.cols, .rows = cells.rows, .resolution_m = cell_m};
  map.cells.reserve(cells.total());
  for (int row = cells.rows - 1; row >= 0; --row) {
    for (int column = 0; column < cells.cols; ++column) {
      const std::uint8_t value = cells.at<std::uint8_t>(row, column);
      map.cells.push_back(value == wall      ? OccupancyMap::occupied
                          : value == outside ? OccupancyMap::unknown
                                             : OccupancyMap::free);
    }
  }
  return map;
}

}  // namespace

MapFromPlan map_from_picture(const PlanPicture& picture, const PlanOptions& options) {
  constexpr double denser = 1.5;  // than a pixel's side: a turned pixel holds a point when denser > sqrt(2)
  const int finer =
      std::max(1, static_cast<int>(std::ceil(denser * options.cell_m / picture.metres_per_px - 1e-9)));
  cv::Mat cells = pooled(turned(picture, options.rotate_rad, options.cell_m / finer), finer);
  MapFromPlan result;
  cv::Mat walls;
  cv::compare(cells, wall, walls, cv::CMP_EQ);
  if (cv::countNonZero(walls) == 0)
    throw InputError(
        "the plan: found nothing dark enough to be a wall, wanted walls; a higher --threshold finds lighter "
        "ones");
  if (!mark_outside(cells, options.cell_m))
    result.warnings.emplace_back(
        "the walls are open to the outside, or enclose less than a square metre: all of the sheet is floor. "
        "Close the outer walls in the plan, or check the scale");
  result.map = map_of(cells(cv::boundingRect(walls)), options.cell_m);
  return result;
}

PlanSheet read_plan(const fs::path& file, const PlanOptions& options) {
  if (!is_file(file)) throw InputError(file, 0, "no file", "a plan");
  const std::string ending = ending_of(file);
  if (ending == ".dxf") {
    PlanPicture drawn = read_dxf_plan(file, options);
    return {std::move(drawn.walls), drawn.metres_per_px};
  }
  const bool is_picture =
      ending == ".png" || ending == ".jpg" || ending == ".jpeg" || ending == ".pgm" || ending == ".bmp";
  if (!is_picture && ending != ".pdf")
    throw InputError(file, 0, "a name that ends in '" + ending + "'",
                     "a plan: .png, .jpg, .pgm, .bmp, .pdf, .dxf, or a map's .yaml");
  return {is_picture ? read_picture(file) : read_pdf_page(file), options.metres_per_unit};
}

MapFromPlan map_from_sheet(const PlanSheet& sheet, const PlanOptions& options) {
  PlanPicture picture{.walls = {}, .metres_per_px = sheet.metres_per_px.value()};
  cv::compare(sheet.gray, options.darkest_free, picture.walls, cv::CMP_GE);
  return map_from_picture(picture, options);
}

MapFromPlan map_from_plan(const fs::path& file, const PlanOptions& options) {
  const PlanSheet sheet = read_plan(file, options);
  if (!sheet.metres_per_px)
    throw InputError(
        file, 0, fmt::format("a picture of {} x {} pixels without a scale", sheet.gray.cols, sheet.gray.rows),
        "--points X1,Y1,X2,Y2 (pixels, from the upper left corner) with --distance M, or "
        "--resolution metres for a pixel");
  return map_from_sheet(sheet, options);
}

OccupancyMap empty_hall(double width_m, double height_m, double cell_m) {
  if (!(width_m * height_m >= 1.0))
    throw InputError(
        fmt::format("--size: found {} x {} m, wanted a square metre at least", width_m, height_m));
  const double columns = std::round(width_m / cell_m) + 2.0;
  const double rows = std::round(height_m / cell_m) + 2.0;
  expect_size(columns, rows, "--size");
  cv::Mat cells(static_cast<int>(rows), static_cast<int>(columns), CV_8U, cv::Scalar(paper));
  cv::rectangle(cells, cv::Rect(0, 0, cells.cols, cells.rows), cv::Scalar(wall), 1);
  OccupancyMap map = map_of(cells, cell_m);
  map.map_from_grid.position_m = {-cell_m, -cell_m};  // the floor's corner is the origin
  return map;
}

}  // namespace lodestar

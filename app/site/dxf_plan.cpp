#include <algorithm>
#include <cmath>
#include <dime/Input.h>
#include <dime/Model.h>
#include <dime/State.h>
#include <dime/entities/Entity.h>
#include <dime/sections/HeaderSection.h>
#include <dime/sections/TablesSection.h>
#include <dime/tables/LayerTable.h>
#include <dime/tables/Table.h>
#include <dime/util/Array.h>
#include <fmt/format.h>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <set>
#include <string>
#include <utility>

#include "app/site/floor_plan.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

using Segment = std::pair<Vec2, Vec2>;  ///< in the drawing's units

/// $INSUNITS of the header (DXF reference, AutoCAD 2012); nothing where it says none, or one that no building
/// is drawn in.
std::optional<double> metres_of(int insunits) {
  switch (insunits) {
    case 1:
      return 0.0254;
    case 2:
      return 0.3048;
    case 4:
      return 0.001;
    case 5:
      return 0.01;
    case 6:
      return 1.0;
    case 10:
      return 0.9144;
    case 14:
      return 0.1;
    default:
      return std::nullopt;
  }
}

std::optional<double> unit_of(dimeModel& model) {
  const auto* const header = dynamic_cast<const dimeHeaderSection*>(model.findSection("HEADER"));
  if (header == nullptr) return std::nullopt;
  int group = 0;
  dimeParam value{};
  if (header->getVariable("$INSUNITS", &group, &value, 1) != 1) return std::nullopt;
  return metres_of(value.int16_data);
}

Vec2 placed(const dimeMatrix& matrix, const dimeVec3f& point) {
  dimeVec3f moved;
  matrix.multMatrixVec(point, moved);
  return {moved[0], moved[1]};
}

/// Chains of vertices; those of a polygon are closed.
void append(const std::vector<Vec2>& chain, bool is_closed, std::vector<Segment>& segments) {
  for (std::size_t i = 1; i < chain.size(); ++i) segments.emplace_back(chain[i - 1], chain[i]);
  if (is_closed && chain.size() > 2) segments.emplace_back(chain.back(), chain.front());
}

/// Names of layers that are frozen or switched off, which the table of layers tells by a negative colour.
std::set<std::string> hidden_layers(dimeModel& model) {
  constexpr int group_of_flags = 70;
  constexpr int frozen = 1;
  std::set<std::string> hidden;
  auto* const tables = dynamic_cast<dimeTablesSection*>(model.findSection("TABLES"));
  for (int i = 0; tables != nullptr && i < tables->getNumTables(); ++i) {
    dimeTable* const table = tables->getTable(i);
    for (int k = 0; k < table->getNumTableEntries(); ++k) {
      const auto* const layer = dynamic_cast<const dimeLayerTable*>(table->getTableEntry(k));
      if (layer == nullptr || layer->getLayerName() == nullptr) continue;
      dimeParam flags{};
      const bool is_frozen = layer->getRecord(group_of_flags, flags) && (flags.int16_data & frozen) != 0;
      if (is_frozen || layer->getColorNumber() < 0) hidden.insert(layer->getLayerName());
    }
  }
  return hidden;
}

struct Drawing {
  std::set<std::string> hidden_layers;
  std::vector<Segment> segments;
};

bool take(const dimeState* state, dimeEntity* entity, void* to) {
  auto& [hidden, segments] = *static_cast<Drawing*>(to);
  const char* const layer = entity->getLayerName();
  if (entity->isDeleted() || (layer != nullptr && hidden.contains(layer))) return true;
  dimeArray<dimeVec3f> vertices;
  dimeArray<int> indices;
  dimeVec3f extrusion(0, 0, 1);
  dxfdouble thickness = 0;
  const dimeEntity::GeometryType type = entity->extractGeometry(vertices, indices, extrusion, thickness);
  if (type != dimeEntity::LINES && type != dimeEntity::POLYGONS) return true;
  dimeMatrix matrix;
  state->getMatrix(matrix);
  const bool is_closed = type == dimeEntity::POLYGONS;
  std::vector<Vec2> chain;
  for (int i = 0; indices.count() == 0 && i < vertices.count(); ++i)
    chain.push_back(placed(matrix, vertices[i]));
  for (int i = 0; i < indices.count(); ++i) {
    if (indices[i] >= 0 && indices[i] < vertices.count()) {
      chain.push_back(placed(matrix, vertices[indices[i]]));
    } else {
      append(chain, is_closed, segments);
      chain.clear();
    }
  }
  append(chain, is_closed, segments);
  return true;
}

PlanPicture drawn(const std::vector<Segment>& segments, double unit_m, double cell_m, const fs::path& file) {
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity());
  Vec2 high = -low;
  for (const Segment& segment : segments) {
    low = low.cwiseMin(segment.first).cwiseMin(segment.second);
    high = high.cwiseMax(segment.first).cwiseMax(segment.second);
  }
  // Coordinates are read as 24 bits: far from the drawing's origin they are coarser than the map.
  const double step_m = std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff()) * unit_m *
                        std::numeric_limits<float>::epsilon();
  if (!(step_m <= 0.25 * cell_m))
    throw InputError(file, 0, fmt::format("coordinates so large that they are read to {:.3f} m", step_m),
                     "a drawing moved to its origin");
  const double px_m = 0.5 * cell_m;
  const Vec2 size_px = (high - low) * unit_m / px_m;
  if (!((size_px.x() + 3.0) * (size_px.y() + 3.0) <= max_plan_px))
    throw InputError(file, 0,
                     fmt::format("a drawing of {:.0f} x {:.0f} m", size_px.x() * px_m, size_px.y() * px_m),
                     "a building; another --resolution or a larger --cell");
  PlanPicture picture{.walls = cv::Mat(static_cast<int>(size_px.y()) + 3, static_cast<int>(size_px.x()) + 3,
                                       CV_8U, cv::Scalar(255)),
                      .metres_per_px = px_m};
  const auto pixel = [&](const Vec2& point) {
    const Vec2 from_low = (point - low) * unit_m / px_m;
    return cv::Point(1 + static_cast<int>(std::lround(from_low.x())),
                     1 + static_cast<int>(std::lround(size_px.y() - from_low.y())));
  };
  for (const Segment& segment : segments)
    cv::line(picture.walls, pixel(segment.first), pixel(segment.second), cv::Scalar(0), 1, cv::LINE_4);
  return picture;
}

}  // namespace

PlanPicture read_dxf_plan(const fs::path& file, const PlanOptions& options) {
  dimeInput input;
  dimeModel model;
  if (!input.setFile(file.c_str()) || !model.read(&input))
    throw InputError(file, 0, "no drawing that can be read", "an ASCII or binary DXF file");
  const std::optional<double> unit_m = options.metres_per_unit ? options.metres_per_unit : unit_of(model);
  if (!unit_m)
    throw InputError(file, 0, "a drawing that does not say its units ($INSUNITS)",
                     "--resolution metres for a unit (0.001 for millimetres), or --points with --distance");
  Drawing drawing{hidden_layers(model), {}};
  model.traverseEntities(take, &drawing);
  std::vector<Segment>& segments = drawing.segments;
  std::erase_if(segments, [](const Segment& s) { return !s.first.allFinite() || !s.second.allFinite(); });
  if (segments.empty()) throw InputError(file, 0, "no lines on visible layers", "the walls of a building");
  return drawn(segments, *unit_m, options.cell_m, file);
}

}  // namespace lodestar

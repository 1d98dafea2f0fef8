#include "app/viewers/scanner_messages.hpp"

#include <bit>
#include <cmath>

#include "app/common/base64.hpp"

namespace lodestar {
namespace {

using Json = MessageJson;

constexpr const char* seen_frame = "base_link";
constexpr double scan_height_m = 0.1;  ///< in the picture only: a scan is planar
// Foxglove's NumericType.
constexpr int uint8_type = 1;
constexpr int float32_type = 7;

void append(std::string& bytes, float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  for (unsigned byte = 0; byte < sizeof bits; ++byte)
    bytes += static_cast<char>((bits >> (8U * byte)) & 0xFFU);
}

Json field_json(const char* name, std::size_t offset, int type) {
  return {{"name", name}, {"offset", offset}, {"type", type}};
}

struct Box {
  Vec2 low_m = Vec2::Zero();
  int columns = 1;
  int rows = 1;
};

/// Around the centres of all cells.
Box box_around(const SeenSurroundings& seen) {
  if (seen.cells.empty()) return {};
  Vec2 low_m = seen.cells.front().center_in_odom;
  Vec2 high_m = low_m;
  for (const RememberedCell& cell : seen.cells) {
    low_m = low_m.cwiseMin(cell.center_in_odom);
    high_m = high_m.cwiseMax(cell.center_in_odom);
  }
  const auto count = [&](double length_m) {
    return static_cast<int>(std::lround(length_m / seen.cell_m)) + 1;
  };
  return {low_m.array() - 0.5 * seen.cell_m, count(high_m.x() - low_m.x()), count(high_m.y() - low_m.y())};
}

std::string cells_of(const SeenSurroundings& seen, const Box& box) {
  constexpr char moving = 50;
  constexpr char standing = 100;
  std::string cells(static_cast<std::size_t>(box.columns) * static_cast<std::size_t>(box.rows), '\0');
  for (const RememberedCell& cell : seen.cells) {
    const Vec2 at = (cell.center_in_odom - box.low_m) / seen.cell_m;
    const auto index = static_cast<std::size_t>(std::floor(at.y())) * static_cast<std::size_t>(box.columns) +
                       static_cast<std::size_t>(std::floor(at.x()));
    cells.at(index) = cell.stands ? standing : moving;
  }
  return cells;
}

/// Of the field `presence`: what is written does not change when the field tells more of them apart.
char code_of(Presence presence) {
  switch (presence) {
    case Presence::mapped:
      return 0;
    case Presence::standing:
      return 1;
    case Presence::legs:
    case Presence::waiting:
    case Presence::person:
      return 2;
    case Presence::hidden:
      break;
  }
  return 3;
}

}  // namespace

Json scan_message(Stamp stamp, const SeenSurroundings& seen) {
  constexpr std::size_t bytes_a_point = 3 * sizeof(float) + 1;
  std::string bytes;
  bytes.reserve(seen.points.size() * bytes_a_point);
  for (const SeenPoint& point : seen.points) {
    append(bytes, static_cast<float>(point.point_in_base.x()));
    append(bytes, static_cast<float>(point.point_in_base.y()));
    append(bytes, 0.0F);
    bytes += code_of(point.presence);
  }
  return {{"timestamp", time_json(stamp)},
          {"frame_id", seen_frame},
          {"pose", pose_json(lifted({}, scan_height_m))},
          {"point_stride", bytes_a_point},
          {"fields",
           {field_json("x", 0, float32_type), field_json("y", sizeof(float), float32_type),
            field_json("z", 2 * sizeof(float), float32_type),
            field_json("presence", 3 * sizeof(float), uint8_type)}},
          {"data", base64(bytes)}};
}

Json memory_message(Stamp stamp, const SeenSurroundings& seen) {
  const double cell_m = seen.cell_m;
  const Box box = box_around(seen);
  return {{"timestamp", time_json(stamp)},
          {"frame_id", seen_frame},
          {"pose", pose_json(lifted(seen.base_from_odom * Pose2{box.low_m, 0.0}))},
          {"column_count", box.columns},
          {"cell_size", {{"x", cell_m}, {"y", cell_m}}},
          {"row_stride", box.columns},
          {"cell_stride", 1},
          {"fields", {field_json("occupancy", 0, uint8_type)}},
          {"data", base64(cells_of(seen, box))}};
}

}  // namespace lodestar

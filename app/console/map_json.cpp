#include "app/console/map_json.hpp"

namespace lodestar {

nlohmann::ordered_json pose_json(const Pose2& pose) {
  return {{"x_m", pose.position_m.x()}, {"y_m", pose.position_m.y()}, {"yaw_deg", degrees(pose.yaw_rad)}};
}

nlohmann::ordered_json map_json(const OccupancyMap& map) {
  return {{"columns", map.columns},
          {"rows", map.rows},
          {"resolution_m", map.resolution_m},
          {"origin", pose_json(map.map_from_grid)}};
}

}  // namespace lodestar

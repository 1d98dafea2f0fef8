#include "app/ros2/ros2_topics.hpp"

#include <ros2_messages.h>

namespace lodestar::ros_topics {
namespace {

const char* const tf_hash = "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087";
const char* const pose_hash = "RIHS01_26432f9803e43727d3c8f668d1fdb3c630f548af631e2f4e31382371bfea3b6e";
constexpr TopicQos kept{.keeps_for_late = true, .depth = 1};
constexpr TopicQos passing{};

}  // namespace

const RosTopic tf{"tf", &tf2_msgs_msg_dds__TFMessage__desc, tf_hash, {.keeps_for_late = false, .depth = 100}};
const RosTopic tf_static{"tf_static", &tf2_msgs_msg_dds__TFMessage__desc, tf_hash, kept};
const RosTopic odom{"odom", &nav_msgs_msg_dds__Odometry__desc,
                    "RIHS01_3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0", passing};
const RosTopic amcl_pose{"amcl_pose", &geometry_msgs_msg_dds__PoseWithCovarianceStamped__desc, pose_hash,
                         kept};
const RosTopic map{"map", &nav_msgs_msg_dds__OccupancyGrid__desc,
                   "RIHS01_8d348150c12913a31ee0ec170fbf25089e4745d17035792a1ba94d6f0bc0cfc7", kept};
const RosTopic plan{"plan", &nav_msgs_msg_dds__Path__desc,
                    "RIHS01_1957a5bb3cee5da65c4e52e52b65a93df227efce4c20f8458b36e73066ca334b", kept};
const RosTopic scan{"scan",
                    &sensor_msgs_msg_dds__LaserScan__desc,
                    "RIHS01_64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828",
                    {.keeps_for_late = false, .depth = 5}};
const RosTopic diagnostics{"diagnostics", &diagnostic_msgs_msg_dds__DiagnosticArray__desc,
                           "RIHS01_5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e",
                           passing};
const RosTopic battery_state{"battery_state", &sensor_msgs_msg_dds__BatteryState__desc,
                             "RIHS01_4bee5dfce981c98faa6828b868307a0a73f992ed0789f374ee96c8f840e69741",
                             passing};
const RosTopic clock{"clock", &rosgraph_msgs_msg_dds__Clock__desc,
                     "RIHS01_692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564", passing};
const RosTopic initialpose{"initialpose", &geometry_msgs_msg_dds__PoseWithCovarianceStamped__desc, pose_hash,
                           passing};
const RosTopic goal_pose{"goal_pose", &geometry_msgs_msg_dds__PoseStamped__desc,
                         "RIHS01_10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8", passing};

}  // namespace lodestar::ros_topics

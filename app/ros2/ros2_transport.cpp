#include "app/ros2/ros2_transport.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <optional>
#include <ros2_messages.h>

#include "app/common/low_priority.hpp"
#include "app/ros2/dds_node.hpp"
#include "app/ros2/ros2_commands.hpp"
#include "app/ros2/ros2_publisher.hpp"
#include "app/ros2/ros2_topics.hpp"
#include "drivers/system/clock.hpp"

namespace lodestar {
namespace {

ReceivedPose received(const std_msgs_msg_dds__Header_& header, const geometry_msgs_msg_dds__Pose_& pose) {
  const auto& [position, turn] = pose;
  return {.frame = header.frame_id,
          .position_m = {position.x, position.y, position.z},
          .quaternion = {turn.x, turn.y, turn.z, turn.w}};
}

}  // namespace

class Ros2Transport::Node {
 public:
  Node(const Site& site, const Ros2Options& options, Ros2Link& link,
       std::function<void(Severity, const std::string&)> tell)
      : options_(options),
        link_(link),
        tell_(std::move(tell)),
        node_("lodestar", options),
        publisher_(node_, site, options) {
    if (options.takes_commands) {
      initialpose_ = node_.make_reader(ros_topics::initialpose);
      goal_ = node_.make_reader(ros_topics::goal_pose);
    }
    if (options.reads_odometry) odom_ = node_.make_reader(ros_topics::odom);
    node_.announce();
    publisher_.publish_scene(options.is_simulated ? Stamp{} : monotonic_now(), clock_offset());
  }

  void turn() {
    if (initialpose_) read_initial_poses();
    if (goal_) read_goals();
    if (odom_) read_odometry();
    for (const Ros2Report& report : link_.take_reports()) publisher_.publish(report, clock_offset());
  }

 private:
  [[nodiscard]] Duration clock_offset() const {
    return options_.is_simulated ? Duration{} : system_clock_offset();
  }

  void read_initial_poses() {
    using Message = geometry_msgs_msg_dds__PoseWithCovarianceStamped_;
    take_all<Message>(*initialpose_, [&](const Message& message) {
      std::array<double, 36> covariance{};
      std::ranges::copy(message.pose.covariance, covariance.begin());
      if (const auto pose = usable("initialpose", received(message.header, message.pose.pose)))
        give("initialpose", Ros2Place{*pose, placing_sigma(covariance)});
    });
  }

  void read_goals() {
    using Message = geometry_msgs_msg_dds__PoseStamped_;
    take_all<Message>(*goal_, [&](const Message& message) {
      if (const auto pose = usable("goal_pose", received(message.header, message.pose)))
        give("goal_pose", Ros2Goal{*pose});
    });
  }

  void read_odometry() {
    using Message = nav_msgs_msg_dds__Odometry_;
    take_all<Message>(*odom_, [&](const Message& message) {
      ReceivedPose pose = received(message.header, message.pose.pose);
      pose.frame = "map";  // whatever it is called: only differences count
      const auto found = usable("odom", pose);
      const auto& stamp = message.header.stamp;
      const Duration since =
          std::chrono::seconds(stamp.sec) + std::chrono::nanoseconds(stamp.nanosec) - clock_offset();
      if (found) link_.give(OdometryReading{.stamp = Stamp(since), .odom_from_base = *found});
    });
  }

  void give(const char* topic, const Ros2Command& command) {
    if (!link_.give(command)) refuse(topic, "too many at once");
  }

  std::optional<Pose2> usable(const char* topic, const ReceivedPose& pose) {
    const auto planar = planar_pose(pose);
    if (const auto* found = std::get_if<Pose2>(&planar)) return *found;
    refuse(topic, std::get<std::string>(planar));
    return std::nullopt;
  }

  /// Once for each new reason: a stranger may send a thousand.
  void refuse(const char* topic, const std::string& why) {
    std::string words = fmt::format("ros2: {} refused: {}", topic, why);
    if (words != said_) tell_(Severity::warning, words);
    said_ = std::move(words);
  }

  Ros2Options options_;
  Ros2Link& link_;
  std::function<void(Severity, const std::string&)> tell_;
  DdsNode node_;
  Ros2Publisher publisher_;
  std::optional<dds_entity_t> initialpose_;
  std::optional<dds_entity_t> goal_;
  std::optional<dds_entity_t> odom_;
  std::string said_;
};

Ros2Transport::Ros2Transport(const Site& site, const Ros2Options& options, Ros2Link& link,
                             std::function<void(Severity, const std::string&)> tell)
    : node_(std::make_unique<Node>(site, options, link, std::move(tell))),
      thread_([this](const std::stop_token& stop) {
        constexpr std::chrono::milliseconds period{5};
        lower_priority_of_this_thread();
        while (!stop.stop_requested()) {
          node_->turn();
          std::this_thread::sleep_for(period);
        }
        node_->turn();  // what came last
      }) {}

Ros2Transport::~Ros2Transport() = default;

}  // namespace lodestar

#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/console/camera_picture.hpp"
#include "app/console/lease.hpp"
#include "app/console/path_preview.hpp"
#include "app/live/live_channel.hpp"
#include "app/live/live_link.hpp"

namespace lodestar {

struct LiveViewOptions {
  Duration lease = std::chrono::seconds(1);  ///< the robot pauses when the driver is silent for so long
  Duration camera_period = std::chrono::milliseconds(200);  ///< between pictures
};

/// The page's own subprotocol, `lodestar.v1`: JSON both ways, pictures as binary messages (see
/// CameraPicture).
///
/// From here: `hello` first (role, number of the client, is there a robot), then `state`, `path` when it
/// changes, `preview`, and `refused` with the reason in words. To here: {"type": ...}
///   stop                                  by everyone who may view
///   camera   {on}                         pictures wanted, or not
///   preview  {goals}                      what would be driven: for those who may drive, as all below
///   take, hold, release                   the wheel: one driver at a time, who must hold it every so often
///   go {goals}, pause, resume, clear_fault, place {pose}      only with the wheel in hand
class LiveView : public LiveChannel {
 public:
  /// `link`: null when no robot is there. Both must outlive this.
  LiveView(const Site& site, LiveLink* link, const LiveViewOptions& options = {});

  [[nodiscard]] std::vector<SocketProtocol> protocols() override;
  [[nodiscard]] bool is_watched() const override { return !clients_.empty(); }
  void pump(Stamp now, const RobotState* fresh) override;
  /// Nothing here shows them but the page, which reads them by itself.
  void take_markers(const MarkerRegistry& /*saved*/) override {}

 private:
  class Session;
  struct Client {
    int number = 0;
    Role role = Role::view;
    Outbox* outbox = nullptr;
    bool wants_camera = false;
    std::optional<std::vector<Goal>> preview;  ///< asked for since the last pump
  };

  void welcome(Client& client);
  void part(const Client& client);
  void receive(Client& client, const nlohmann::json& message, Stamp now);
  /// What was wrong with it, in words; nothing when it was done.
  std::optional<std::string> obey(Client& client, const std::string& type, const nlohmann::json& message,
                                  Stamp now);
  std::optional<std::string> steer(const Client& client, const std::string& type,
                                   const nlohmann::json& message);
  void show(const RobotState& state, Stamp now);
  void show_path(const std::shared_ptr<const Path>& path);
  void show_camera(Stamp now);
  void answer_previews();

  LiveLink* link_;
  LiveViewOptions options_;
  PathPreview preview_;
  CameraPicture camera_;
  Lease lease_;
  std::vector<Client*> clients_;
  int welcomed_ = 0;
  std::optional<PoseEstimate> estimate_;
  std::optional<Frame> frame_;  ///< not shown yet
  Stamp last_picture_;
  SocketMessage state_;  ///< the newest, for those who come later
  std::shared_ptr<const Path> path_;
  SocketMessage path_message_;
};

}  // namespace lodestar

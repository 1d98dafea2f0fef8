#pragma once

#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/common/worker.hpp"
#include "app/console/camera_picture.hpp"
#include "app/console/lease.hpp"
#include "app/console/path_preview.hpp"
#include "app/live/live_channel.hpp"
#include "app/live/live_link.hpp"
#include "app/placement/live_survey.hpp"
#include "app/site/route_graph.hpp"

namespace lodestar {

template <typename View>
class ViewSession;

struct LiveViewOptions {
  Duration lease = std::chrono::seconds(1);  ///< the robot pauses when the driver is silent for longer
  Duration camera_period = std::chrono::milliseconds(200);  ///< of the pictures sent
  Duration seen_period = std::chrono::milliseconds(200);    ///< of what the scanner sees
};

/// A client for people: "client 2", or "client 2 (Ada)".
std::string in_words(int client, const std::string& name);

/// The page's own subprotocol, `lodestar.v1`: JSON both ways, pictures as binary messages (see
/// CameraPicture).
///
/// Server to client: `hello` first (role, client number, session, whether a robot is connected), then
/// `state`, `path` when it changes, `seen` by the scanner, `survey` (survey_json.hpp) when there is a new
/// estimate, `preview`, `asked` {client, name} when another asks the driver for control, `control` when it
/// was handed over to this client, `saved` {what} when someone saved the site's markers or places, and
/// `refused` with the reason in words. Client to server: {"type": ...}
///   stop                                  from anyone who may view
///   camera   {on}                         pictures on or off
///   name     {name}                       what others are to call this client
///   preview  {goals, routes}              plans without driving; needs the role drive, as do all below
///   take, hold, release                   the control lease: one driver at a time, who must keep renewing it
///   ask                                   asks the driver for it
///   hand_over {client}, keep {client}     the driver's answer
///   clear_fault, place {pose}             while no other client has the lease; they take none
///   go {goals or mission, routes, more}, charge, pause, resume, steer {forward_mps, turn_degps}    only from
///   the client that has the lease
/// `routes`, which may be left out: true for a way along the edges of the site's places; `more`: likewise,
/// behind the goals of the present drive; `mission`: the name of a saved one, with what is done at its stops.
class LiveView : public LiveChannel {
 public:
  /// `link`: null when no robot is connected. `survey`: the one under way; null when there is none. All must
  /// outlive this.
  LiveView(const Site& site, LiveLink* link, const LiveSurvey* survey = nullptr,
           const LiveViewOptions& options = {});

  [[nodiscard]] std::vector<SocketProtocol> protocols() override;
  [[nodiscard]] bool is_watched() const override { return !clients_.empty(); }
  void pump(Stamp now, const RobotState* fresh) override;
  /// Only what a survey is compared with: the page reads the markers itself.
  void take_markers(const MarkerRegistry& saved) override;
  /// Previews go by them soon after.
  void take_places(const Places& saved) override;

  /// The one lease of the robot, for other channels by which it can be driven; their clients have numbers
  /// below 0.
  [[nodiscard]] Lease& lease() { return lease_; }

 private:
  friend class ViewSession<LiveView>;
  /// Where a client wants the robot to drive.
  struct Wish {
    std::vector<Goal> goals;
    bool along_routes = false;
  };
  struct Client {
    int number = 0;
    std::string name;  ///< as its user gave it; may be empty
    Role role = Role::view;
    Outbox* outbox = nullptr;
    bool wants_camera = false;
    std::optional<Wish> preview;                 ///< requested, not begun yet
    std::future<nlohmann::ordered_json> answer;  ///< to the preview under way
  };

  void add_client(Client& client);
  void remove_client(const Client& client);
  void receive(Client& client, const nlohmann::json& message, Stamp now);
  /// The reason of a refusal, in words; nothing when it was done.
  std::optional<std::string> handle(Client& client, const std::string& type, const nlohmann::json& message,
                                    Stamp now);
  std::optional<std::string> handle_control(Client& client, const std::string& type,
                                            const nlohmann::json& message, Stamp now);
  std::optional<std::string> pass_request(const Client& client, Stamp now);
  std::optional<std::string> answer_request(const Client& driver, const std::string& type, int asker,
                                            Stamp now);
  [[nodiscard]] Client* find(int number) const;
  [[nodiscard]] std::string driver_in_words(Stamp now) const;
  std::optional<std::string> give_order(const Client& client, const std::string& type,
                                        const nlohmann::json& message);
  void show(const RobotState& state, Stamp now);
  void show_path(const std::shared_ptr<const Path>& path);
  void show_camera(Stamp now);
  void show_seen(const RobotState& state, Stamp now);
  void show_survey();
  void tell_saved(const std::string& what) const;
  void begin_previews();
  void show_previews();
  [[nodiscard]] nlohmann::ordered_json preview_of(const Wish& wish,
                                                  const std::optional<PoseEstimate>& robot) const;
  static Wish wish_from(const nlohmann::json& message);
  [[nodiscard]] Wish order_from(const nlohmann::json& message) const;
  [[nodiscard]] GoOrder go_order(const nlohmann::json& message) const;

  const Site& site_;
  LiveLink* link_;
  const LiveSurvey* survey_;
  MarkerRegistry registry_;
  Places places_;  ///< as saved
  RouteGraph routes_;
  LiveViewOptions options_;
  std::unique_ptr<const PathPreview> preview_;  ///< once constructed, only the worker uses it
  std::optional<Places> saved_places_;          ///< that previews do not go by yet
  CameraPicture camera_;
  Lease lease_;
  std::vector<Client*> clients_;
  int clients_so_far_ = 0;
  std::optional<PoseEstimate> estimate_;
  std::optional<Vec2> last_goal_m_;  ///< of the present drive
  std::optional<Frame> frame_;       ///< not shown yet
  Stamp last_picture_;
  Stamp last_seen_;
  std::int64_t session_;  ///< tells this program's run from others
  SocketMessage state_;   ///< the newest, for clients that connect later
  std::shared_ptr<const Path> path_;
  SocketMessage path_message_;
  std::uint64_t survey_number_ = 0;
  SocketMessage survey_message_;
  Worker planner_;  ///< of previews; ends before what it reads
};

}  // namespace lodestar

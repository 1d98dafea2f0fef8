#include "app/console/live_view.hpp"

#include <fmt/format.h>

#include "app/console/live_json.hpp"
#include "app/console/survey_json.hpp"
#include "app/console/view_session.hpp"
#include "drivers/system/clock.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::size_t most_previews = 8;  ///< that wait; later ones wait in their clients

enum Slot : int { state_slot, path_slot, picture_slot, preview_slot, survey_slot, seen_slot };

bool is_for_once(const std::string& type) {
  return type == "place" || type == "clear_fault";
}

}  // namespace

LiveView::LiveView(const Site& site, LiveLink* link, const LiveSurvey* survey, const LiveViewOptions& options)
    : site_(site),
      link_(link),
      survey_(survey),
      registry_(site.registry),
      places_(site.places),
      routes_(site.places, site.robot.max_forward_mps),
      options_(options),
      preview_(std::make_unique<const PathPreview>(site, site.places)),
      camera_(site.registry),
      lease_(options.lease),
      session_(monotonic_now().time_since_epoch().count()),
      planner_(most_previews) {}

std::vector<SocketProtocol> LiveView::protocols() {
  return {
      {.name = "lodestar.v1", .open = [this](Role role, Outbox& outbox) -> std::unique_ptr<SocketSession> {
         return std::make_unique<ViewSession<LiveView>>(*this, role, outbox);
       }}};
}

void LiveView::add_client(Client& client) {
  client.number = ++clients_so_far_;
  clients_.push_back(&client);
  client.outbox->queue(message_of({{"type", "hello"},
                                   {"client", client.number},
                                   {"role", to_string(client.role)},
                                   {"robot", link_ != nullptr},
                                   {"session", session_},
                                   {"survey", survey_ != nullptr},
                                   {"dock", site_.charging ? site_.charging->place : ""},
                                   {"lease_s", seconds(options_.lease)}}));
  if (path_message_.bytes) client.outbox->offer(path_slot, path_message_);
  if (state_.bytes) client.outbox->offer(state_slot, state_);
  if (survey_message_.bytes) client.outbox->offer(survey_slot, survey_message_);
}

void LiveView::remove_client(const Client& client) {
  std::erase(clients_, &client);
  lease_.release(client.number);
  if (link_ != nullptr) link_->hold_until(lease_.until());
}

void LiveView::receive(Client& client, const json& message, Stamp now) {
  const auto type = message.at("type").get<std::string>();
  if (const std::optional<std::string> why = handle(client, type, message, now)) {
    client.outbox->queue(message_of({{"type", "refused"}, {"what", type}, {"why", *why}}));
  }
  if (link_ != nullptr) link_->hold_until(lease_.until());
}

std::optional<std::string> LiveView::handle(Client& client, const std::string& type, const json& message,
                                            Stamp now) {
  if (link_ == nullptr) return "no robot is connected";
  if (type == "stop") {
    link_->stop(in_words(client.number, client.name));
    return std::nullopt;
  }
  if (type == "camera") {
    client.wants_camera = message.at("on").get<bool>();
    return std::nullopt;
  }
  try {
    if (type == "name") {
      client.name = name_from_json(message);
      return std::nullopt;
    }
    if (client.role < Role::drive) return "this needs the token to drive";
    if (type == "preview") {
      client.preview = wish_from(message);
      return std::nullopt;
    }
    return handle_control(client, type, message, now);
  } catch (const InputError& error) {
    return error.what();
  }
}

std::optional<std::string> LiveView::handle_control(Client& client, const std::string& type,
                                                    const json& message, Stamp now) {
  const bool is_free = lease_.holder(now).value_or(client.number) == client.number;
  if (type == "take") {
    if (lease_.take(client.number, now)) return std::nullopt;
    return driver_in_words(now) + " has control";
  }
  if (type == "release") {
    lease_.release(client.number);
    return std::nullopt;
  }
  if (type == "ask") return pass_request(client, now);
  if (type == "hand_over" || type == "keep")
    return answer_request(client, type, message.at("client").get<int>(), now);
  if (is_for_once(type) && !is_free) return driver_in_words(now) + " has control";
  if (!is_for_once(type) && !lease_.hold(client.number, now))
    return "this client does not have control: take it first";
  return give_order(client, type, message);
}

LiveView::Client* LiveView::find(int number) const {
  const auto found = std::ranges::find(clients_, number, &Client::number);
  return found == clients_.end() ? nullptr : *found;
}

std::string LiveView::driver_in_words(Stamp now) const {
  const std::optional<int> driver = lease_.holder(now);
  const Client* const client = driver ? find(*driver) : nullptr;
  if (client != nullptr) return in_words(client->number, client->name);
  return driver ? "a program of ROS" : "nobody";
}

/// Asks the driver on behalf of a client. A free lease is the client's at once.
std::optional<std::string> LiveView::pass_request(const Client& client, Stamp now) {
  if (lease_.take(client.number, now)) {
    client.outbox->queue(message_of({{"type", "control"}}));
    return std::nullopt;
  }
  const Client* const driver = find(*lease_.holder(now));
  if (driver == nullptr) return driver_in_words(now) + " drives, which cannot be asked: stop ends its drive";
  driver->outbox->queue(message_of({{"type", "asked"}, {"client", client.number}, {"name", client.name}}));
  return std::nullopt;
}

std::optional<std::string> LiveView::answer_request(const Client& driver, const std::string& type, int asker,
                                                    Stamp now) {
  if (lease_.holder(now) != driver.number) return "this client does not have control";
  const Client* const other = find(asker);
  if (other == nullptr || other->role < Role::drive || other == &driver)
    return "the client that asked has left";
  if (type == "keep") {
    other->outbox->queue(message_of({{"type", "refused"},
                                     {"what", "ask"},
                                     {"why", in_words(driver.number, driver.name) + " keeps control"}}));
    return std::nullopt;
  }
  (void)lease_.pass(driver.number, other->number, now);
  other->outbox->queue(message_of({{"type", "control"}}));
  return std::nullopt;
}

void LiveView::pump(Stamp now, const RobotState* fresh) {
  if (fresh != nullptr) show(*fresh, now);
  show_camera(now);
  show_survey();
  begin_previews();
  show_previews();
}

void LiveView::show(const RobotState& state, Stamp now) {
  estimate_ = state.estimate;
  last_goal_m_.reset();
  if (state.current < state.goals.size()) last_goal_m_ = state.goals.back().position_m;
  frame_ = state.frame;
  if (state.path != path_) show_path(state.path);
  ordered_json content = state_json(state);
  const std::optional<int> driver = lease_.holder(now);
  content["driver"] = driver ? ordered_json(*driver) : ordered_json(nullptr);
  const Client* const driving = driver ? find(*driver) : nullptr;
  const bool is_program = driver && driving == nullptr;
  content["driver_name"] = is_program ? "a program of ROS" : driving != nullptr ? driving->name : "";
  content["viewers"] = clients_.size();
  state_ = message_of(content);
  for (const Client* const client : clients_) client->outbox->offer(state_slot, state_);
  show_seen(state, now);
}

/// Less often than the rest: hundreds of points, and no scanner turns 20 times a second.
void LiveView::show_seen(const RobotState& state, Stamp now) {
  if (!state.seen || now - last_seen_ < options_.seen_period) return;
  last_seen_ = now;
  const SocketMessage message = message_of(seen_json(state));
  for (const Client* const client : clients_) client->outbox->offer(seen_slot, message);
}

void LiveView::show_path(const std::shared_ptr<const Path>& path) {
  path_ = path;
  path_message_ = message_of({{"type", "path"}, {"points", points_json(path ? *path : Path{})}});
  for (const Client* const client : clients_) client->outbox->offer(path_slot, path_message_);
}

void LiveView::show_camera(Stamp now) {
  const bool is_wanted = std::ranges::any_of(clients_, &Client::wants_camera);
  if (!is_wanted || !frame_ || now - last_picture_ < options_.camera_period) return;
  last_picture_ = now;
  std::optional<std::string> bytes = camera_.message(*std::exchange(frame_, std::nullopt));
  if (!bytes) return;
  const SocketMessage message{.bytes = std::make_shared<const std::string>(std::move(*bytes)),
                              .binary = true};
  for (const Client* const client : clients_) {
    if (client->wants_camera) client->outbox->offer(picture_slot, message);
  }
}

void LiveView::show_survey() {
  if (survey_ == nullptr) return;
  const std::shared_ptr<const SurveyProgress> progress = survey_->newest();
  if (!progress || progress->number == survey_number_) return;
  survey_number_ = progress->number;
  survey_message_ = message_of(survey_json(*progress, registry_));
  for (const Client* const client : clients_) client->outbox->offer(survey_slot, survey_message_);
}

void LiveView::take_markers(const MarkerRegistry& saved) {
  registry_ = saved;
  tell_saved("markers");
}

void LiveView::take_places(const Places& saved) {
  saved_places_ = saved;
  places_ = saved;
  routes_ = RouteGraph(saved, site_.robot.max_forward_mps);
  tell_saved("places");
}

void LiveView::tell_saved(const std::string& what) const {
  for (const Client* const client : clients_)
    client->outbox->queue(message_of({{"type", "saved"}, {"what", what}}));
}

/// Planning takes seconds on large maps, so the worker does it: each client has at most one preview under
/// way. The planner for new zones goes before those that are waiting.
void LiveView::begin_previews() {
  if (saved_places_ && planner_.give([this, places = *saved_places_](const std::stop_token&) {
        preview_ = std::make_unique<const PathPreview>(site_, places);
      }))
    saved_places_.reset();
  for (Client* const client : clients_) {
    if (!client->preview || client->answer.valid()) continue;
    const auto answer = std::make_shared<std::promise<ordered_json>>();
    const auto plan = [this, answer, wish = *client->preview, robot = estimate_](const std::stop_token&) {
      answer->set_value(preview_of(wish, robot));
    };
    if (!planner_.give(plan)) return;
    client->answer = answer->get_future();
    client->preview.reset();
  }
}

/// Answers to goals that the client has changed since are dropped.
void LiveView::show_previews() {
  for (Client* const client : clients_) {
    if (!client->answer.valid() || client->answer.wait_for(Duration{}) != std::future_status::ready) continue;
    ordered_json answer = client->answer.get();
    answer["type"] = "preview";
    if (!client->preview) client->outbox->offer(preview_slot, message_of(answer));
  }
}

ordered_json LiveView::preview_of(const Wish& wish, const std::optional<PoseEstimate>& robot) const {
  if (!robot) return {{"why", "the robot does not know where it is"}};
  try {
    const Pose2& start = robot->map_from_base;
    return wish.along_routes ? preview_->plan_over_edges(start, wish.goals)
                             : preview_->plan(start, wish.goals);
  } catch (const std::exception& error) {
    return {{"why", error.what()}};
  }
}

}  // namespace lodestar

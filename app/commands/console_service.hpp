#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "app/console/document_api.hpp"
#include "app/console/live_view.hpp"
#include "app/net/http_server.hpp"

namespace lodestar {

struct ConsoleServiceOptions {
  AccessRules access;
  std::filesystem::path site;
  std::filesystem::path runs;
  LiveViewOptions live;
  bool may_change_map = false;  ///< the service must be made anew when it has been
};

/// The console service: the document API and the live channels.
class ConsoleService {
 public:
  /// `link`: the robot to show, `survey`: the one under way; null when there is none. Throws InputError for
  /// an unusable site or address.
  ConsoleService(const ConsoleServiceOptions& options, LiveLink* link, const LiveSurvey* survey = nullptr);

  [[nodiscard]] unsigned short port() const { return server_->port(); }

  /// Something that happened to the robot, for the log of who drove. May be called from any thread.
  void note(const std::string& words) { documents_.audit().note({.what = words, .document = {}}); }

  /// A client has saved another map.
  [[nodiscard]] bool has_new_map() const { return has_new_map_; }

  /// One turn of about 50 ms: serves all clients, then sends them what is new. An exception costs its step of
  /// the turn and is logged; it never ends the program, which may be driving a robot.
  void serve_a_turn();

 private:
  void attempt(const std::function<void()>& step);
  void tell_of_saved_documents();

  DocumentApi documents_;
  LiveLink* link_;
  std::vector<std::unique_ptr<LiveChannel>>
      channels_;       ///< declared before the server, whose sessions refer to them
  std::mutex saving_;  ///< of what follows: markers are saved on another thread of the server
  std::optional<MarkerRegistry> saved_;
  std::optional<Places> saved_places_;
  std::atomic<bool> has_new_map_ = false;
  std::optional<PlacesOrder> untold_places_;  ///< to the robot: its orders wait in a short queue
  std::unique_ptr<HttpServer> server_;
  std::string last_error_;  ///< logged once, not in every turn
};

/// Serves on a thread of its own, with lower priority than the control loop, for the lifetime of this object.
class ConsoleThread {
 public:
  explicit ConsoleThread(ConsoleService& service);
  ~ConsoleThread();
  ConsoleThread(const ConsoleThread&) = delete;
  ConsoleThread& operator=(const ConsoleThread&) = delete;

 private:
  std::atomic<bool> ended_ = false;
  std::thread thread_;
};

}  // namespace lodestar

#pragma once

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "app/console/document_api.hpp"
#include "app/console/live_view.hpp"
#include "app/net/http_server.hpp"

namespace lodestar {

struct ConsoleServiceOptions {
  AccessRules access;
  std::filesystem::path site;
  std::filesystem::path runs = "runs";
  LiveViewOptions live;
};

/// The whole console: documents, and live channels beside them.
class ConsoleService {
 public:
  /// `link`: the robot that is shown; null when none is there. Throws InputError for a site or an address
  /// that cannot be used.
  ConsoleService(const ConsoleServiceOptions& options, LiveLink* link);

  [[nodiscard]] unsigned short port() const { return server_->port(); }

  /// One turn, about a twentieth of a second: serves all clients, then shows them what is new.
  void serve_a_turn();

 private:
  DocumentApi console_;
  LiveLink* link_;
  std::vector<std::unique_ptr<LiveChannel>> channels_;  ///< before the server, whose sessions know them
  std::unique_ptr<HttpServer> server_;
};

/// Serves on a thread of its own, one that yields to the control loop's, as long as this lives.
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

#include "app/commands/console_service.hpp"

#include <fmt/format.h>
#include <utility>

#include "app/common/log.hpp"
#include "app/common/low_priority.hpp"
#include "app/console/rosbridge_view.hpp"
#include "app/viewers/foxglove_view.hpp"
#include "drivers/system/clock.hpp"

namespace lodestar {
namespace {

constexpr std::chrono::milliseconds turn{50};

std::vector<SocketProtocol> protocols_of(const std::vector<std::unique_ptr<LiveChannel>>& channels) {
  std::vector<SocketProtocol> protocols;
  for (const auto& channel : channels)
    for (SocketProtocol& protocol : channel->protocols()) protocols.push_back(std::move(protocol));
  return protocols;
}

/// What the running robot is told of saved places.
PlacesOrder places_order(const Places& places, const Site& site) {
  PlacesOrder order{.zones = {places.keep_out, places.speed_zones}, .map_from_dock = {}};
  if (const auto charging = charging_at(site.charging, places)) order.map_from_dock = charging->map_from_dock;
  return order;
}

}  // namespace

ConsoleService::ConsoleService(const ConsoleServiceOptions& options, LiveLink* link, const LiveSurvey* survey)
    : documents_(options.site, options.runs), link_(link) {
  auto page = std::make_unique<LiveView>(documents_.site(), link, survey, options.live);
  if (link != nullptr)
    channels_.push_back(std::make_unique<RosbridgeView>(documents_.site(), *link, page->lease()));
  channels_.push_back(std::move(page));
  channels_.push_back(std::make_unique<FoxgloveView>(documents_.site()));
  documents_.on_saved_markers([this](const MarkerRegistry& saved) {
    log_info(fmt::format("{} markers were saved through the console", saved.markers.size()));
    const std::lock_guard lock(saving_);
    saved_ = saved;
  });
  documents_.on_saved_places([this](const Places& saved) {
    log_info("places and zones were saved through the console");
    const std::lock_guard lock(saving_);
    saved_places_ = saved;
  });
  if (options.may_change_map)
    documents_.on_saved_map([this] {
      log_info("the map was saved through the console");
      has_new_map_ = true;
    });
  server_ = std::make_unique<HttpServer>(
      HttpServerOptions{.access = options.access,
                        .takes_long = DocumentApi::takes_long,
                        .uses_files = DocumentApi::uses_files},
      [this](const HttpRequest& request) { return documents_.answer(request); }, protocols_of(channels_));
}

void ConsoleService::serve_a_turn() {
  attempt([this] { server_->run_for(turn); });
  tell_of_saved_documents();
  const std::optional<RobotState> fresh = link_ != nullptr ? link_->newest() : std::nullopt;
  const Stamp now = monotonic_now();
  for (const auto& channel : channels_) attempt([&] { channel->pump(now, fresh ? &*fresh : nullptr); });
  const bool watched =
      std::ranges::any_of(channels_, [](const auto& channel) { return channel->is_watched(); });
  if (watched && link_ != nullptr) link_->want_state();
}

void ConsoleService::tell_of_saved_documents() {
  std::unique_lock lock(saving_);
  const std::optional<MarkerRegistry> markers = std::exchange(saved_, std::nullopt);
  const std::optional<Places> places = std::exchange(saved_places_, std::nullopt);
  lock.unlock();
  for (const auto& channel : channels_) {
    if (markers) attempt([&] { channel->take_markers(*markers); });
    if (places) attempt([&] { channel->take_places(*places); });
  }
  if (places) untold_places_ = places_order(*places, documents_.site());
  if (link_ == nullptr || !untold_places_) return;
  if (link_->give({.by = "saved", .what = *untold_places_})) untold_places_.reset();
}

void ConsoleService::attempt(const std::function<void()>& step) {
  try {
    step();
  } catch (const std::exception& error) {
    if (last_error_ == error.what()) return;
    last_error_ = error.what();
    log_warning(fmt::format("console: {}", last_error_));
  }
}

ConsoleThread::ConsoleThread(ConsoleService& service)
    : thread_([this, &service] {
        lower_priority_of_this_thread();
        while (!ended_) service.serve_a_turn();
      }) {}

ConsoleThread::~ConsoleThread() {
  ended_ = true;
  thread_.join();
}

}  // namespace lodestar

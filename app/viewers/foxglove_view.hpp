#pragma once

#include <memory>

#include "app/live/live_channel.hpp"
#include "app/site/site.hpp"
#include "app/viewers/foxglove_hub.hpp"
#include "app/viewers/foxglove_messages.hpp"

namespace lodestar {

/// The console's live robot state for Foxglove and other viewers: the live ones of drive_channels().
class FoxgloveView : public LiveChannel {
 public:
  explicit FoxgloveView(const Site& site);

  [[nodiscard]] std::vector<SocketProtocol> protocols() override { return hub_.protocols(); }
  [[nodiscard]] bool is_watched() const override { return hub_.has_viewers(); }
  void pump(Stamp now, const RobotState* fresh) override;
  void take_markers(const MarkerRegistry& saved) override;

 private:
  void show(const RobotState& state);

  MarkerRegistry registry_;
  RobotBody body_;
  FoxgloveHub hub_;
  std::shared_ptr<const Path> path_;
  std::vector<int> distrusted_;
  std::uint64_t last_event_ = 0;
  Stamp now_;  ///< of the newest state
};

}  // namespace lodestar

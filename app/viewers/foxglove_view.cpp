#include "app/viewers/foxglove_view.hpp"

#include "app/navigation/navigation_setup.hpp"
#include "app/viewers/drive_messages.hpp"
#include "maps/picture.hpp"

namespace lodestar {

FoxgloveView::FoxgloveView(const Site& site)
    : registry_(site.registry), body_(body_of(site.robot)), hub_("Lodestar: " + site.name, drive_channels()) {
  for (const Message& message : scene_messages(known_world(site, site.default_camera), Stamp()))
    hub_.publish(message);
}

void FoxgloveView::pump(Stamp /*now*/, const RobotState* fresh) {
  if (fresh == nullptr) return;
  now_ = fresh->now;
  if (hub_.has_viewers()) show(*fresh);
}

void FoxgloveView::take_markers(const MarkerRegistry& saved) {
  registry_ = saved;
  hub_.publish(ceiling_message(now_, registry_, distrusted_));
}

void FoxgloveView::show(const RobotState& state) {
  const auto publish = [this](const std::vector<Message>& messages) {
    for (const Message& message : messages) hub_.publish(message);
  };
  if (state.estimate) {
    publish(estimate_messages({.estimate = *state.estimate,
                               .commanded = state.commanded,
                               .measured = state.measured,
                               .base = state.base,
                               .fault = state.fault,
                               .stop = state.stop,
                               .slowed_by = state.slowed_by},
                              body_));
    if (state.error) publish({error_message(*state.estimate, *state.error)});
  }
  if (state.seen) publish(seen_messages(state.now, *state.seen));
  if (state.path && state.path != path_) publish({planned_message(state.now, *state.path)});
  path_ = state.path;
  const std::vector<int> distrusted = ids_of(state.distrusted);
  if (distrusted != distrusted_) publish({ceiling_message(state.now, registry_, distrusted)});
  distrusted_ = distrusted;
  for (const DriveEvent& event : state.events) {
    if (event.number > last_event_) publish({words_message(event.stamp, LogLevel::info, event.words)});
  }
  if (!state.events.empty()) last_event_ = state.events.back().number;
  if (state.frame && hub_.is_heard(camera_channel))
    publish({camera_message(state.frame->stamp, jpeg_bytes(state.frame->gray))});
}

}  // namespace lodestar

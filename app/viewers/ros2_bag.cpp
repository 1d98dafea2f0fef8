#include "app/viewers/ros2_bag.hpp"

#include "app/ros2/ros_types.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

Ros2Options as_published(const Ros2BagOptions& options) {
  return {.is_simulated = options.is_simulated};
}

}  // namespace

int Ros2Bag::File::open(const RosTopic& topic) {
  const std::string type = ros_name(*topic.type);
  channels_.push_back({.topic = std::string("/") + topic.name,
                       .schema_name = type,
                       .schema = ros_definition(type),
                       .schema_encoding = "ros2msg",
                       .encoding = "cdr"});
  types_.push_back(topic.type);
  return static_cast<int>(types_.size()) - 1;
}

void Ros2Bag::File::begin() {
  mcap_ = std::make_unique<McapFile>(name_, channels_, McapOptions{.profile = "ros2"});
}

void Ros2Bag::File::write(int topic, const void* message, Stamp stamp) {
  const auto channel = static_cast<std::size_t>(topic);
  mcap_->write({.channel = channel, .stamp = stamp, .content = as_cdr(*types_.at(channel), message)});
  if (!mcap_->healthy()) throw InputError(name_, 0, "a file that cannot be written", "one that can");
}

void Ros2Bag::File::finish() {
  mcap_->finish();
  if (!mcap_->healthy()) throw InputError(name_, 0, "a file that cannot be written", "one that can");
}

Ros2Bag::Ros2Bag(const std::filesystem::path& file, const Site& site, const Ros2BagOptions& options)
    : session_(link_, as_published(options), site.robot.track_width_m),
      file_(file),
      publisher_(file_, site, as_published(options)),
      clock_offset_(options.clock_offset),
      writer_({.most_waiting = 512, .can_wait = options.is_simulated, .tell = options.tell},  // ten seconds
              [this](const Ros2Report& report) { publisher_.publish(report, clock_offset_); }) {
  file_.begin();
}

void Ros2Bag::attend(const SensorInput& input, const MissionStep& step, Mission& mission) {
  if (!has_begun_) publisher_.publish_scene(input.now, clock_offset_);
  has_begun_ = true;
  session_.attend(input, step, mission);
  for (Ros2Report& report : link_.take_reports()) writer_.put(std::move(report));
}

std::string Ros2Bag::finish() {
  WriterCounts counts = writer_.finish();
  try {
    file_.finish();
  } catch (const InputError& error) {
    if (counts.error.empty()) counts.error = error.what();
  }
  return counts.loss("the bag");
}

}  // namespace lodestar

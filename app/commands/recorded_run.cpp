#include "app/commands/recorded_run.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "app/common/low_priority.hpp"
#include "app/common/wall_clock.hpp"
#include "app/navigation/navigation_setup.hpp"
#include "app/recording/run_origin.hpp"
#include "app/report/run_folder.hpp"
#include "drivers/system/clock.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

std::string lost_pictures(const RunRecord& record) {
  const auto unmade = std::ranges::count_if(
      record.pictures, [](const KeptPicture& picture) { return picture.jpeg.get().empty(); });
  const auto lost = static_cast<std::ptrdiff_t>(record.dropped_pictures) + unmade;
  if (lost == 0) return {};
  return fmt::format("pictures: {} of {} are missing", lost,
                     static_cast<std::size_t>(record.dropped_pictures) + record.pictures.size());
}

}  // namespace

RecordedRun::RecordedRun(std::filesystem::path folder, const Site& site, const std::string& camera,
                         const RunFolderOptions& options)
    : folder_(std::move(folder)),
      site_(site),
      disk_(options.disk),
      mcap_(folder_, known_world(site, camera), body_of(site.robot),
            {.can_wait = options.can_wait, .tell = once(options.tell), .disk = options.disk}),
      can_log_(folder_ / "can.log", {.interface = options.interface,
                                     .can_wait = options.can_wait,
                                     .tell = once(options.tell),
                                     .disk = options.disk}),
      sighting_log_(folder_, site.robot, site.cameras.at(camera),
                    {.can_wait = options.can_wait, .tell = once(options.tell), .disk = options.disk}) {
  origin_ =
      std::async(std::launch::async,
                 [&site, folder = folder_,
                  origin = RunOrigin{
                      .started = utc_text(),
                      .program = LODESTAR_VERSION,
                      .site = site.name,
                      .seed = options.seed,
                      .clock_offset = options.seed ? std::nullopt : std::optional(system_clock_offset())}] {
                   lower_priority_of_this_thread();
                   write_run_origin(folder, origin, site.map.map, site.registry);
                 });
  if (site.robot.scanner)
    scan_log_.emplace(
        folder_, site.robot.scanner->mount,
        ScanLogOptions{.can_wait = options.can_wait, .tell = once(options.tell), .disk = options.disk});
}

std::function<void(const std::string&)> RecordedRun::once(std::function<void(const std::string&)> tell) {
  if (!tell) return {};
  return [this, next = std::move(tell)](const std::string& words) {
    if (!has_told_.exchange(true)) next(words);
  };
}

DriveWatcher RecordedRun::watcher() {
  return {.step =
              [this](const DriveMoment& moment) {
                mcap_.watch(moment);
                sighting_log_.take(moment.input);
                if (scan_log_) scan_log_->take(moment.input);
              },
          .can_frame = [this](const StampedCanFrame& frame) { can_log_.take(frame); }};
}

RunFolderEnd RecordedRun::finish(const RunRecord& record) {
  RunFolderEnd end;
  const auto remember = [&end](const std::string& loss) {
    if (!loss.empty()) end.loss += (end.loss.empty() ? "" : "; ") + loss;
  };
  try {
    origin_.get();
  } catch (const InputError& error) {
    remember(error.what());
  }
  mcap_.add_truth(record);
  remember(can_log_.finish());
  remember(mcap_.finish());
  remember(sighting_log_.finish());
  if (scan_log_) remember(scan_log_->finish());
  remember(lost_pictures(record));
  try {
    if (disk_.is_full && disk_.is_full()) throw InputError("the disk is full");
    write_run_folder(folder_, record, site_.map.map, site_.registry, site_.places);
    end.has_report = true;
  } catch (const InputError& error) {
    remember(error.what());
  }
  return end;
}

}  // namespace lodestar

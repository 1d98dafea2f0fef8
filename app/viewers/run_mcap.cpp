#include "app/viewers/run_mcap.hpp"

#include <utility>

#include "app/report/run_folder.hpp"
#include "maps/input_error.hpp"

namespace lodestar {

RunMcap::RunMcap(const std::filesystem::path& folder, const KnownWorld& world, RobotBody body,
                 const RunMcapOptions& options)
    : messages_(world, std::move(body)),
      file_name_(folder / "run.mcap"),
      writer_({.most_waiting = options.most_waiting_bytes,
               .can_wait = options.can_wait,
               .tell = options.tell,
               .disk = options.disk},
              [this](const Portion& portion) { write(portion); }) {
  make_run_folder(folder);
  file_ = std::make_unique<McapFile>(file_name_, drive_channels());
}

void RunMcap::watch(const DriveMoment& moment) {
  take({.messages = messages_.of(moment), .picture = moment.picture});
}

void RunMcap::add_truth(const RunRecord& record) {
  take({.messages = truth_messages(record), .picture = std::nullopt});
}

void RunMcap::take(Portion portion) {
  constexpr std::size_t bytes_of_picture = 64U << 10U;  // estimate: it may not have been encoded yet
  std::size_t bytes = portion.picture ? bytes_of_picture : 0;
  for (const Message& message : portion.messages) bytes += message.content.size();
  writer_.put(std::move(portion), bytes);
}

void RunMcap::write(const Portion& portion) {
  for (const Message& message : portion.messages) file_->write(message);
  const std::string jpeg = portion.picture ? portion.picture->jpeg.get() : "";
  if (!jpeg.empty()) file_->write(camera_message(portion.picture->stamp, jpeg));
  if (!file_->healthy()) throw InputError(file_name_, 0, "a file that cannot be written", "one that can");
}

std::string RunMcap::finish() {
  WriterCounts counts = writer_.finish();
  file_->finish();
  if (!file_->healthy() && counts.error.empty()) counts.error = file_name_.string() + ": cannot be written";
  return counts.loss("run.mcap");
}

}  // namespace lodestar

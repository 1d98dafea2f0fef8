#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "app/common/background_writer.hpp"
#include "app/report/run_record.hpp"
#include "app/viewers/drive_messages.hpp"
#include "app/viewers/mcap_file.hpp"

namespace lodestar {

struct RunMcapOptions {
  /// Limit of the queue for a slow disk. When it is full: `can_wait` blocks the drive until there is room;
  /// otherwise (real time) data is skipped and the file has a gap.
  std::size_t most_waiting_bytes = std::size_t{64} << 20U;
  bool can_wait = false;
  /// Called once, from the file's own thread, with a message when the file is no longer complete.
  std::function<void(const std::string&)> tell;
  DiskState disk;
};

/// Writes run.mcap into a run folder during the drive, for Foxglove, Lichtblick or any other reader of MCAP
/// files. It is compressed and written on a thread of its own, so that a slow disk never delays wheel
/// commands.
class RunMcap {
 public:
  /// Creates the folder. Throws InputError when it or the file cannot be created.
  RunMcap(const std::filesystem::path& folder, const KnownWorld& world, RobotBody body,
          const RunMcapOptions& options = {});
  RunMcap(const RunMcap&) = delete;
  RunMcap& operator=(const RunMcap&) = delete;

  void watch(const DriveMoment& moment);

  /// After a simulated drive: adds ground truth.
  void add_truth(const RunRecord& record);

  /// Waits until everything is written, and closes the file; the destructor does so too. Returns what is
  /// missing in the file and why; empty when it is complete.
  std::string finish();

 private:
  /// An item to be written. Its picture may not have been encoded yet.
  struct Portion {
    std::vector<Message> messages;
    std::optional<KeptPicture> picture;
  };

  void take(Portion portion);
  void write(const Portion& portion);

  DriveMessages messages_;
  std::filesystem::path file_name_;
  std::unique_ptr<McapFile> file_;  ///< the writer's alone while it works
  BackgroundWriter<Portion> writer_;
};

}  // namespace lodestar

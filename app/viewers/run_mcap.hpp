#pragma once

#include <condition_variable>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "app/report/run_record.hpp"
#include "app/viewers/drive_messages.hpp"
#include "app/viewers/mcap_file.hpp"

namespace lodestar {

struct RunMcapOptions {
  /// Limit of the queue for a slow disk. When it is full: `can_wait` blocks the drive until there is room;
  /// otherwise (real time) data is skipped and the file has a gap.
  std::size_t most_waiting_bytes = std::size_t{64} << 20U;
  bool can_wait = false;
  /// State of a simulated disk that is full or slow; unset for the real disk.
  std::function<bool()> is_full;
  std::function<Duration()> delay;
};

/// Writes run.mcap into a run folder during the drive, for Foxglove, Lichtblick or any other reader of MCAP
/// files. It is compressed and written on a thread of its own, so that a slow disk never delays wheel
/// commands.
class RunMcap {
 public:
  /// The message when finish() returns false.
  static constexpr const char* words_of_loss = "the disk did not take all of run.mcap";

  /// Creates the folder. Throws InputError when it or the file cannot be created.
  RunMcap(const std::filesystem::path& folder, const KnownWorld& world, RobotBody body,
          const RunMcapOptions& options = {});
  RunMcap(const RunMcap&) = delete;
  RunMcap& operator=(const RunMcap&) = delete;
  /// Writes what is left.
  ~RunMcap();

  void watch(const DriveMoment& moment);

  /// After a simulated drive: adds ground truth.
  void add_truth(const RunRecord& record);

  /// Waits until everything is written. False when data was lost.
  [[nodiscard]] bool finish();

 private:
  /// An item to be written. Its picture may not have been encoded yet.
  struct Portion {
    std::vector<Message> messages;
    std::optional<KeptPicture> picture;
  };

  void take(Portion portion);
  void work();
  void write(const Portion& portion);

  RunMcapOptions options_;
  DriveMessages messages_;
  std::unique_ptr<McapFile> file_;  ///< the writer's alone while it works
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Portion> waiting_;
  std::size_t waiting_bytes_ = 0;
  bool has_skipped_ = false;
  bool ends_ = false;
  std::thread writer_;
};

}  // namespace lodestar

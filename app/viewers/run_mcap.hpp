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
  /// What may wait for a slow disk. Beyond it a drive in real time goes on without a gap and the file has
  /// one; a drive that can wait does.
  std::size_t most_waiting_bytes = std::size_t{64} << 20U;
  bool can_wait = false;
  /// How a disk fares that is known to be full or slow, as that of a simulated world; else the real one
  /// tells.
  std::function<bool()> is_full;
  std::function<Duration()> delay;
};

/// Writes run.mcap into a run folder while the robot drives: open it in Foxglove, Lichtblick or any other
/// reader of MCAP files. It is compressed and written on the side, so that no disk holds the wheels' commands
/// up.
class RunMcap {
 public:
  /// What people are told when finish() says no.
  static constexpr const char* words_of_loss = "the disk did not take all of run.mcap";

  /// Makes the folder. Throws InputError when that or the file cannot be made.
  RunMcap(const std::filesystem::path& folder, const KnownWorld& world, RobotBody body,
          const RunMcapOptions& options = {});
  RunMcap(const RunMcap&) = delete;
  RunMcap& operator=(const RunMcap&) = delete;
  /// Writes what is left.
  ~RunMcap();

  void watch(const DriveMoment& moment);

  /// After the drive: what only its judge knows.
  void add_truth(const RunRecord& record);

  /// Waits until all is written. Has the disk taken it?
  [[nodiscard]] bool finish();

 private:
  /// What is to be written next. A picture may still be in the making.
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

#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "app/viewers/channel.hpp"

namespace lodestar {

struct McapOptions {
  std::size_t chunk_bytes = 256 * 1024;  ///< of messages, before compression; a chunk is written when full
  Duration chunk_time = std::chrono::seconds(2);  ///< or when its messages span this time
  int compression_level = 3;                      ///< of zstd
  std::string profile;                            ///< "ros2", or none
};

/// Writes messages to an MCAP file (version 0 of the format) as they arrive: in chunks, each compressed, with
/// a CRC and an index by time; at the end a summary of all indexes. A truncated file can still be read chunk
/// by chunk. The same channels and messages give the same bytes.
class McapFile {
 public:
  /// Throws InputError when the file cannot be created.
  McapFile(const std::filesystem::path& file, const std::vector<Channel>& channels,
           const McapOptions& options = {});
  /// Finishes the file.
  ~McapFile();
  McapFile(const McapFile&) = delete;
  McapFile& operator=(const McapFile&) = delete;

  /// Stamps need not ascend. A failed write loses data; healthy() reports it.
  void write(const Message& message);

  /// Writes the end of the file; nothing can be written after it.
  void finish();

  [[nodiscard]] bool healthy() const { return file_.good(); }

 private:
  struct IndexEntry {
    std::uint64_t time_ns = 0;
    std::uint64_t offset = 0;  ///< in the chunk, uncompressed
  };
  struct Chunk {
    std::uint64_t first_ns = UINT64_MAX;
    std::uint64_t last_ns = 0;
    std::string records;
    std::map<std::uint16_t, std::vector<IndexEntry>> index;  ///< by channel
  };

  void put(const std::string& bytes);
  void finish_chunk();
  [[nodiscard]] std::string statistics() const;

  McapOptions options_;
  std::ofstream file_;
  bool finished_ = false;
  std::uint64_t written_ = 0;
  std::string schemas_;   ///< their records, as at the beginning of the file
  std::string channels_;  ///< likewise
  std::uint16_t schema_count_ = 0;
  std::uint16_t channel_count_ = 0;
  Chunk chunk_;
  std::string chunk_indexes_;
  std::uint32_t chunk_count_ = 0;
  std::map<std::uint16_t, std::uint64_t> messages_;  ///< count, by channel
  std::uint64_t first_ns_ = UINT64_MAX;
  std::uint64_t last_ns_ = 0;
};

}  // namespace lodestar

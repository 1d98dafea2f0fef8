#include "app/viewers/mcap_file.hpp"

#include <algorithm>
#include <boost/crc.hpp>
#include <concepts>
#include <utility>
#include <zstd.h>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

constexpr const char* magic = "\x89MCAP0\r\n";

enum class Op : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  statistics = 0x0B,
  summary_offset = 0x0E,
  data_end = 0x0F,
};

/// Serialization of the format: little-endian numbers; strings and lists prefixed with their length.
class Bytes {
 public:
  template <std::unsigned_integral T>
  Bytes& number(T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i)
      text_ += static_cast<char>(static_cast<unsigned char>((value >> (8U * i)) & 0xFFU));
    return *this;
  }
  Bytes& text(std::string_view value) { return number(static_cast<std::uint32_t>(value.size())).raw(value); }
  Bytes& raw(std::string_view value) {
    text_ += value;
    return *this;
  }
  [[nodiscard]] const std::string& get() const { return text_; }

 private:
  std::string text_;
};

std::string record(Op op, const Bytes& body) {
  return Bytes()
      .number(static_cast<std::uint8_t>(op))
      .number(static_cast<std::uint64_t>(body.get().size()))
      .raw(body.get())
      .get();
}

std::uint32_t crc_of(std::string_view bytes) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

std::uint64_t nanoseconds(Stamp stamp) {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(stamp.time_since_epoch().count(), 0));
}

std::string compressed(const std::string& bytes, int level) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size = ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), level);
  packed.resize(ZSTD_isError(size) != 0U ? 0 : size);
  return packed;
}

std::string summary_offset(Op group, std::uint64_t start, std::uint64_t end) {
  if (start == end) return "";
  return record(Op::summary_offset,
                Bytes().number(static_cast<std::uint8_t>(group)).number(start).number(end - start));
}

}  // namespace

McapFile::McapFile(const std::filesystem::path& file, const std::vector<Channel>& channels,
                   const McapOptions& options)
    : options_(options), file_(file, std::ios::binary | std::ios::trunc) {
  if (!file_) throw InputError(file, 0, "a file that cannot be written", "one that can");
  std::map<std::string, std::uint16_t> schemas;
  for (const Channel& channel : channels) {
    const auto [schema, is_new] =
        schemas.try_emplace(channel.schema_name, static_cast<std::uint16_t>(schemas.size() + 1));
    if (is_new) {
      schemas_ += record(Op::schema, Bytes()
                                         .number(schema->second)
                                         .text(channel.schema_name)
                                         .text(channel.schema_encoding)
                                         .text(channel.schema));
    }
    channels_ += record(Op::channel, Bytes()
                                         .number(channel_count_)
                                         .number(schema->second)
                                         .text(channel.topic)
                                         .text(channel.encoding)
                                         .number(std::uint32_t{0}));  // no metadata
    ++channel_count_;
  }
  schema_count_ = static_cast<std::uint16_t>(schemas.size());
  put(magic + record(Op::header, Bytes().text(options.profile).text("lodestar")) + schemas_ + channels_);
}

McapFile::~McapFile() {
  finish();
}

void McapFile::write(const Message& message) {
  const auto channel = static_cast<std::uint16_t>(message.channel);
  const std::uint64_t time_ns = nanoseconds(message.stamp);
  const auto sequence = static_cast<std::uint32_t>(messages_[channel]++);
  chunk_.index[channel].push_back({time_ns, chunk_.records.size()});
  chunk_.records +=
      record(Op::message,
             Bytes().number(channel).number(sequence).number(time_ns).number(time_ns).raw(message.content));
  chunk_.first_ns = std::min(chunk_.first_ns, time_ns);
  chunk_.last_ns = std::max(chunk_.last_ns, time_ns);
  const bool is_long =
      chunk_.last_ns - chunk_.first_ns >= static_cast<std::uint64_t>(options_.chunk_time.count());
  if (is_long || chunk_.records.size() >= options_.chunk_bytes) finish_chunk();
}

void McapFile::put(const std::string& bytes) {
  file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file_.flush();  // to the operating system: survives a crash of this program
  written_ += bytes.size();
}

void McapFile::finish_chunk() {
  if (chunk_.records.empty()) return;
  const std::uint64_t start = written_;
  const std::string packed = compressed(chunk_.records, options_.compression_level);
  const std::string chunk = record(Op::chunk, Bytes()
                                                  .number(chunk_.first_ns)
                                                  .number(chunk_.last_ns)
                                                  .number(static_cast<std::uint64_t>(chunk_.records.size()))
                                                  .number(crc_of(chunk_.records))
                                                  .text("zstd")
                                                  .number(static_cast<std::uint64_t>(packed.size()))
                                                  .raw(packed));
  std::string indexes;
  Bytes places;
  for (const auto& [channel, entries] : chunk_.index) {
    Bytes list;
    for (const IndexEntry& entry : entries) list.number(entry.time_ns).number(entry.offset);
    places.number(channel).number(static_cast<std::uint64_t>(start + chunk.size() + indexes.size()));
    indexes += record(Op::message_index, Bytes().number(channel).text(list.get()));
  }
  chunk_indexes_ += record(Op::chunk_index, Bytes()
                                                .number(chunk_.first_ns)
                                                .number(chunk_.last_ns)
                                                .number(start)
                                                .number(static_cast<std::uint64_t>(chunk.size()))
                                                .text(places.get())
                                                .number(static_cast<std::uint64_t>(indexes.size()))
                                                .text("zstd")
                                                .number(static_cast<std::uint64_t>(packed.size()))
                                                .number(static_cast<std::uint64_t>(chunk_.records.size())));
  put(chunk + indexes);
  ++chunk_count_;
  first_ns_ = std::min(first_ns_, chunk_.first_ns);
  last_ns_ = std::max(last_ns_, chunk_.last_ns);
  chunk_ = {};
}

std::string McapFile::statistics() const {
  std::uint64_t total = 0;
  Bytes counts;
  for (const auto& [channel, count] : messages_) {
    counts.number(channel).number(count);
    total += count;
  }
  return record(Op::statistics, Bytes()
                                    .number(total)
                                    .number(schema_count_)
                                    .number(static_cast<std::uint32_t>(channel_count_))
                                    .number(std::uint32_t{0})  // attachments
                                    .number(std::uint32_t{0})  // metadata
                                    .number(chunk_count_)
                                    .number(total == 0 ? 0 : first_ns_)
                                    .number(last_ns_)
                                    .text(counts.get()));
}

/// The summary: what the file holds, and where. Its CRC covers all of it, up to the CRC itself.
void McapFile::finish() {
  if (std::exchange(finished_, true)) return;
  finish_chunk();
  put(record(Op::data_end, Bytes().number(std::uint32_t{0})));  // no CRC over all: each chunk has its own
  const std::uint64_t schemas = written_;
  const std::uint64_t channels = schemas + schemas_.size();
  const std::uint64_t counts = channels + channels_.size();
  const std::string statistics_record = statistics();
  const std::uint64_t indexes = counts + statistics_record.size();
  const std::uint64_t offsets = indexes + chunk_indexes_.size();
  std::string summary = schemas_ + channels_ + statistics_record + chunk_indexes_;
  summary += summary_offset(Op::schema, schemas, channels);
  summary += summary_offset(Op::channel, channels, counts);
  summary += summary_offset(Op::statistics, counts, indexes);
  summary += summary_offset(Op::chunk_index, indexes, offsets);
  constexpr std::uint64_t footer_length = 8 + 8 + 4;
  summary += Bytes()
                 .number(static_cast<std::uint8_t>(Op::footer))
                 .number(footer_length)
                 .number(schemas)
                 .number(offsets)
                 .get();
  put(summary + Bytes().number(crc_of(summary)).get() + magic);
}

}  // namespace lodestar

#pragma once

#include <deque>
#include <filesystem>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

#include "app/common/background_writer.hpp"

namespace lodestar {

/// An event of a site: what a person saved or ordered, or what the robot did.
struct AuditEntry {
  std::string at;        ///< UTC in ISO 8601; filled in by the log
  std::string by;        ///< the name that the person goes by; may be empty
  std::string what;      ///< in words
  std::string document;  ///< that was saved: "markers", "places"; empty for anything else
  int state = 0;         ///< of its history: what it was before
};

/// Who drove and who saved: one JSON object a line in .history/log.jsonl of the site folder. Names are those
/// that people give themselves; a console with tokens knows what someone may do, not who it is. At 1 MiB the
/// file becomes log.1.jsonl, and that before it is gone.
class AuditLog {
 public:
  static constexpr std::size_t most_shown = 500;

  explicit AuditLog(const std::filesystem::path& site_folder);

  /// Holds nobody up: it is written on a thread of its own. May be called from any thread. A line that cannot
  /// be written, as in a site that may not be, is lost from the file, not from what is shown until the
  /// program ends.
  void note(AuditEntry entry);

  /// [{"at", "by", "what"}], the newest first.
  [[nodiscard]] nlohmann::ordered_json newest() const;

  /// Who saved over a state of a document; empty when nobody knows.
  [[nodiscard]] std::string author_of(const std::string& document, int state) const;

 private:
  void read();
  void append(const std::string& line) const;

  std::filesystem::path file_;
  mutable std::mutex mutex_;
  std::deque<AuditEntry> entries_;  ///< the newest last
  BackgroundWriter<std::string> writer_;
};

}  // namespace lodestar

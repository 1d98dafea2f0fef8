#include "app/console/audit_log.hpp"

#include <algorithm>
#include <fstream>
#include <unistd.h>

#include "app/common/json_text.hpp"
#include "app/common/log.hpp"
#include "app/common/wall_clock.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::uintmax_t most_bytes = 1U << 20U;
constexpr std::size_t most_lines_waiting = 1000;

ordered_json as_json(const AuditEntry& entry) {
  ordered_json line{{"at", entry.at}, {"by", entry.by}, {"what", entry.what}};
  if (!entry.document.empty()) line.update({{"document", entry.document}, {"state", entry.state}});
  return line;
}

std::string text_of(const ordered_json& content) {
  return json_text(content);
}

}  // namespace

AuditLog::AuditLog(const fs::path& site_folder)
    : file_(site_folder / ".history" / "log.jsonl"),
      writer_(
          {.most_waiting = most_lines_waiting,
           .tell =
               [](const std::string& error) { log_warning("who drove and saved is not kept: " + error); }},
          [this](const std::string& line) { append(line); }) {
  read();
}

/// Lines that are none, such as one that a power cut left, are passed over.
void AuditLog::read() {
  std::ifstream stream(file_, std::ios::binary);
  for (std::string text; std::getline(stream, text);) {
    const json line = json::parse(text, nullptr, false);
    if (!line.is_object()) continue;
    try {
      entries_.push_back({.at = line.value("at", ""),
                          .by = line.value("by", ""),
                          .what = line.value("what", ""),
                          .document = line.value("document", ""),
                          .state = line.value("state", 0)});
    } catch (const json::exception&) {
      continue;
    }
    if (entries_.size() > most_shown) entries_.pop_front();
  }
}

void AuditLog::note(AuditEntry entry) {
  entry.at = utc_text();
  std::string line = text_of(as_json(entry)) + "\n";
  {
    const std::lock_guard lock(mutex_);
    entries_.push_back(std::move(entry));
    if (entries_.size() > most_shown) entries_.pop_front();
  }
  writer_.put(std::move(line));
}

/// A site that nobody here may write to, such as the example of an installed program, keeps none.
void AuditLog::append(const std::string& line) const {
  std::error_code none;
  if (access(file_.parent_path().parent_path().c_str(), W_OK) != 0) return;
  fs::create_directories(file_.parent_path(), none);
  if (fs::file_size(file_, none) >= most_bytes && !none)
    fs::rename(file_, file_.parent_path() / "log.1.jsonl", none);
  std::ofstream stream(file_, std::ios::binary | std::ios::app);
  stream << line << std::flush;
  if (!stream) throw InputError(file_, 0, "a file that could not be written", "one that can");
}

ordered_json AuditLog::newest() const {
  std::unique_lock lock(mutex_);
  const std::deque<AuditEntry> entries = entries_;
  lock.unlock();  // the control loop may want to note something
  ordered_json list = ordered_json::array();
  for (auto entry = entries.rbegin(); entry != entries.rend(); ++entry)
    list.push_back({{"at", entry->at}, {"by", entry->by}, {"what", entry->what}});
  return list;
}

std::string AuditLog::author_of(const std::string& document, int state) const {
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(entries_.rbegin(), entries_.rend(), [&](const AuditEntry& entry) {
    return entry.document == document && entry.state == state;
  });
  return found == entries_.rend() ? "" : found->by;
}

}  // namespace lodestar

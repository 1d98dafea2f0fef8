#include "maps/atomic_file.hpp"

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <string>
#include <system_error>
#include <unistd.h>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

/// Closes a file descriptor at the end of its scope.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] int get() const { return number_; }
  [[nodiscard]] bool is_open() const { return number_ >= 0; }

 private:
  int number_;
};

bool write_all(int descriptor, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(descriptor, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& temporary) {
  const std::string reason = std::strerror(errno);
  ::unlink(temporary.c_str());
  throw InputError(file, 0, "a file that could not be written (" + reason + ")",
                   "a folder that can be written");
}

/// Removes what killed writers left behind: ".NAME.PID" files of processes that no longer exist.
void remove_orphans(const std::filesystem::path& folder, const std::string& name) {
  const std::string prefix = "." + name + ".";
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    const std::string found = entry.path().filename().string();
    if (!found.starts_with(prefix)) continue;
    const char* const end = found.data() + found.size();
    ::pid_t writer = 0;
    const auto [stop, error] = std::from_chars(found.data() + prefix.size(), end, writer);
    const bool is_ours = error == std::errc() && stop == end && writer > 0;
    if (is_ours && ::kill(writer, 0) != 0 && errno == ESRCH) ::unlink(entry.path().c_str());
  }
}

/// Devices, pipes and sockets have no old content to keep, and must not be replaced by a file.
bool is_something_else(const std::filesystem::path& file) {
  std::error_code none;
  const std::filesystem::file_status status = std::filesystem::status(file, none);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
}

void write_into(const std::filesystem::path& file, std::string_view content) {
  const Descriptor out(::open(file.c_str(), O_WRONLY | O_CLOEXEC));
  if (out.is_open() && write_all(out.get(), content)) return;
  throw InputError(file, 0, std::string("a file that could not be written (") + std::strerror(errno) + ")",
                   "one that can be");
}

/// Where a symbolic link leads to: the link itself stays.
std::filesystem::path target_of(const std::filesystem::path& file) {
  std::error_code none;
  if (!std::filesystem::is_symlink(file, none)) return file;
  const std::filesystem::path target = std::filesystem::weakly_canonical(file, none);
  return none ? file : target;
}

}  // namespace

void write_file_atomically(const std::filesystem::path& path, std::string_view content) {
  if (is_something_else(path)) {
    write_into(path, content);
    return;
  }
  const std::filesystem::path file = target_of(path);
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const std::string temporary =
      (folder / fmt::format(".{}.{}", file.filename().string(), ::getpid())).string();
  {
    constexpr mode_t readable_by_all = 0644;
    const Descriptor out(
        ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, readable_by_all));
    if (!out.is_open() || !write_all(out.get(), content) || ::fsync(out.get()) != 0) fail(file, temporary);
  }
  remove_orphans(folder, file.filename().string());
  if (std::rename(temporary.c_str(), file.c_str()) != 0) fail(file, temporary);
  // The rename itself must survive a power cut; on a file system that cannot sync folders that is not
  // possible.
  const Descriptor directory(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory.is_open()) ::fsync(directory.get());
}

}  // namespace lodestar

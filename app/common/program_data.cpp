#include "app/common/program_data.hpp"

#include <array>
#include <cstdlib>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& path) {
  std::error_code cannot;
  return fs::exists(path, cannot);
}

bool is_writable(const fs::path& folder) {
  return ::access(folder.c_str(), W_OK | X_OK) == 0;
}

/// Empty when the variable is not set.
fs::path folder_from_environment(const char* variable) {
  const char* const text = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): nobody changes it
  return text == nullptr ? fs::path() : fs::path(text);
}

/// The folder, made if need be; nothing when it cannot be written.
std::optional<fs::path> made(const fs::path& folder) {
  std::error_code cannot;
  fs::create_directories(folder, cannot);
  if (!is_writable(folder)) return std::nullopt;
  return folder;
}

/// A folder that nobody else can have prepared: a link or another user's is refused.
std::optional<fs::path> own_folder_in(const fs::path& temporary) {
  const fs::path folder = temporary / fmt::format("lodestar-{}", ::geteuid());
  (void)::mkdir(folder.c_str(), S_IRWXU);
  struct stat found{};
  if (::lstat(folder.c_str(), &found) != 0 || !S_ISDIR(found.st_mode) || found.st_uid != ::geteuid())
    return std::nullopt;
  return made(folder / "runs");
}

}  // namespace

std::optional<fs::path> data_beside(const fs::path& folder_of_program, const fs::path& name) {
  const std::array candidates{folder_of_program / "share/lodestar" / name,
                              (folder_of_program / LODESTAR_DATA_FROM_PROGRAM / name).lexically_normal()};
  for (const fs::path& candidate : candidates)
    if (is_there(candidate)) return candidate;
  return std::nullopt;
}

fs::path program_data(const fs::path& name) {
  if (is_there(name)) return name;
  std::error_code cannot;
  const fs::path program = fs::read_symlink("/proc/self/exe", cannot);
  return data_beside(program.parent_path(), name).value_or(name);
}

fs::path runs_folder(const WritableFolders& folders) {
  const fs::path here = folders.working_directory / "runs";
  if (is_there(here) ? is_writable(here) : is_writable(folders.working_directory)) return here;
  if (folders.state_home.is_absolute())
    if (const auto folder = made(folders.state_home / "lodestar/runs")) return *folder;
  if (folders.home.is_absolute() && is_there(folders.home))
    if (const auto folder = made(folders.home / ".local/state/lodestar/runs")) return *folder;
  if (const auto folder = own_folder_in(folders.temporary)) return *folder;
  throw InputError(here, 0, "a folder that may not be written", "-o FOLDER");
}

fs::path runs_folder() {
  std::error_code cannot;
  const fs::path temporary = fs::temp_directory_path(cannot);
  return runs_folder({.working_directory = ".",
                      .state_home = folder_from_environment("XDG_STATE_HOME"),
                      .home = folder_from_environment("HOME"),
                      .temporary = temporary.empty() ? "/tmp" : temporary})
      .lexically_normal();
}

}  // namespace lodestar

#pragma once

#include <filesystem>
#include <optional>

// Where the files that come with the program are, and where it may write. No path of the machine that built
// the program is in it: all are found from where the program itself is.
namespace lodestar {

/// A file or folder of the program's data (sites/lab, faults) as seen from the folder that holds the program:
/// in a build tree, or in an installed prefix. Nothing where neither has it.
std::optional<std::filesystem::path> data_beside(const std::filesystem::path& folder_of_program,
                                                 const std::filesystem::path& name);

/// The same for the running program; below the working directory comes first. Where it is nowhere, the name
/// itself: whoever opens it says so.
std::filesystem::path program_data(const std::filesystem::path& name);

/// What the choice of a folder to write into depends on; the environment's variables may be empty.
struct WritableFolders {
  std::filesystem::path working_directory;
  std::filesystem::path state_home;  ///< XDG_STATE_HOME
  std::filesystem::path home;        ///< HOME
  std::filesystem::path temporary;
};

/// The folder for run folders that nobody has named: `runs` in the working directory; where that may not be
/// written, lodestar/runs in the user's state folder (XDG base directories), else one of the user's own in
/// the temporary folder. Throws InputError when none may be written.
std::filesystem::path runs_folder(const WritableFolders& folders);

/// The same for the running program.
std::filesystem::path runs_folder();

}  // namespace lodestar

#include "app/simulate/fault_files.hpp"

#include <algorithm>
#include <filesystem>

#include "app/common/program_data.hpp"
#include "drivers/simulation/fault_file.hpp"
#include "maps/input_error.hpp"
#include "maps/path_kind.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

/// The fault library, found from any working directory.
fs::path library() {
  return program_data("faults");
}

std::string names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  std::ranges::sort(names);
  std::string text;
  for (const std::string& name : names) text += ", " + name;
  return text;
}

}  // namespace

std::vector<Fault> faults_named(const std::string& file_or_name) {
  if (is_file(file_or_name)) return load_faults(file_or_name);
  const fs::path of_library = library() / (file_or_name + ".yaml");
  if (is_file(of_library)) return load_faults(of_library);
  throw InputError(file_or_name, 0, "no such file of faults", "a file" + names_in(library()));
}

}  // namespace lodestar

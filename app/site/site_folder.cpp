#include "app/site/site_folder.hpp"

#include "app/common/program_data.hpp"
#include "maps/path_kind.hpp"

namespace lodestar {

namespace fs = std::filesystem;

fs::path site_folder(const std::string& folder_or_name) {
  if (folder_or_name.empty()) return program_data("sites/lab");
  const fs::path given = folder_or_name;
  const bool is_name = !given.has_parent_path() && given != "." && given != "..";
  if (!is_name || is_folder(given)) return given;
  for (const fs::path& folder :
       {"/etc/lodestar" / given, "/srv/lodestar" / given, program_data("sites" / given)})
    if (is_file(folder / "site.yaml")) return folder;
  return given;
}

Site open_site(const std::string& folder_or_name) {
  return load_site(site_folder(folder_or_name));
}

}  // namespace lodestar

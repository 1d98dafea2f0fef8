#pragma once

#include <filesystem>
#include <string>

#include "app/site/site.hpp"

namespace lodestar {

/// The folder of a site that is given as a folder, or by its name where the machine keeps sites:
/// /etc/lodestar, /srv/lodestar, and the examples that come with the program. The text itself when there is
/// no such site; without a text the lab, the example of which the documentation speaks.
std::filesystem::path site_folder(const std::string& folder_or_name);

/// Reads the site. Throws InputError with file and line.
Site open_site(const std::string& folder_or_name);

}  // namespace lodestar

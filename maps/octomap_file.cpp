#include "maps/octomap_file.hpp"

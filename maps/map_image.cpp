#include "maps/map_file.hpp"

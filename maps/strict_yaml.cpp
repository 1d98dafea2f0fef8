#include "maps/strict_yaml.hpp"

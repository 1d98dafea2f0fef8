#include "maps/marker_registry.hpp"

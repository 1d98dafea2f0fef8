#include "maps/distance_field.hpp"

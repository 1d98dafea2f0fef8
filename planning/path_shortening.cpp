#include "planning/grid_planner.hpp"

#include "drivers/simulation.hpp"

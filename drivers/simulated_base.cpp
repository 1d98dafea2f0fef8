#include "drivers/simulated_base.hpp"

#include "drivers/can_bus.hpp"

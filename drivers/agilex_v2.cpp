#include "drivers/agilex_v2.hpp"

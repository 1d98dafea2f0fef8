#include "drivers/scoring.hpp"

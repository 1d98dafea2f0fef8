#include "control/safety_stop.hpp"

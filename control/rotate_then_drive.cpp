#include "control/rotate_then_drive.hpp"

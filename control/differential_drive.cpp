#include "control/differential_drive.hpp"

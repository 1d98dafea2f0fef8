#include "drivers/simulated_camera.hpp"

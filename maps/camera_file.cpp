#include "maps/camera_model.hpp"

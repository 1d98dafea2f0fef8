#include "localization/pose_fix.hpp"

#include "localization/pose_filter.hpp"

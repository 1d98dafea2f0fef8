#include "localization/detected_marker.hpp"

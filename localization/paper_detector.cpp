#include "localization/paper_detector.hpp"

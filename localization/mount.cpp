#include "localization/mount.hpp"

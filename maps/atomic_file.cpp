#include "maps/atomic_file.hpp"

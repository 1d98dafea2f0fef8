#include "drivers/base_driver.hpp"

#include "runtime/nearest_data_point.h"

#include <gtest/gtest.h>

#include "common/sensor_model.h"

#include <gtest/gtest.h>

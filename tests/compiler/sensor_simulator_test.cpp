#include "compiler/sensor_simulator.h"

#include <gtest/gtest.h>

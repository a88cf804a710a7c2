#include "compiler/sensor_file.h"

#include <gtest/gtest.h>

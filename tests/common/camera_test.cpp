#include "common/camera.h"

#include <gtest/gtest.h>

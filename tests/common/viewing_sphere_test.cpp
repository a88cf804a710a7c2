#include "common/viewing_sphere.h"

#include <gtest/gtest.h>

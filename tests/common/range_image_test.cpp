#include "common/range_image.h"

#include <gtest/gtest.h>

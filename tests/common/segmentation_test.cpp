#include "common/segmentation.h"

#include <gtest/gtest.h>

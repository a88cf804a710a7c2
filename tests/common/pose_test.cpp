#include "common/pose.h"

#include <gtest/gtest.h>

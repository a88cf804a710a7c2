#include "common/random.h"

#include <gtest/gtest.h>

#include "common/density.h"

#include <gtest/gtest.h>

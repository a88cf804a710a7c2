#include "common/region_attributes.h"

#include <gtest/gtest.h>

#include "common/relation_attributes.h"

#include <gtest/gtest.h>

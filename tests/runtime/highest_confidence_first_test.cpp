#include "runtime/highest_confidence_first.h"

#include <gtest/gtest.h>

#include "runtime/foresight.h"

#include <gtest/gtest.h>

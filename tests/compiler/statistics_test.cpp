#include "compiler/statistics.h"

#include <gtest/gtest.h>

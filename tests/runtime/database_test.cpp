#include "runtime/database.h"

#include <gtest/gtest.h>

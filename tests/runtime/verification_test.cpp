#include "runtime/verification.h"

#include <gtest/gtest.h>

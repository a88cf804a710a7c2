#include "runtime/recognize.h"

#include <gtest/gtest.h>

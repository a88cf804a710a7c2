#include "compiler/compile.h"

#include <gtest/gtest.h>

#include "common/atomic_file.h"

#include <gtest/gtest.h>

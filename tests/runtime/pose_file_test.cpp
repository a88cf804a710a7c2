#include "runtime/pose_file.h"

#include <gtest/gtest.h>
